#!/bin/sh
# convert.sh - models written anew.
set -eu
. "$(dirname "$0")/lib.sh"

write_triangle in.gltf
expect 0 convert in.gltf out.glb
[ ! -s err ] || failed "messages though nobody asked"
[ "$(head -c 4 out.glb)" = glTF ] || failed "out.glb is no .glb file"
expect 0 convert out.glb again.gltf
only in.gltf out.glb again.gltf again.bin
expect 0 render in.gltf -o a.png $small
expect 0 render again.gltf -o b.png $small
cmp -s a.png b.png || failed "the model looks different after it was written"
expect 0 convert again.gltf -o third.glb
expect 0 convert out.glb fourth.glb
cmp -s third.glb fourth.glb || failed "two ways to the same model give different files"
expect 0 convert --no-clobber in.gltf out.glb
says "out.glb: kept"
expect 0 convert in.gltf out.glb --json
grep -qF '"output": "out.glb"' out || grep -qF '"output":"out.glb"' out || failed "--json does not name the output"
"$facet" convert - piped.glb <out.glb || failed "standard input is not read"
cmp -s piped.glb fourth.glb || failed "standard input gives another file"

# What cannot be done leaves nothing behind.
rm -f *.glb *.png again.*
expect 2 convert in.gltf
says "one model and the name of the new one were expected"
expect 2 convert in.gltf out.obj
says '"out.obj" does not end in .glb or .gltf'
expect 2 convert in.gltf in.gltf
says "it is an input, too"
expect 3 convert missing.glb out.glb
expect 6 convert in.gltf nowhere/out.glb
says "there is no folder nowhere"
printf 'glTF' >broken.glb
expect 4 convert broken.glb out.glb
expect 4 convert broken.glb out.glb --json
grep -qF '"exit_code": 4' out || grep -qF '"exit_code":4' out || failed "--json does not tell the failure"
rm broken.glb
only in.gltf
expect 7 convert in.gltf out.glb --max-memory 1K
only in.gltf
finish
