#!/bin/sh
# examples.sh BUILD - the code of docs/c-api.md is that of the programs in docs/examples/c, which run. A block of C on the page is
# a contiguous part, indentation aside, of the program that the last link before it names.
set -eu
build=$1
top=$PWD
page=docs/c-api.md
programs=$top/docs/examples/c
tmp=$(mktemp -d)
trap 'rm -rf "$tmp"' EXIT
fail() { echo "FAILED: $1"; exit 1; }

# ---- the page ----
awk -v tmp="$tmp" '
    match($0, /examples\/c\/[a-z_]+\.c/) { program = substr($0, RSTART + 11, RLENGTH - 11) }
    /^```$/ && inside { inside = 0; close(file); next }
    /^```c$/ { inside = 1; file = tmp "/" ++count "." program; next }
    inside { sub(/^ +/, ""); print > file }' $page
blocks=0
for block in "$tmp"/[0-9]*; do
    name=${block##*/}
    program=${name#*.}
    [ -f "$programs/$program" ] || fail "$page: a block of code has no program before it (${program:-none})"
    sed 's/^ *//' "$programs/$program" | awk -v block="$block" '
        { text = text $0 "\n" }
        END { while ((getline line < block) > 0) wanted = wanted line "\n"; exit !(index("\n" text, "\n" wanted)) }' ||
        fail "$page: block ${name%%.*} is not in docs/examples/c/$program"
    blocks=$((blocks + 1))
done
for program in "$programs"/*.c; do
    grep -q "examples/c/${program##*/}" $page || fail "$page does not name ${program##*/}"
done

# ---- the programs ----
cd "$tmp"
spin=$top/docs/examples/gltf/spin.gltf
ran=0
run() { # run NAME ARGUMENT.. FILE: runs the program, which then has written FILE
    name=$1
    shift
    for file in "$@"; do :; done
    "$build/example_$name" "$@" >"$name.log" 2>&1 || { cat "$name.log"; fail "$name"; }
    [ -s "$file" ] || fail "$name wrote no $file"
    ran=$((ran + 1))
}
run render "$spin" spin.png
run budget "$spin"
run inspect "$top/docs/examples/obj/boat.obj" boat.glb
run fleet "$spin" "$top/docs/examples/obj/boat.obj" fleet.glb
run convert "$spin" spin.obj
run turntable "$spin" turntable.png
run arrays arrays.png
run sky sky.png
run frames "$spin" && [ -s frame7.png ]
run path "$spin" && [ -s path.exr ]
run compare spin.png spin.png same.png
run bake cube.ktx2
run plot metal.svg
run shaders brdf.glsl
if [ -x "$build/example_sea" ]; then
    run sea sea.png
    run sea_model "$spin" && [ -s sea_model.exr ]
    "$build/example_buoy" >buoy.log || fail buoy
    ran=$((ran + 2))
fi
# The window opens if there is a display; else a message names what is missing.
printf 'load\npicture view.png\nclose\n' >script
if "$build/example_view" "$spin" script >view.log 2>&1; then
    [ -s view.png ] || fail "view wrote no image"
else
    grep -Eq 'display|GLFW|OpenGL|window' view.log || { cat view.log; fail view; }
fi
echo "examples: $blocks blocks of $page, $ran programs"
