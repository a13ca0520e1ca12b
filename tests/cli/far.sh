#!/bin/sh
# far.sh - models far from the origin of their file: coordinates are the file's, images those of the same model at the
# origin (src/scene/origin.h).
set -eu
. "$(dirname "$0")/lib.sh"

# write_bowl FILE X Y Z: a bowl 2 m wide around that point, exact in six decimals.
write_bowl() {
    awk -v x="$2" -v y="$3" -v z="$4" 'BEGIN {
        n = 8
        print "o bowl"
        for (j = 0; j <= n; j++)
            for (i = 0; i <= n; i++) {
                u = 2 * i / n - 1
                v = 2 * j / n - 1
                printf "v %.6f %.6f %.6f\n", x + u, y + 0.5 * (u * u + v * v) + 0.25 * u, z + v
            }
        for (j = 0; j < n; j++)
            for (i = 1; i <= n; i++) {
                a = j * (n + 1) + i
                printf "f %d %d %d %d\n", a, a + n + 1, a + n + 2, a + 1
            }
    }' >"$1"
}

write_bowl near.obj 0 0 0
expect 0 render near.obj -o near.png $small
expect 0 render near.obj -o near_eye.png $small --eye=1.5,2.25,3 --target=0,0.25,0
expect 0 render near.obj -o near_turn_##.png $small --turntable 2
expect 0 convert near.obj near.glb
for place in 1000,0,0 0,-100000,0 1000000,1000000,-1000000 0,0,10000000 -100000000,100000000,4526331; do
    x=${place%%,*}
    z=${place##*,}
    y=${place#*,}
    y=${y%,*}
    write_bowl far.obj "$x" "$y" "$z"
    expect 0 render far.obj -o far.png $small
    [ ! -s err ] || failed "a warning about text, whose digits are all there"
    cmp -s near.png far.png || failed "the model looks different at $place"

    # Cameras stand in the file's coordinates.
    eye=$(echo "$x $y $z" | awk '{ printf "%.9f,%.9f,%.9f", $1 + 1.5, $2 + 2.25, $3 + 3 }')
    target=$(echo "$x $y $z" | awk '{ printf "%.9f,%.9f,%.9f", $1, $2 + 0.25, $3 }')
    expect 0 render far.obj -o far_eye.png $small "--eye=$eye" "--target=$target"
    cmp -s near_eye.png far_eye.png || failed "--eye and --target look elsewhere at $place"
    expect 0 render far.obj -o far_turn_##.png $small --turntable 2
    cmp -s near_turn_02.png far_turn_02.png || failed "the turntable looks different at $place"

    # The offset becomes the translation of a node, so that the floats of the vertices keep what the text had.
    expect 0 convert far.obj far.gltf
    expect 0 render far.gltf -o glb.png $small
    cmp -s near.png glb.png || failed "as glTF the model looks different at $place"
    expect 0 convert far.gltf back.obj
    expect 0 render back.obj -o back.png $small
    cmp -s near.png back.png || failed "and back as OBJ at $place"
    awk '/^v / { printf "v %.6f %.6f %.6f\n", $2, $3, $4 }' far.obj | sort -u >wanted
    awk '/^v / { printf "v %.6f %.6f %.6f\n", $2, $3, $4 }' back.obj | sort -u >found
    cmp -s wanted found || failed "the coordinates that came back are others at $place"
    expect 0 inspect --json far.gltf
    low=$(echo "$x $y $z" | awk '{ printf "[%d,%.5f,%d]", $1 - 1, $2 - 0.03125, $3 - 1 }')
    tr -d ' \n' <out | grep -qF "\"bounds\":{\"min\":$low" || failed "inspect: the bounds do not begin at $low"
done
expect 0 inspect far.obj
grep -qF 'from (-100000001, 99999999.9688, 4526330) to' out || failed "inspect: the digits of bounds do not show a place"

# A few distant parts affect neither the framing nor the origin.
{ cat far.obj; printf 'o stray\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf -3 -2 -1\n'; } >stray.obj
expect 0 render stray.obj -o stray.png $small
cmp -s near.png stray.png || failed "one triangle elsewhere changes the image"
grep -q "32-bit" err && failed "one triangle elsewhere is what a warning is about"

# Vertices stored as floats have lost precision: one warning gives the amount.
cat >coarse.gltf <<'END'
{"asset":{"version":"2.0"},"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],
"meshes":[{"name":"roof","primitives":[{"attributes":{"POSITION":0}}]}],
"accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[1000000,0,0],"max":[1000001,1,0]}],
"bufferViews":[{"buffer":0,"byteLength":36}],
"buffers":[{"byteLength":36,"uri":"data:application/octet-stream;base64,ACR0SQAAAAAAAAAAECR0SQAAAAAAAAAAACR0SQAAgD8AAAAA"}]}
END
expect 0 render coarse.gltf -o coarse.png $small --background grey
says 'coarse.gltf: mesh "roof" has vertices 1e+06 m from its origin, where 32-bit numbers have steps of 0.062 m: finer detail is lost in the file'
[ "$(wc -l <err)" = 1 ] || failed "more than one line about it"
expect 0 convert coarse.gltf coarse_again.gltf
expect 0 render coarse_again.gltf -o coarse_again.png $small --background grey
cmp -s coarse.png coarse_again.png || failed "the model looks different after it was written"

# A sea has an origin of its own.
if "$facet" --help | grep -q ' ocean '; then
    expect 0 ocean --with far.obj -o sea.png --size 48x32 --quality draft
    says "--with: far.obj is far from the origin of its file; it floats as if the origin were at -100000000, 100000000, 452633"
fi
finish
