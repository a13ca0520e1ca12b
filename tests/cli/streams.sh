#!/bin/sh
# streams.sh - standard input and output, JSON, progress, quiet.
set -eu
. "$(dirname "$0")/lib.sh"
write_triangle tri.gltf

expect 0 render $small - -o - --format png -v <tri.gltf
is_type out "PNG image data, 48 x 32"
if command -v pngcheck >/dev/null; then
    cp out out.png
    pngcheck -q out.png || failed "pngcheck"
fi
says "stdout: 48x32"
"$facet" render $small tri.gltf -o same.png
cmp -s out same.png || failed "stdin to stdout differs from file to file"
expect 0 render $small tri.gltf -o - --format exr --progress plain
is_type out "OpenEXR"
expect 0 render $small - <tri.gltf
is_type stdin.png "PNG"
expect 0 render $small tri.gltf --turntable 3 -o - --format jpg
is_type out "JPEG"
expect 3 render $small - -o x.png </dev/null
says "stdin: it is empty"
rm -f x.png

# JSON
if command -v jq >/dev/null; then
    json() {
        [ "$(jq -r "$1" out 2>&1)" = "$2" ] || failed "JSON: $1 is $(jq -r "$1" out 2>&1), not $2"
    }
    expect 0 render $small tri.gltf -o a.png --json
    json '.pictures | length' 1
    json '.pictures[0].output' a.png
    json '.pictures[0].model' tri.gltf
    json '.pictures[0] | "\(.width) \(.height) \(.samples)"' "48 32 1"
    json '.exit_code' 0
    json '.peak_memory_bytes > 1000000 and .seconds > 0 and .peak_data_bytes > 0' true
    json '.failures | length' 0
    expect 1 render $small tri.gltf missing.glb -o '{stem}.png' --json
    json '.pictures | length' 1
    json '.failures[0].model' missing.glb
    json '.failures[0].exit_code' 3
    json '.exit_code' 1
    expect 2 render --size 0 --json
    json '.exit_code' 2
    expect 0 render $small tri.gltf -o a.png --json --no-clobber
    json '.pictures[0].kept' true
    expect 0 version --json
    json '.version' "$("$facet" version | cut -d' ' -f2)"
    expect 0 inspect tri.gltf --json
    json '.counts.triangles' 1
    expect 0 inspect tri.gltf tri.gltf --json
    [ "$(jq -s length out)" = 2 ] || failed "inspect --json of two models"
    expect 0 render $small tri.gltf -o a.png --progress json --background grey
    jq -e . err >/dev/null || failed "progress is no JSON: $(head -1 err)"
fi
rm -f ./*.png

# progress
expect 0 render $small tri.gltf -o a.png --progress plain
says "a.png: 100 %"
expect 0 render $small tri.gltf -o a.png --background grey
[ ! -s err ] || failed "a bar off a terminal"
[ ! -s out ] || failed "text on standard output"
expect 0 render $small tri.gltf -q
[ ! -s err ] || failed "-q is not quiet"
expect 3 render -q missing.glb
says "missing.glb: "
expect 0 render $small tri.gltf -o a.png -vv
says "shade"

# color only on a terminal, and not with NO_COLOR
esc=$(printf '\033')
expect 3 render missing.glb
! grep -q "$esc" err || failed "escape sequences in a file"
if command -v script >/dev/null; then
    TERM=xterm script -qec "$facet render missing.glb" /dev/null >out 2>&1 </dev/null || true
    grep -q "$esc" out || failed "no color on a terminal"
    NO_COLOR=1 TERM=xterm script -qec "$facet render missing.glb" /dev/null >out 2>&1 </dev/null || true
    ! grep -q "$esc" out || failed "color in spite of NO_COLOR"
    script -qec "$facet render -o - --format png" /dev/null >out 2>&1 </dev/null && failed "an image on a terminal"
    grep -q "standard output is a terminal" out || failed "no refusal to write to a terminal"
fi

# inspect as text
expect 0 inspect tri.gltf
grep -q "1 triangle" out || failed "inspect does not count"
grep -q "Hero" out || failed "inspect does not name the camera"
printf '{"asset":{"version":"2.0"},"materials":[{"name":"\\u001b[31m"}],"extensionsUsed":["X_new"]}' >odd.gltf
expect 0 inspect odd.gltf
! grep -q "$esc" out || failed "inspect lets escape sequences through"
grep -q "X_new" out || failed "inspect does not tell of extensions"
finish
