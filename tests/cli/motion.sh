#!/bin/sh
# motion.sh - animations, frames, variants, videos.
set -eu
. "$(dirname "$0")/lib.sh"

# A triangle that moves 4 m to the right within 2 s (key times 0 and 2), with a static twin: write_moving FILE.
write_moving() {
    cat >"$1" <<'END'
{"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],
"extensionsUsed":["KHR_materials_variants"],
"extensions":{"KHR_materials_variants":{"variants":[{"name":"Red"},{"name":"Blue"}]}},
"materials":[{"name":"red","doubleSided":true,"pbrMetallicRoughness":{"baseColorFactor":[1,0,0,1],"metallicFactor":0}},
{"name":"blue","doubleSided":true,"pbrMetallicRoughness":{"baseColorFactor":[0,0,1,1],"metallicFactor":0}}],
"meshes":[{"primitives":[{"attributes":{"POSITION":0},"material":0,"extensions":{"KHR_materials_variants":
{"mappings":[{"material":1,"variants":[1]}]}}}]}],
"animations":[{"name":"Walk","samplers":[{"input":1,"output":2}],
"channels":[{"sampler":0,"target":{"node":0,"path":"translation"}}]}],
"accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,1,0]},
{"bufferView":1,"componentType":5126,"count":2,"type":"SCALAR","min":[0],"max":[2]},
{"bufferView":2,"componentType":5126,"count":2,"type":"VEC3"}],
"bufferViews":[{"buffer":0,"byteLength":36},{"buffer":0,"byteOffset":36,"byteLength":8},
{"buffer":0,"byteOffset":44,"byteLength":24}],
"buffers":[{"byteLength":68,"uri":"data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAAAAAAAAAAAEAAAAAAAAAAAAAAAAAAAIBAAAAAAAAAAAA="}]}
END
}
write_moving walk.gltf
view="$small --target 2.5,0.5,0 --orbit 0,90,20m"

# A single image; all frames; some of them.
expect 0 render walk.gltf -o rest.png $view
expect 0 render walk.gltf -o begin.png $view --time 0
expect 0 render walk.gltf -o middle.png $view --animation Walk --time 1
expect 0 render walk.gltf -o late.png $view --animation 0 --time 99
cmp -s rest.png begin.png || failed "time 0 is not how the nodes stand"
cmp -s begin.png middle.png && failed "nothing moved within 1 s"
cmp -s middle.png late.png && failed "nothing moved after 1 s"
expect 0 render walk.gltf -o 'all_##.png' $view --animation Walk --fps 3
only walk.gltf rest.png begin.png middle.png late.png all_01.png all_02.png all_03.png all_04.png all_05.png all_06.png
cmp -s all_01.png begin.png || failed "the first frame is not the begin"
cmp -s all_04.png middle.png || failed "frame 4 at 3 frames a second is not at 1 s"
rm all_*
expect 0 render walk.gltf -o 'some_%d.png' $view --frames 1,4-7x3 --fps 3
only walk.gltf rest.png begin.png middle.png late.png some_1.png some_4.png some_7.png
cmp -s some_4.png middle.png || failed "--frames 4 at 3 frames a second is not at 1 s"
cmp -s some_7.png late.png || failed "frame 7 is not the end"
rm some_*
expect 0 render walk.gltf $small --animation all --frames 2
only walk.gltf rest.png begin.png middle.png late.png walk_0002.png
rm walk_0002.png

# A sequence frames the whole motion: in the first and the last frame the model is at opposite borders, in the same size.
# A still frames its own pose.
expect 0 render walk.gltf -o 'f_##.png' $small --animation Walk --fps 1 --background transparent --json
expect 0 render walk.gltf -o still.png $small --time 2 --background transparent
cmp -s f_02.png still.png && failed "a frame is framed as a still"
rm f_* still.png

# Turntables: the model moves while the camera turns, or is at a fixed time.
expect 0 render walk.gltf -o 'turn_##.png' $small --turntable 4 --animation Walk --fps 2
expect 0 render walk.gltf -o 'hold_##.png' $small --turntable 4 --time 1
cmp -s turn_01.png hold_01.png && failed "a turntable with an animation does not move"
rm turn_* hold_*

# Variants.
expect 0 render walk.gltf -o red.png $view --variant Red
expect 0 render walk.gltf -o blue.png $view --variant 1
cmp -s red.png begin.png || failed "a variant without mapping is not the material of the file"
cmp -s blue.png begin.png && failed "the variant Blue changes nothing"
expect 2 render walk.gltf -o no.png --variant Green
says 'there is no variant "Green"; there are 0 "Red", 1 "Blue"'

# Videos.
expect 0 render walk.gltf -o walk.y4m $view --animation Walk --fps 2
[ "$(head -n 1 walk.y4m)" = "YUV4MPEG2 W48 H32 F2:1 Ip A1:1 C444 XCOLORRANGE=LIMITED" ] || failed "header of walk.y4m"
[ "$(wc -c <walk.y4m)" = $((56 + 4 * (6 + 3 * 48 * 32))) ] || failed "walk.y4m has $(wc -c <walk.y4m) bytes"
expect 0 render walk.gltf -o - --format y4m $view --animation Walk --fps 2
cmp -s out walk.y4m || failed "standard output gets another video than a file"
expect 0 render walk.gltf -o - --format raw $view --frames 1-3
[ "$(wc -c <out)" = $((3 * 4 * 48 * 32)) ] || failed "3 raw frames are $(wc -c <out) bytes"
# The reader of the messages exits: the video is aborted without remains.
mkdir gone
{ "$facet" render walk.gltf -o gone/w.y4m $view --animation Walk --fps 50 -v 2>&1 || echo $? >code; } | head -c 1 >/dev/null
[ "$(cat code)" = 141 ] || failed "exit code $(cat code) without a reader of messages"
[ -z "$(ls -A gone)" ] || failed "without a reader of messages there is $(ls -A gone)"
rm -r gone code
expect 0 render walk.gltf -o w.y4m --format raw $view --frames 1 --fps 29.97
expect 6 render walk.gltf -o /dev/null/is/no.y4m $view --animation Walk

# Conflicting options.
expect 2 render walk.gltf -o a.png --animation Walk
says 'one name for the frames of an animation'
expect 2 render walk.gltf -o a.png --frames 1-3
expect 2 render walk.gltf -o 'a_##.png' --frames 3-1
says "--frames: \"3-1\" is not a list of at most a million frames"
expect 2 render walk.gltf -o 'a_##.png' --frames 1-3 --time 1
expect 2 render walk.gltf -o 'a_##.png' --animation Run
says 'there is no animation "Run"; there is only 0 "Walk"'
expect 2 render walk.gltf -o 'a_##.y4m' --animation Walk
expect 2 render -o a.png --time 1
says "it has no animation for --time"
expect 0 render walk.gltf -o a.png $small --animation none
[ -e a.png ] || failed "--animation none draws no image"

finish
