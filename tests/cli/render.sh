#!/bin/sh
# render.sh - images: every format, names, sizes, cameras, turntables.
set -eu
. "$(dirname "$0")/lib.sh"

expect 0 render $small
says "facet.png: 48x32, 1 sample"
is_type facet.png "PNG image data, 48 x 32, 8-bit/color RGB"
rm facet.png
for case in "a.png:PNG image data, 48 x 32" "a.jpg:JPEG image data" "a.JPEG:JPEG image data" "a.webp:Web/P image" \
    "a.exr:OpenEXR image data" "a.hdr:Radiance" "a.pfm:"; do
    name=${case%%:*}
    expect 0 render $small -o $name
    [ ! -s err ] || failed "unrequested messages, with $name"
    is_type $name "${case#*:}"
    rm $name
done
expect 0 render $small -o a.dat --format png16
is_type a.dat "PNG image data, 48 x 32, 16-bit/color RGB"
expect 0 render $small -o a.exr --aov all
for channel in Z normal.X albedo.R material.id object.id instance.id uv.U occlusion.A CryptoObject00.R \
    CryptoInstance02.A cryptomatte/3ae39a5/manifest MurmurHash3_32; do
    grep -qaF $channel a.exr || failed "a.exr lacks the channel $channel"
done
expect 0 render $small -o a.png --background transparent
is_type a.png "8-bit/color RGBA"
expect 0 render $small -o b.png --crop 8,4,16,12 -v
says "b.png: 16x12"
is_type b.png "16 x 12"
rm a.* b.*

# differ|same OPTIONS -- OPTIONS: whether both images differ
compare() {
    relation=$1
    left=$2
    right=$3
    expect 0 render $small -o a.png $left
    expect 0 render $small -o b.png $right
    if cmp -s a.png b.png; then
        [ $relation = same ] || failed "same image: $left | $right"
    else
        [ $relation = differ ] || failed "different images: $left | $right"
    fi
    rm -f a.png b.png
}
write_triangle tri.gltf

# A white triangle on white: a hint, once for all images, which is no warning.
sed '1s/{/{"materials":[{"doubleSided":true}],/; s/"primitives":\[{/&"material":0,/' tri.gltf >white.gltf
expect 0 render white.gltf -o 't_##.png' --size 64 --turntable 2 --strict
says "white.gltf: the outline hardly shows on a background of nearly its own color; another --background or --ground shadow"
[ "$(grep -c "outline hardly" err)" = 1 ] || failed "the hint at the outline does not come once"
for options in --quiet "--background #888" "--background transparent" "--ground shadow" "--background env"; do
    expect 0 render white.gltf -o t.png --size 64 $options
    ! grep -q "outline" err || failed "a hint at the outline with $options"
done
rm t_*.png t.png white.gltf
compare same "" "--orbit 0,75,105%"
compare differ "" "--orbit 30"
compare same "--orbit 30" "--orbit 30deg,auto,auto"
compare same "--orbit 390" "--orbit 30,75"
compare differ "" "--fov 50"
compare differ "" "--ortho"
compare differ "" "--up z"
compare differ "" "--target 0.5,0,0"
compare differ "" "--eye 1,1,5"
compare differ "" "--exposure 1"
compare same "--exposure 1" "--exposure 2x"

# Attributes of model-viewer; its exposure is a factor, noted once, and only if it may be meant.
expect 0 render $small -o a.png --camera-orbit "45deg 55deg 4m" --camera-target "0m 0m auto" --field-of-view 30deg
expect 0 render $small -o b.png --orbit 45,55,4m --target 0,0,auto --fov 30
cmp -s a.png b.png || failed "attributes of model-viewer are other options"
expect 0 render $small -o a.png --camera-orbit 45deg --exposure 1.2 --strict
says "exposure is a factor, which is written --exposure 1.2x"
for plain in "--exposure 1.2" "--camera-orbit 45deg --exposure 1.2x" "--camera-orbit 45deg --exposure +1.2"; do
    expect 0 render $small -o a.png $plain
    grep -q 'the factor' err && failed "a note on what is plain: $plain"
done
compare differ "" "--tone-mapping agx"
compare same "" "--tone-mapping neutral"
compare differ "" "--env white"
compare differ "--env white" "--env none"
compare same "--env #ffffff" "--env white"
compare same "--env none" "--env-intensity 0"
compare same "--env-intensity 2 --background black" "--background black --env-intensity 2"
compare differ "" "--env-rotation 90"
compare differ "" "--background env"
compare differ "--background env" "--background env --background-blur 0.7"
compare same "" "--background white"
compare same "" "--ao=off"
compare same "--ground shadow" "--ground shadow --ao"
expect 2 render $small --ao=much -o a.png
says "--ao"
expect 2 render $small --ao --renderer gl -o a.png
says "it needs --renderer preview or path"
expect 2 render $small --ao --shading ogl1 -o a.png
compare same "--background #336699" "--background #369"
compare differ "" "--energy gltf"
compare same "" "--energy conserving"
compare differ "-n 1" "-n 16"
compare differ "tri.gltf" "tri.gltf --camera Hero"
compare same "tri.gltf --camera Hero" "tri.gltf --camera 0"
compare same "tri.gltf" "tri.gltf --scene 0"
expect 2 render $small tri.gltf -o a.png --camera Villain
says '"Hero"'
expect 2 render $small tri.gltf -o a.png --scene 7
expect 2 render $small tri.gltf -o a.png --eye 1,2,3 --target 1,2,3
only tri.gltf

# names
expect 0 render $small tri.gltf
says "tri.png"
cp tri.gltf other.gltf
mkdir thumbs
expect 0 render $small tri.gltf other.gltf -o 'thumbs/{stem}.webp'
[ -s thumbs/tri.webp ] && [ -s thumbs/other.webp ] || failed "thumbs holds $(ls thumbs)"
expect 0 render $small tri.gltf -o 'still_####.png'
[ -s still_0001.png ] || failed "no still_0001.png"
expect 0 render $small --preset thumbnail tri.gltf -o thumb.png
[ ! -s err ] || failed "a thumbnail makes messages"
is_type thumb.png "48 x 32, 8-bit/color RGBA"
rm -r thumbs other.gltf ./*.png

# turntable
expect 0 render $small --turntable 3 -o 'turn_%02d.png'
expect 0 render $small --turntable 2 --orbit 10 -o 't_##.png' --ortho
only tri.gltf turn_01.png turn_02.png turn_03.png t_01.png t_02.png
! cmp -s turn_01.png turn_02.png || failed "the turntable does not turn"
expect 0 render $small --turntable 3 -o '{stem}_%d.png' --orbit 0,75,4m --target 0,0,0
rm ./*.png

# A camera as a matrix is the same camera.
write_triangle matrix.gltf
expect 0 render $small matrix.gltf --camera Hero -o hero.png
for words in "--camera-matrix 1,0,0,0,0,1,0,0,0,0,1,0,0.3,0.3,3,1" "--view-matrix 1,0,0,0,0,1,0,0,0,0,1,0,-0.3,-0.3,-3,1" \
    "--camera-matrix [2,0,0,0,0,2,0,0,0,0,2,0,0.3,0.3,3,1]"; do
    expect 0 render $small matrix.gltf $words --fov 0.6rad -o matrix.png
    cmp -s hero.png matrix.png || failed "another image: $words"
done
# rolled by 90 degrees and turned: a matrix and its inverse
expect 0 render $small matrix.gltf --camera-matrix 0,1,0,0,-1,0,0,0,0,0,1,0,0.3,0.2,4,1 -o rolled.png
expect 0 render $small matrix.gltf --view-matrix 0,-1,0,0,1,0,0,0,0,0,1,0,-0.2,0.3,-4,1 -o rolled_view.png
cmp -s rolled.png rolled_view.png || failed "a view matrix is not the inverse"
cmp -s hero.png rolled.png && failed "a rolled camera shows the same"
expect 2 render matrix.gltf --camera-matrix 1,2,3 -o x.png
says "16 numbers, column by column"
expect 2 render matrix.gltf --camera-matrix 1,0,0,0.3,0,1,0,0.3,0,0,1,3,0,0,0,1 -o x.png
says "in column-major order"
expect 2 render matrix.gltf --camera-matrix 1,0,0,0,0,1,0,0,0,0,-1,0,0,0,3,1 -o x.png
says "it mirrors"
expect 2 render matrix.gltf --camera-matrix 1,0,0,0,1,1,0,0,0,0,1,0,0,0,3,1 -o x.png
says "not at right angles"
expect 2 render matrix.gltf --view-matrix 0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,1 -o x.png
expect 2 render matrix.gltf --camera-matrix 1,0,0,0,0,1,0,0,0,0,1,0,0,0,3,1 --orbit 30 -o x.png
says "excludes --orbit"
rm -f hero.png matrix.png matrix.gltf rolled.png rolled_view.png

# --no-clobber and --config
echo keep >a.png
expect 0 render $small -o a.png --no-clobber
says "a.png: kept"
[ "$(cat a.png)" = keep ] || failed "--no-clobber overwrote"
expect 0 render missing.glb -o a.png --no-clobber
expect 0 render $small -o 'n_##.png' --turntable 2
rm n_02.png
cp n_01.png copy.png
expect 0 render $small -o 'n_##.png' --turntable 2 --no-clobber --background red
cmp -s n_01.png copy.png || failed "--no-clobber overwrote a frame"
[ -s n_02.png ] || failed "--no-clobber left out a frame"
rm ./*.png
printf '{"size": [20, 10], "background": "transparent", "quality": "draft", "quiet": true}' >c.json
expect 0 render --config c.json
is_type facet.png "20 x 10, 8-bit/color RGBA"
expect 0 render --config c.json --size 30
is_type facet.png "30 x 30"
printf '{"siez": 3}' >c.json
expect 2 render --config c.json
says "c.json: unknown option --siez; did you mean --size?"
printf '{"size": ' >c.json
expect 2 render --config c.json
expect 3 render --config missing.json
finish
