#!/bin/sh
# thumbnail.sh FACET - the thumbnailer as file managers call it: output held open (Tumbler), sandbox (GNOME), broken files.
set -eu
facet=$1
here=$(cd "$(dirname -- "$0")/../.." && pwd)
tmp=$(mktemp -d)
trap 'rm -rf "$tmp"' EXIT
fail() {
    echo "thumbnail: $*"
    exit 1
}
PATH=$(dirname -- "$facet"):$here/packaging/thumbnailer:$PATH
export PATH
unset DISPLAY WAYLAND_DISPLAY XDG_RUNTIME_DIR || true
cd "$tmp"
facet convert "$here/docs/examples/obj/boat.obj" boat.glb -q
facet bake studio -o studio.ktx2 --size 64 --lobe none -q 2>/dev/null || facet bake studio -o studio.ktx2 --size 64 -q
facet render -o image.exr --size 64x48 -q
facet render -o image.hdr --size 64x48 -q
printf '%s\n' ply 'format ascii 1.0' 'element vertex 3' 'property float x' 'property float y' 'property float z' 'element face 1' \
    'property list uchar int vertex_indices' end_header '0 0 0' '1 0 0' '0 1 0' '3 0 1 2' >triangle.ply
printf '%s\n' 'solid t' 'facet normal 0 0 1' 'outer loop' 'vertex 0 0 0' 'vertex 1 0 0' 'vertex 0 1 0' endloop endfacet 'endsolid t' >triangle.stl

is_png() { # FILE SIZE: a PNG image of at most that size
    [ "$(head -c 8 "$1" | od -An -tx1 | tr -d ' \n')" = 89504e470d0a1a0a ] || fail "$1 is not a PNG file"
    edge=$(od -An -tu1 -j16 -N8 "$1" | awk '{w = $3 * 256 + $4; h = $7 * 256 + $8; print (w > h ? w : h)}')
    [ "$edge" -le "$2" ] || fail "$1 has $edge pixels along an edge, more than $2"
}

# The line of the .thumbnailer file, by its own placeholders.
line=$(sed -n 's/^Exec=//p' "$here/packaging/thumbnailer/facet.thumbnailer")
run() { # INPUT OUTPUT SIZE
    # shellcheck disable=SC2046
    set -- $(echo "$line" | sed "s|%i|$1|; s|%o|$2|; s|%s|$3|")
    "$@"
}
for input in boat.glb triangle.ply triangle.stl studio.ktx2 image.exr image.hdr "$here/docs/examples/obj/boat.obj"; do
    run "$(readlink -f "$input")" "$tmp/out.png" 128 || fail "$input: exit code $?"
    is_png out.png 128
    rm out.png
done

# Names as users give them, and outputs that facet would take for options, standard output or patterns.
newline=$(printf 'a\nb.glb')
for input in "a b%20.glb" -dash.glb "$newline" "$(printf '\377.glb')" '*?$(x)`"{stem}.glb' "@list.glb"; do
    cp boat.glb "./$input"
    for output in -out.png - 'a b%d.png' '{stem}##.png'; do
        facet-thumbnailer -s 32 "$input" "$output" >seen.png || fail "$input: exit code $?"
        [ ! -s seen.png ] || fail "$output went to standard output"
        is_png "./$output" 32
        rm -- "./$output"
    done
done
: >'100%.png'
exec 3<'100%.png'
facet-thumbnailer -s 32 boat.glb '100%.png'
cmp - 100%.png <&3 && [ -s 100%.png ] || fail "an output held open whose name has a percent sign"
exec 3<&-
for options in '-s' '-s 64' '-s 64 boat.glb' 'boat.glb a.png b.png'; do
    code=0
    # shellcheck disable=SC2086
    facet-thumbnailer $options 2>err || code=$?
    [ "$code" = 2 ] && grep -q usage err || fail "$options: exit code $code"
done
if facet-thumbnailer missing.glb '1%.png' 2>err || [ -e '1%.png' ]; then fail "a failure left 1%.png"; fi

# Neither all models of a folder, nor what waits for another program.
mkdir folder.glb
cp boat.glb folder.glb/
mkfifo pipe.glb
for input in folder.glb pipe.glb; do
    code=0
    timeout 4 facet-thumbnailer "$input" out.png 2>err || code=$?
    [ "$code" = 3 ] && [ "$(wc -l <err)" = 1 ] && [ ! -e out.png ] || fail "$input: exit code $code"
done

# Outputs that are no files are refused, unless the caller has opened them.
mkdir folder
mkfifo pipe 'pipe%'
ln -s pipe link
for output in folder pipe 'pipe%' link /dev/null; do
    code=0
    timeout 4 facet-thumbnailer boat.glb "$output" 2>err || code=$?
    [ "$code" = 6 ] && [ "$(wc -l <err)" = 1 ] && grep -q 'not a regular file' err || fail "$output: exit code $code"
done
[ -p pipe ] && [ -c /dev/null ] && [ -z "$(ls folder)" ] || fail "an output that is no file was replaced"
facet-thumbnailer -s 32 boat.glb /dev/fd/3 3>seen.png
is_png seen.png 32
facet-thumbnailer -s 32 boat.glb /dev/fd/3 3>&1 >/dev/null | cat >seen.png
is_png seen.png 32

# Tumbler: the output is there, empty, and read through a descriptor that was opened before.
: >held.png
exec 3<held.png
run "$tmp/boat.glb" "$tmp/held.png" 256
cat <&3 >seen.png
exec 3<&-
is_png seen.png 256
cmp seen.png held.png || fail "the held file differs"

# Broken files: an exit code, one sentence, no output; an empty output stays empty.
head -c 400 boat.glb >cut.glb
echo nothing >no.glb
: >empty.glb
sed 's/vertex 3/vertex 4000000000/; s/face 1/face 0/; /^[0-9]/d' triangle.ply >none.ply
sed 's/^v .*/v nan nan nan/' "$here/docs/examples/obj/boat.obj" >nan.obj
printf '{"asset": {"version": "2.0"}, "scenes": [{"nodes": []}], "scene": 0}' >none.gltf
for image in image.hdr image.exr studio.ktx2; do
    head -c 200 $image >cut.$image
done
for input in cut.glb no.glb empty.glb none.ply nan.obj none.gltf missing.glb cut.image.hdr cut.image.exr cut.studio.ktx2; do
    : >held.png
    for output in out.png held.png; do
        code=0
        run "$tmp/$input" "$tmp/$output" 128 2>err || code=$?
        [ "$code" -gt 0 ] && [ "$code" -lt 10 ] || fail "$input: exit code $code"
        [ "$(wc -l <err)" = 1 ] && ! grep -q 'not a model' err || fail "$input: $(cat err)"
    done
    [ ! -e out.png ] && [ ! -s held.png ] || fail "$input left an output"
done

# GNOME's sandbox: only /usr, the one file and the folder of the output. Its libraries must be those of /usr.
if ! command -v bwrap >/dev/null 2>&1 || ! bwrap --ro-bind / / --unshare-all true 2>/dev/null; then
    echo "thumbnail: bwrap cannot work here: the sandbox is not tested"
    exit 0
fi
mkdir out # emptied for each file, as desktops make a new one
facet convert boat.glb open.gltf -q # with open.bin beside it
sandbox() { # INPUT NAME: the output is out/thumbnail.png
    rm -f out/*
    bwrap --ro-bind /usr /usr --ro-bind-try /etc/ld.so.cache /etc/ld.so.cache --symlink /usr/bin /bin --symlink /usr/lib64 /lib64 \
        --symlink /usr/lib /lib --symlink /usr/sbin /sbin --ro-bind-try /etc/alternatives /etc/alternatives --proc /proc --dev /dev \
        --chdir / --setenv GIO_USE_VFS local --unshare-all --die-with-parent --bind "$tmp/out" /tmp --ro-bind "$1" "/tmp/$2" \
        --ro-bind "$facet" /run/facet --ro-bind "$here/packaging/thumbnailer" /run/thumbnailer --clearenv --setenv PATH /run:/run/thumbnailer:/usr/bin \
        facet-thumbnailer -s 256 "/tmp/$2" /tmp/thumbnail.png
}
if ! ldd "$facet" | awk '$3 ~ /^\// {print $3}' | grep -qv '^/\(usr/\)*lib'; then
    for input in boat.glb triangle.ply triangle.stl studio.ktx2 image.exr image.hdr; do
        sandbox "$tmp/$input" "gnome-desktop-file-to-thumbnail.${input#*.}" || fail "$input in the sandbox: exit code $?"
        is_png out/thumbnail.png 256
        rm out/thumbnail.png
    done
    code=0
    sandbox "$tmp/open.gltf" gnome-desktop-file-to-thumbnail.gltf 2>err || code=$?
    [ "$code" = 3 ] && [ ! -e out/thumbnail.png ] || fail "a .gltf without its files: exit code $code"
    [ "$(wc -l <err)" = 1 ] && grep -q 'open.bin.*sandbox' err || fail "a .gltf without its files: $(cat err)"
    echo "thumbnail: held output, sandbox and broken files behave"
fi
