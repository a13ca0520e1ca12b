#!/bin/sh
# failure.sh - every exit code, and that a failure leaves no file.
set -eu
. "$(dirname "$0")/lib.sh"
write_triangle tri.gltf

# 3, 4, 5: inputs
expect 3 render missing.glb -o x.png
says "missing.glb: "
mkdir folder.glb
expect 3 render folder.glb -o x.png
rmdir folder.glb
echo "no model" >bad.gltf
expect 4 render bad.gltf -o x.png
says "bad.gltf: "
printf 'glTF\002\000\000\000' >short.glb
expect 4 render short.glb -o x.png
printf '{"asset":{"version":"2.0"},"extensionsRequired":["X_unknown"],"extensionsUsed":["X_unknown"]}' >needs.gltf
expect 5 render needs.gltf -o x.png
says "X_unknown"
expect 5 inspect needs.gltf
expect 4 inspect bad.gltf
expect 3 render $small -o x.png --env missing.hdr
says "missing.hdr: "
expect 4 render $small -o x.png --env bad.gltf
rm bad.gltf short.glb needs.gltf

# 1: some of several; --strict
expect 1 render $small tri.gltf missing.glb -o '{stem}.png'
[ -s tri.png ] || failed "the good one of two models is missing"
[ ! -e missing.png ] || failed "an image of nothing"
rm tri.png
sed 's/"scene":0/"extensionsUsed":["X_unknown"],"extensions":{"X_unknown":{}},"scene":0/' tri.gltf >warns.gltf
expect 0 render $small warns.gltf -o w.png
says "X_unknown"
[ "$(grep -c X_unknown err)" = 1 ] || failed "a warning came more than once"
rm w.png
expect 1 render $small warns.gltf -o w.png --strict -q
[ -s w.png ] || failed "--strict leaves out the image"
expect 1 inspect --strict warns.gltf
expect 0 inspect --strict tri.gltf
rm w.png warns.gltf

# 6: outputs
expect 6 render $small -o /proc/x.png
expect 6 render $small -o tri.gltf/x.png
mkdir folder.png
expect 6 render $small -o folder.png
rmdir folder.png
if [ "$(id -u)" != 0 ]; then
    mkdir closed
    chmod 555 closed
    expect 6 render $small -o closed/x.png
    rmdir closed
fi
if [ -c /dev/full ]; then
    code=0
    "$facet" render $small -o - --format png >/dev/full 2>err || code=$?
    [ $code = 6 ] || failed "exit code $code, not 6, on a full standard output"
    says "stdout: "
    [ "$(wc -l <err)" = 1 ] || failed "a full standard output is reported twice"
    code=0
    "$facet" help >/dev/full 2>err || code=$?
    [ $code = 6 ] || failed "exit code $code, not 6, for help on a full standard output"
fi
# a limit on the size of files, as a full disk
code=0
(ulimit -f 1 && exec "$facet" render --size 512 --format pfm -o big.pfm 2>err) || code=$?
[ $code = 6 ] || failed "exit code $code, not 6, beyond the limit on file size"
cp tri.gltf in.png
expect 2 render $small in.png -o in.png
says "in.png: this input would be overwritten"
cmp -s tri.gltf in.png || failed "the input was overwritten"
rm in.png
echo texture >'my tri.png'
sed 's/"scene":0/"images":[{"uri":"my%20tri.png"}],"scene":0/' tri.gltf >'my tri.gltf'
expect 2 render $small 'my tri.gltf'
says "my tri.png: this input would be overwritten"
[ "$(cat 'my tri.png')" = texture ] || failed "a texture was overwritten"
rm 'my tri.png' 'my tri.gltf'

if command -v file >/dev/null && "$facet" version -v | grep -q 'OpenEXR [0-9]'; then # the image fits, its checkpoint does not
    code=0
    (ulimit -f 40 && exec "$facet" render --renderer path -n 1 --size 48x32 --checkpoint c.exr -o c.png 2>err) || code=$?
    [ $code = 6 ] || failed "exit code $code, not 6, where the checkpoint does not fit"
    says "c.exr could not be written; the image is complete"
    is_type c.png "PNG image data, 48 x 32"
    rm c.png
fi
echo '{"size": 64' >bad.json
expect 2 render --config bad.json -o x.png
says "bad.json: line "
echo '[1]' >bad.json
expect 2 render --config bad.json -o x.png
says "bad.json: it must hold one JSON object"
rm bad.json

# 7: limits
expect 7 render --size 4096 -o x.png --max-memory 8M
says "--max-memory"
expect 7 render --size 4096 --quality final -o x.png --time-limit 20ms
says "time limit"

# 75 and 130: interrupted in the middle
interrupted() {
    "$facet" render --size 8192 --samples 64 -o x.png 2>err &
    process=$!
    sleep 0.6
    kill -"$1" $process
    code=0
    wait $process || code=$?
    [ $code = "$2" ] || failed "exit code $code, not $2, after SIG$1"
}
interrupted TERM 75
interrupted HUP 129
only tri.gltf
# One cause, one sentence.
instances='"extensions":{"EXT_mesh_gpu_instancing":{"attributes":{"TRANSLATION":9}}}'
sed "s/{\"mesh\":0}/{\"mesh\":0,$instances}/; s/\"scene\":0/\"extensionsUsed\":[\"EXT_mesh_gpu_instancing\"],\"scene\":0/" \
    tri.gltf >copies.gltf
expect 4 inspect copies.gltf
expect 4 render $small copies.gltf
says "attributes.TRANSLATION: accessor 9 does not exist"
[ "$(wc -l <err)" = 1 ] || failed "more than one sentence about one cause"
# A model that never arrives
for words in "convert - late.glb" "render - $small -o late.png" "inspect -"; do
    code=0
    sleep 3 | "$facet" $words --time-limit 200ms >out 2>err || code=$?
    [ "$code" = 7 ] || failed "exit code $code, not 7: facet $words"
    says "stdin: the time limit (--time-limit) was reached while reading"
done
# and options
if command -v mkfifo >/dev/null; then
    mkfifo options
    expect 7 render tri.gltf --config options -o late.png --time-limit 200ms
    says "options: the time limit (--time-limit) was reached while reading"
    rm options
    odd=$(printf 'odd\roptions')
    mkfifo "$odd"
    expect 7 render tri.gltf --config "$odd" --json -o late.png --time-limit 200ms
    grep -q '"message": "odd.roptions: the time limit' out || failed "--json does not name the time limit: $(cat out)"
    rm "$odd"
fi
finish
