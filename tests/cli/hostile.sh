#!/bin/sh
# hostile.sh - names, links, pipes and numbers that could hang, crash or mislead the command.
set -eu
. "$(dirname "$0")/lib.sh"
write_triangle tri.gltf

# within SECONDS CODE WORD...: expect, and the command ends by itself in that time.
within() {
    seconds=$1
    wanted=$2
    shift 2
    code=0
    timeout -s KILL "$seconds" "$facet" "$@" >out 2>err || code=$?
    [ "$code" = "$wanted" ] || failed "exit code $code, not $wanted: facet $*"
}

# one sentence for each
one_sentence() {
    [ "$(wc -l <err)" = 1 ] || failed "not one sentence but $(wc -l <err): $1"
}

# a model may name only regular files in its folder
mkdir models
sed 's/"uri":"[^"]*"/"uri":"NAME"/' tri.gltf >models/pattern
head -c 36 /dev/zero >secret.bin
head -c 36 /dev/zero >models/in.bin
mkfifo models/pipe.bin
ln -s ../secret.bin models/link.bin
ln -s loop.bin models/loop.bin
names_file() {
    sed "s|NAME|$2|" models/pattern >models/m.gltf
    within 10 "$1" render $small models/m.gltf -o x.png
    [ "$1" = 0 ] || one_sentence "$2"
    rm -f x.png
}
names_file 0 in.bin
for name in pipe.bin link.bin loop.bin ../secret.bin %2e%2e%2fsecret.bin in.bin/../../secret.bin . /dev/zero \
    file:///etc/passwd http://localhost/in.bin "$work/secret.bin"; do
    names_file 3 "$name"
done
for name in '' data: 'data:;base64,A' in.bin%00.png; do
    names_file 4 "$name"
done
within 10 3 render $small models/m.gltf --root nowhere -o x.png
says "nowhere: there is no such folder"
rm -r models secret.bin

# inputs that are not regular files, or endless
within 10 2 render $small '' -o x.png
one_sentence "an empty name"
mkdir nothing
for input in /dev/zero "$work/nothing"; do
    for option in '' --env --config; do
        code=0
        timeout -s KILL 20 "$facet" render $small $option "$input" -o x.png --max-memory 64M >out 2>err || code=$?
        case $code in 3 | 4 | 7) ;; *) failed "exit code $code for $option $input" ;; esac
        one_sentence "$option $input"
        grep -qF "$input: " err || failed "$input is not named"
    done
done
rmdir nothing
code=0
timeout -s KILL 20 "$facet" render - --json -o x.png --max-memory 64M </dev/zero >out 2>err || code=$?
[ $code = 7 ] || failed "exit code $code, not 7, for a standard input without end"
one_sentence "standard input without end"
if command -v jq >/dev/null; then
    [ "$(jq '.peak_memory_bytes < 256000000' out)" = true ] || failed "--max-memory does not hold for standard input"
fi

# extreme cameras, extremely narrow images
within 10 2 render $small tri.gltf --eye 1e38,0,0 -o x.png
one_sentence "--eye 1e38"
within 10 0 render $small tri.gltf --eye 1e18,0,0 -o x.png
within 60 0 render tri.gltf --quality draft --size 65536x1 -o x.png
within 60 0 render tri.gltf --quality draft --size 1x65536 -o x.png
rm x.png
# extremely large models: framed, or left out
for size in 9e16 6e17 2e18; do
    sed "s/{\"mesh\":0}/{\"mesh\":0,\"scale\":[$size,$size,1]}/" tri.gltf >far.gltf
    grep -q "$size" far.gltf || failed "far.gltf is not what it should be"
    within 10 0 render $small far.gltf -o x.png
    rm x.png far.gltf
done
# cameras of files: a lens of any size, a place far out, a matrix without direction
camera() {
    wanted=$1
    sed "s|\"type\":\"perspective\".*|$2}],|;s|\"translation\":[^}]*|$3|" tri.gltf >camera.gltf
    within 10 "$wanted" render $small camera.gltf --camera 0 -o x.png
    [ "$wanted" = 0 ] || one_sentence "$2 $3"
    rm -f x.png
}
lens='"type":"perspective","perspective":{"yfov":0.6,"znear":0.1}'
camera 0 "$lens" '"translation":[0.3,0.3,3]'
camera 0 "$lens" '"translation":[0,0,100000000]'
camera 4 "$lens" '"matrix":[1,0,0,0,0,1,0,0,0,0,0,0,0,0,3,1]'
camera 2 '"type":"perspective","perspective":{"yfov":0.6,"znear":0.1,"aspectRatio":1e30}' '"translation":[0,0,3]'
camera 2 '"type":"orthographic","orthographic":{"xmag":1e30,"ymag":1e30,"znear":0,"zfar":9}' '"translation":[0,0,3]'
rm camera.gltf

# a process limit: failing to start threads must not end the process. Not as root, and only with access to the folder.
for limit in 1 2 4 16; do
    code=0
    (ulimit -u $limit 2>/dev/null || exit 0
        exec "$facet" render $small -j 4 -o few.png >out 2>err) || code=$?
    case $code in 0 | 8) ;; *) failed "exit code $code with ulimit -u $limit" ;; esac
done
rm -f few.png

# links as outputs are replaced, never followed, except links to descriptors such as /dev/stdout
echo kept >target.png
ln -s target.png link.png
expect 0 render $small tri.gltf -o link.png
is_type link.png "PNG image data"
[ "$(cat target.png)" = kept ] || failed "a link led to another file"
rm link.png target.png
ln -s /proc/self/fd/1 stdout.png
if [ -e /proc/self/fd/1 ]; then
    "$facet" render $small tri.gltf -o stdout.png >target.png
    [ -L stdout.png ] && is_type target.png "PNG image data" || failed "a link to standard output was replaced"
fi
rm -f stdout.png target.png
ln -s tri.gltf link.png
expect 2 render $small tri.gltf -o link.png
rm link.png
long=$(printf '%0251d' 0)
expect 0 render $small tri.gltf -o "$long.png"
rm "$long.png"

# a pipe may never get a reader: the time limit and SIGTERM end the wait
mkfifo pipe.png
within 10 7 render $small tri.gltf -o pipe.png --time-limit 300ms
says "time limit"
"$facet" render $small tri.gltf -o pipe.png 2>err &
process=$!
sleep 0.5
kill $process
code=0
wait $process || code=$?
[ $code = 75 ] || failed "exit code $code, not 75, after SIGTERM while waiting for a reader"
rm pipe.png
# nor a writer, as a list of models or a configuration
mkfifo pipe
for verb in "render $small -o {stem}.png" 'convert -o {stem}.glb' inspect; do
    within 10 7 $verb --files-from pipe --time-limit 300ms
    says "pipe: the time limit"
done
within 10 7 render $small --config pipe --time-limit 300ms
rm pipe

# links and pipes in the place of an entry of the environment cache are neither followed nor waited for
printf '#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 2 +X 4\n' >sky.hdr
head -c 32 tri.gltf >>sky.hdr
expect 0 render $small tri.gltf --env sky.hdr --env-cache cache -o a.png
echo kept >victim
for entry in cache/*.light; do
    rm "$entry"
    ln -s ../victim "$entry"
done
within 10 0 render $small tri.gltf --env sky.hdr --env-cache cache -o b.png
[ "$(cat victim)" = kept ] || failed "the cache wrote through a link"
for entry in cache/*.light; do
    rm "$entry"
    mkfifo "$entry"
done
within 10 0 render $small tri.gltf --env sky.hdr --env-cache cache -o b.png
cmp -s a.png b.png || failed "the image depends on what is in the cache"
rm -r cache sky.hdr victim a.png b.png

# C1 control characters act on terminals like those of ASCII
csi=$(printf '\302\233')
expect 3 render "a${csi}31m.glb"
! grep -qF "$csi" err || failed "U+009B reaches the terminal"
printf '{"asset":{"version":"2.0"},"materials":[{"name":"\\u009b31m"}],"extensionsUsed":["X\\u009b1m"]}' >odd.gltf
expect 0 inspect odd.gltf
! grep -qF "$csi" out || failed "U+009B comes out of inspect"
rm odd.gltf

only tri.gltf
finish
