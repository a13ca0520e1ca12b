# An image that shows nothing of the model gives one warning, with the reason and a remedy.
expect 0 render "$case_dir/d0.obj" -o a.png --size 32
says "it counts as 1"
expect 1 render "$case_dir/d0.obj" -o a.png --size 32 --strict
expect 0 render "$case_dir/faces-away.obj" -o a.png --size 32 --strict # from both sides, as there is no material
write_triangle tri.gltf
expect 0 render tri.gltf -o a.png --size 32 --strict
sed 's/"mesh":0}/"mesh":0,"scale":[0,0,0]}/' tri.gltf >scale.gltf
sed 's/"attributes":{"POSITION":0}/"attributes":{"POSITION":0},"material":0/; s/"scene":0/"materials":[{"alphaMode":"BLEND","pbrMetallicRoughness":{"baseColorFactor":[1,1,1,0]}}],"scene":0/' tri.gltf >clear.gltf
sed 's/"mesh":0,*/"name":"Nothing"/; s/"mesh":0}/"name":"N"}/' tri.gltf >unused.gltf
# empty REASON WORD...: one warning, with that reason
empty() {
    reason=$1
    shift
    for renderer in preview path; do
        expect 0 render -o a.png --size 32 --samples 1 --renderer $renderer "$@"
        says "nothing of the model is seen: $reason"
        [ "$(wc -l <err)" = 1 ] || failed "more than one message: $*"
    done
    expect 1 render -o a.png --size 32 --samples 1 --strict --json "$@"
    grep -q "nothing of the model is seen: $reason" out || failed "--json does not say: $reason"
}
empty "it is seen from behind" tri.gltf --orbit 180
grep -q -e "--orbit 180" out && failed "the advice repeats the orbit that was given"
expect 0 render tri.gltf -o a.png --size 32 --strict --orbit 360,105 # the advice followed: --orbit AZ+180,180-POLAR
empty "it is seen from behind" tri.gltf --orbit 180 --background env
empty "it is seen from behind" tri.gltf --orbit 180 --ortho
empty "it is flat and seen edge-on" tri.gltf --orbit 90,90
empty "it is behind the camera" tri.gltf --eye 0.3,0.3,3 --target 0.3,0.3,9
empty "it is outside the image" tri.gltf --eye 0.3,0.3,3 --target 9,0.3,1
empty "it is outside the part of the image that --crop names" tri.gltf --crop 28,0,4,4
empty "it is smaller than a pixel" tri.gltf --orbit 0,90,50000m
empty "the nodes that have a mesh are scaled to 0" scale.gltf
empty "its opacity is 0" clear.gltf
empty "no node of the file has a mesh" unused.gltf
# A sequence of frames warns once.
expect 0 render tri.gltf -o 't_##.png' --size 32 --samples 1 --turntable 6
[ "$(grep -c "nothing of the model" err)" = 1 ] || failed "a turntable says it $(grep -c nothing err) times"
# A closed mesh around the camera, whose triangles face away from it.
cat >box.obj <<'END'
mtllib box.mtl
v -1 -1 -1
v 1 -1 -1
v 0 1 -1
v 0 0 1
usemtl m
f 1 3 2
f 1 2 4
f 2 3 4
f 3 1 4
END
printf 'newmtl m\nKd .5 .5 .5\n' >box.mtl
expect 0 convert box.obj box.gltf
sed 's/"doubleSided": *true/"doubleSided":false/' box.gltf >inside.gltf
empty "the camera is inside it" inside.gltf --eye 0,0,-0.5 --target 0,0,0
