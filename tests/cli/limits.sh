#!/bin/sh
# limits.sh - files whose numbers ask for more work than their bytes: a time limit of 1 s ends each at any stage, and so does
# SIGTERM. The bounds are wide, for busy machines; without limits each takes 5 s to minutes.
set -eu
. "$(dirname "$0")/lib.sh"

triangle='"buffers":[{"byteLength":36,"uri":"data:;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}],
"bufferViews":[{"buffer":0,"byteLength":36}],"accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"}],
"asset":{"version":"2.0"},"scene":0'

# 100,000 nodes of one mesh of 30,000 vertices, whose floats are text: "????" is 0.747, "@@@@" 3.004, "AAAA" 12.08.
awk 'BEGIN { for (i = 0; i < 90000; i++) { c = substr("=>?@A", (i * 7919 % 104729) % 5 + 1, 1); printf "%s%s%s%s", c, c, c, c } }' >mesh.bin
awk 'BEGIN {
    printf "{\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"buffers\":[{\"byteLength\":360000,\"uri\":\"mesh.bin\"}],"
    printf "\"bufferViews\":[{\"buffer\":0,\"byteLength\":360000}],"
    printf "\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":30000,\"type\":\"VEC3\"}],"
    printf "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0}}]}],\"scenes\":[{\"nodes\":["
    for (i = 0; i < 100000; i++) printf "%s%d", i ? "," : "", i
    printf "]}],\"nodes\":["
    for (i = 0; i < 100000; i++) printf "%s{\"mesh\":0,\"translation\":[%d,%d,%d]}", i ? "," : "", i % 300, i / 300, i % 7
    printf "]}"
}' >nodes.gltf
# 3000 primitives that share those vertices and each need normals.
awk 'BEGIN {
    printf "{\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"buffers\":[{\"byteLength\":360000,\"uri\":\"mesh.bin\"}],"
    printf "\"bufferViews\":[{\"buffer\":0,\"byteLength\":360000}],\"scenes\":[{\"nodes\":[0]}],\"nodes\":[{\"mesh\":0}],"
    printf "\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":30000,\"type\":\"VEC3\"}],"
    printf "\"meshes\":[{\"primitives\":["
    for (i = 0; i < 3000; i++) printf "%s{\"attributes\":{\"POSITION\":0}}", i ? "," : ""
    printf "]}]}"
}' >shared.gltf
# 20,000 lights on one triangle.
awk -v triangle="$triangle" 'BEGIN {
    printf "{%s,\"extensionsUsed\":[\"KHR_lights_punctual\"],", triangle
    printf "\"extensions\":{\"KHR_lights_punctual\":{\"lights\":[{\"type\":\"point\",\"intensity\":5}]}},"
    printf "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0}}]}],\"nodes\":[{\"mesh\":0}"
    for (i = 0; i < 20000; i++)
        printf ",{\"translation\":[%g,%g,1],\"extensions\":{\"KHR_lights_punctual\":{\"light\":0}}}", i % 100 / 100, i / 20000
    printf "],\"scenes\":[{\"nodes\":[0"
    for (i = 1; i <= 20000; i++) printf ",%d", i
    printf "]}]}"
}' >lights.gltf
# 20,000 materials to fit.
awk 'BEGIN { for (i = 0; i < 20000; i++) printf "newmtl m%d\nKd %g .5 .2\nKs %g .3 .1\nNs %d\n", i, i % 97 / 97, i % 89 / 89, i % 997 + 1 }' >many.mtl
awk 'BEGIN {
    print "mtllib many.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0"
    for (i = 0; i < 20000; i++) printf "usemtl m%d\nf 1 2 3\n", i
}' >many.obj

# within SECONDS CODES COMMAND...: ends by then, with one of the exit codes.
within() {
    most=$1
    codes=$2
    shift 2
    begin=$(date +%s)
    code=0
    "$facet" "$@" >out 2>err || code=$?
    took=$(($(date +%s) - begin))
    case " $codes " in *" $code "*) ;; *) failed "exit code $code, none of $codes: facet $*" ;; esac
    [ $took -le "$most" ] || failed "$took s with a limit of 1 s: facet $*"
    [ $code = 0 ] || grep -q "time limit" err || failed "no word of the time limit: facet $*"
}

models="nodes.gltf shared.gltf lights.gltf many.obj"
is_quick && models=nodes.gltf
for model in $models; do
    within 5 "0 7" render --time-limit 1 --size 256 -o x.png $model
    within 5 "0 7" render --time-limit 1 --size 256 --renderer path -o x.png $model
    within 5 "0 7" inspect --time-limit 1 $model
    within 5 "0 7" convert --time-limit 1 $model -o y.glb
done
within 5 "0 7" ocean --time-limit 1 --size 4000x4000 -o x.png

# SIGTERM ends it as fast, with the exit code for a retry.
begin=$(date +%s)
code=0
timeout --preserve-status -s TERM 1 "$facet" render --size 4096 nodes.gltf -o z.png >out 2>err || code=$?
[ $code = 75 ] || failed "exit code $code, not 75, at SIGTERM"
[ $(($(date +%s) - begin)) -le 5 ] || failed "SIGTERM was not heeded"
[ ! -e z.png ] || failed "an image after SIGTERM"
finish
