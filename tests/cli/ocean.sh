#!/bin/sh
# ocean.sh - the sea: images, sequences, meshes, maps, sweeps, styles, floating models, and errors.
set -eu
. "$(dirname "$0")/lib.sh"

# A sky costs a third of a second; most images make do with two colors and a directional sun.
small="$small --resolution 32"
light="-e gradient:0.2/0.3/0.6,0.8 --env-intensity 5000 --sun 22,0,80000"

# How to begin.
expect 2 ocean
says "facet ocean -o sea.png"
if ! "$facet" ocean --info >out 2>err; then # without a library of transforms there is flat water only
    [ $? = 5 ] || failed "without waves the exit code is another than 5"
    expect 0 ocean --wind 0 $small -o flat.png
    finish
    exit
fi
expect 0 help ocean --help-all
for option in preset wind chl before-after sweep with maps; do
    grep -q -- "--$option" out || failed "the help does not tell of --$option"
done

# Numbers of the reference.
value() { # value NAME: a number of the JSON of ./out
    sed -n "s/.*\"$1\": *\\(-\\{0,1\\}[0-9.e+-]*\\).*/\\1/p" out
}
near() { # near NAME NUMBER SHARE
    value "$1" | awk -v b="$2" -v e="$3" '{ d = $1 - b; if (d < 0) d = -d; exit !(d <= e * b) }' ||
        failed "$1 is $(value "$1"), not $2"
}
expect 0 ocean --preset gale --json
near height_m 8.978 0.01
near peak_period_s 12.83 0.01
near wind_mps 20 0
expect 0 ocean --wind 10 --fetch 100km --json
near height_m 2.139 0.01
expect 0 ocean --wind 0 --swell 2,12,0 --json
near height_m 2 0.01
near peak_period_s 12 0.01
expect 0 ocean --preset gale --wind 5 --json
near wind_mps 5 0
expect 0 ocean --preset trade-wind --info
grep -q '^significant height *2.24 m' out || failed "--info does not tell the height"

# Images
expect 0 ocean $small -o sky.png
is_type sky.png "PNG image data, 48 x 32"
for words in "--sun 10" "--turbidity 6" "-e white" "--env none"; do
    expect 0 ocean $small -o other.png $words
    cmp -s sky.png other.png && failed "nothing changes with $words"
done
rm -f sky.png other.png
small="$small $light"
expect 0 ocean $small -o sea.png
is_type sea.png "PNG image data, 48 x 32"
expect 0 ocean $small -o again.png -j 3
cmp -s sea.png again.png || failed "the image depends on the threads"
expect 0 ocean $small -o sea.png --no-clobber
says "sea.png: kept"
expect 0 ocean $small -o - --format png
cmp -s out sea.png || failed "standard output has another image"
expect 0 ocean $small --crop 8,4,16,12 -o crop.exr
different() { # different WORD...: another image than sea.png
    expect 0 ocean $small -o other.png "$@"
    cmp -s sea.png other.png && failed "nothing changes with $*"
    rm -f other.png
}
different --preset glass
different --sun 40,0,80000
different --heading 120
different --exposure 1
different --ev100 10
different --tone-mapping aces
different --seed 2
different --time 1
different --before A
if ! is_quick; then
    for words in "--preset breeze" "--preset gale" "--preset lagoon" "--preset harbour" "--wind 10,0" \
        "--swell 3,12,45" "--spectrum elfouhaily" "--spreading cosine" "--choppiness 0" "--resolution 64" "-e white --env-intensity 5000" \
        "--cascades 1" "--water 9C" "--chl 10" "--absorption 0.1,0.2,0.3" "--depth 2" "--ior 1.4" \
        "--depth 3 --bed-slope 0.1,45" "--depth 2 --bed-color white" "--eye 0,30,0" \
        "--height-of-eye 10" "--height-of-eye -5" "--target 5,0,5" "--fov 60" "--before B" "--stage 1" "--stage 2" \
        "--stage 3" "--stage 4" "--roughness 0.9" "--normals ggx" "--masking schlick --heading 10" "--fresnel schlick" \
        "--samples 3" "--clamp 0.1"; do
        different $words
    done
fi
rm -f ./*.png ./*.exr

# Sequences
expect 0 ocean $small -o 'f_##.png' --frames 1-3 --fps 2
only f_01.png f_02.png f_03.png
cmp -s f_01.png f_02.png && failed "frames are the same"
expect 0 ocean $small -o second.png --time 0.5
cmp -s second.png f_02.png || failed "frame 2 of 2 a second is not at 0.5 s"
expect 0 ocean $small -o 'l_##.png' --loop 2 --frames 1,5,6 --fps 2
cmp -s l_01.png l_05.png || failed "a loop of 2 s does not repeat after 4 frames of 2 a second"
cmp -s l_02.png l_06.png && failed "there is an unrequested frame"
expect 2 ocean $small -o one.png --frames 1-3
says "put #### in it"
expect 2 ocean $small -o 'a_##.png' --fps 12
says "a sea has no end"
expect 0 ocean $small -o film.y4m --frames 1-2
[ "$(head -c 9 film.y4m)" = YUV4MPEG2 ] || failed "film.y4m is no video"
rm -f ./*.png film.y4m

# Meshes, maps
expect 0 ocean --mesh-samples 16 -o sea.glb --wind 8
expect 0 inspect sea.glb
for extension in ior transmission volume; do
    grep -q "KHR_materials_$extension *supported" out || failed "the mesh has no KHR_materials_$extension"
done
expect 0 ocean --mesh-samples 16 --mesh-size 50 -o sea.obj --depth 4
expect 0 inspect sea.obj
grep -q "2 materials\|bed" out || failed "sea.obj has no bed"
expect 0 render sea.glb --size 48x32 --quality draft -o mesh.png
mkdir maps
expect 0 ocean --resolution 32 --cascades 2 --maps maps
[ -s maps/tile_00.exr ] && [ -s maps/tile_01.exr ] || failed "there are no maps"
expect 0 ocean --resolution 32 --cascades 1 --maps 'm_##.exr'
cmp -s m_00.exr maps/tile_00.exr && failed "another number of tiles has the same first one"
expect 6 ocean --maps /dev/null/maps
expect 0 ocean $small --resolution 32 --cascades 1 --maps maps --frames 1-2 -o 'f_##.png'
[ -s maps/tile_00_0002.exr ] || failed "there is no map of the second frame"
cmp -s maps/tile_00_0001.exr maps/tile_00_0002.exr && failed "maps of two frames are the same"
expect 2 ocean --maps 'm_##.png'
says ".exr"
expect 2 ocean --maps 'm_##.exr' --frames 1-2
says "a folder"
expect 7 ocean --maps maps --time-limit 1ms
expect 7 ocean -o large.obj --mesh-samples 1024 --time-limit 1s
says "the time limit (--time-limit) was reached"
[ ! -e large.obj ] && [ ! -e large.mtl ] || failed "a mesh was written after the time limit"
expect 7 ocean -o large.glb --time-limit 1ms
rm -rf maps ./*.exr ./*.glb ./*.obj ./*.mtl ./*.png

# Inputs are not replaced.
mkdir maps
expect 0 ocean $small -s 64x32 --cascades 1 --resolution 32 -o maps/tile_00.exr
cp maps/tile_00.exr saved
cp saved sky_01.exr
kept() { # kept FILE
    says "this input would be overwritten"
    cmp -s "$1" saved || failed "the input $1 was overwritten"
}
expect 2 ocean $small -e sky_01.exr -o 'sky_##.exr' --frames 1-2
kept sky_01.exr
expect 2 ocean $small -e maps/tile_00.exr --maps maps -o a.png
kept maps/tile_00.exr
expect 2 ocean $small --maps maps -o maps/tile_00.exr
says "is also a file of --maps"
rm -rf maps ./*.exr saved

# Sheets
expect 0 ocean $small -s 32x24 --sweep heading=5:60:2,wind=2:12:3 -o sheet.png
is_type sheet.png "PNG image data, 68 x"
expect 2 ocean $small --sweep rouhgness=0.1:0.2:2 -o sheet.png
says "--sweep: unknown option --rouhgness; did you mean --roughness?"
expect 2 ocean $small --sweep orbit=1:2:3 -o sheet.png
says "--sweep: --orbit is an option of facet render"
expect 2 ocean $small --sweep roughness=0.1:0.2 -o sheet.png
says "NAME=FROM:TO:COUNT"
expect 2 ocean $small --sweep output=1:2:2 -o sheet.png
says "is not one number"
expect 2 ocean $small --sweep wind=3:5:2, -o sheet.png
expect 2 ocean $small --sweep wind=3:5:2,wind=1:2:2 -o sheet.png
says "both axes"
expect 2 ocean $small --sweep seed=1e300:1e300:1 -o sheet.png
expect 0 ocean $small -s 32x24 --sweep seed=4294967295:4294967295:1 -o sheet.png
expect 2 ocean $small --sweep roughness=0:9:2 -o sheet.png
expect 0 ocean $small -s 32x24 --before-after -o both.png
is_type both.png "PNG image data, 66 x"
rm -f ./*.png

# Floating models
write_triangle boat.gltf
expect 0 ocean $small --with boat.gltf -o a.png
expect 0 ocean $small --with boat.gltf@0,-20 -o a.png
says "towards 180 degrees, and the camera looks towards 36"
expect 0 ocean $small --with boat.gltf@3,5,90 -o a.png
grep -q "out of view" err && failed "a model in view is said to be out of it"
# A model of another unit is reported with its size; a boat is not.
expect 0 ocean $small --with boat.gltf -o a.png --strict
for scale in 5000 0.002; do
    sed "s/\"mesh\":0/\"mesh\":0,\"scale\":[$scale,$scale,$scale]/" boat.gltf >scaled.gltf
    place=
    [ $scale = 5000 ] || place=@0,-20
    expect 1 ocean $small --with scaled.gltf$place -o a.png --strict
    says "--with: the model is"
    says "m large"
done
sed 's/"mesh":0/"mesh":0,"translation":[0,-2,0]/' boat.gltf >sunk.gltf
expect 0 ocean $small --with sunk.gltf -o a.png
says "m or more under water"
rm -f scaled.gltf sunk.gltf
# Lamps so far away under water that what arrives is below the least normal number
nodes=$(for x in 0 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16; do printf '{"mesh":0,"translation":[%s,1,0]},' $x; done)
sed "s/\"nodes\":\[0,1\]/\"nodes\":[0,1,2,3,4,5,6,7,8,9,10,11,12,13,14,15,16]/; s/^\"nodes\".*/\"nodes\":[${nodes%,}],/
    s/^\"cameras\".*/\"materials\":[{\"emissiveFactor\":[1,1,1],\"doubleSided\":true}],/; s/\"POSITION\":0}/&,\"material\":0/" boat.gltf >lamps.gltf
expect 0 ocean --preset lagoon --with lamps.gltf@0,0 --eye 0,30,10 --target 0,0,-2500 --fov 20 --renderer path --samples 16 -s 64x48 -o a.png
grep -q "not finite" err && failed "light from far away is not finite"
rm -f lamps.gltf
# OpenGL 1's shading of the model
expect 0 ocean $small --with boat.gltf --shading ogl1 --tone-mapping none -o c.png
expect 0 ocean $small --with boat.gltf --tone-mapping none -o b.png
cmp -s b.png c.png && failed "--shading ogl1 changes nothing"
expect 2 ocean $small --shading ogl1 -o b.png
says "--shading: it needs a model"
expect 2 ocean $small --with boat.gltf --shading ogl1 --renderer path -o b.png
says "--shading"
expect 3 ocean $small --with missing.glb -o b.png
says "missing.glb"
expect 2 ocean $small --with boat.gltf@3,x -o b.png
says "MODEL@X,Z"
cp boat.gltf saved.gltf
expect 2 ocean $small --with boat.gltf -o boat.gltf
cmp -s boat.gltf saved.gltf || failed "an input was overwritten"
# Several models, and a camera of one of them
expect 0 ocean $small --with boat.gltf@0,-20 --with boat.gltf@-4,-20,90 --heading 180 -o two.png --json
grep -q '"model_matrices"' out || failed "--json lacks the places of two models"
expect 0 ocean $small --with boat.gltf@0,-20 --heading 180 -o one.png
cmp -s one.png two.png && failed "a second model is not there"
expect 0 ocean $small --with boat.gltf --with boat.gltf -o a.png --strict
printf '{"with": ["boat.gltf@0,-20", "boat.gltf@-4,-20,90"], "heading": "180"}' >sea.json
expect 0 ocean $small --config sea.json -o a.png
cmp -s a.png two.png || failed "the models of a config are not those of the command line"
expect 0 ocean $small --with boat.gltf@0,-8 --with boat.gltf@0,0 --camera Hero -o a.png
expect 0 ocean $small --with boat.gltf@0,-8 --with boat.gltf@0,0 --camera 0 -o b.png
cmp -s a.png b.png || failed "the camera by number is another"
expect 0 ocean $small --with boat.gltf@0,-8 --with boat.gltf@0,0 --camera 1 -o b.png
cmp -s a.png b.png && failed "the camera of the second model is that of the first"
expect 2 ocean $small --with boat.gltf --camera Keel -o b.png
says 'there is no camera "Keel"'
# Messages name the file of the model.
sed 's/"meshes":\[{"primitives":\[{/"images":[{"uri":"data:image\/png;base64,iVBORw0KGgo="}],"textures":[{"source":0}],'\
'"materials":[{"pbrMetallicRoughness":{"baseColorTexture":{"index":0}}}],&"material":0,/' boat.gltf >painted.gltf
sed 's/"Hero"/"Bow"/' boat.gltf >eye.gltf
expect 0 ocean $small --with boat.gltf@0,-20 --with painted.gltf@0,-20 --heading 180 -o b.png
says "painted.gltf: image 0"
expect 0 ocean $small --with painted.gltf@0,-20 --with painted.gltf@0,-20 --heading 180 -o b.png
says "painted.gltf: image 0"
grep -q "image 1" err && failed "an image has the number of another file"
expect 2 ocean $small --with boat.gltf --with eye.gltf --camera 7 -o b.png
says 'boat.gltf, eye.gltf: there is no camera "7"; there are 0 "Hero", 1 "Bow"'
# Layers
expect 0 ocean $small --with boat.gltf --aov depth,object -o a.exr
grep -q 'object.id' a.exr || failed "no layer of objects"
expect 0 ocean $small --with boat.gltf --aov object -o b.png
rm -f ./*.png ./*.gltf ./*.exr sea.json

# Invalid requests
for words in "--sun 22,1e300" "--depth 1e39" "--bed-slope 1,1e300 --depth 3" "--wind 10,1e300" "--swell 2,0.01" \
    "--absorption 1e300,0,0" "--eye 1e39,0,0" "--target 0,1e39,0" "--heading 1e300" "--env-rotation 1e300 -e white"; do
    expect 2 ocean $words -o a.png
    says "${words%% *}:"
done
expect 2 ocean --stage 2 -o a.glb
says "an option of images"
expect 2 ocean --ground shadow -o a.png
says "the water and its bed are the ground"
expect 2 ocean --camera Bridge -o a.png
says "--camera: it needs a model"
expect 2 ocean --with a.glb --camera Bridge --fov 30 -o a.png
says "--camera: it excludes --fov"
expect 2 ocean --with a.glb --sweep wind=1:2:2 --aov depth -o a.exr
says "--aov: a sheet has no layers"
expect 2 ocean --aov depth -o a.png
says "--aov: layers need an .exr file"
expect 2 ocean --aov variance -o a.exr
says "--aov: variance needs --renderer path"
expect 2 ocean --wind 50 -o a.png
says "0 to 40 m/s"
expect 2 ocean --preset pond -o a.png
expect 2 ocean --chl 1 --water IB -o a.png
says "give one of them"
expect 2 ocean --bed-slope 0.1 -o a.png
says "--depth"
expect 2 ocean --resolution 100 -o a.png
says "a power of two"
expect 2 ocean --sun 100 -o a.png
expect 2 ocean --sun 10,0,1000 -o a.png
says "lux"
expect 2 ocean --sun 10,0 -e white -o a.png
says "as 30,15,100000"
expect 2 ocean --absorption 0.1,0.2 -o a.png
expect 2 ocean --swell 30,3 -o a.png
says "at most 2 m"
expect 2 ocean -s 16x9 --height-of-eye 50001 -o a.png
says "50.001 km high"
expect 0 ocean $small --height-of-eye 50001 -o a.png
rm a.png
expect 2 ocean --eye 0,1,0 --height-of-eye 2 -o a.png
expect 2 ocean --target 0,1,0 --heading 2 -o a.png
expect 2 ocean --before A --stage 2 -o a.png
expect 2 ocean --denoise -o a.png
says "it needs --renderer path"
expect 2 ocean --renderer path --no-caustics -o a.png
expect 2 ocean --renderer path --no-glints -o a.png
says "no effect with --renderer path"
expect 2 ocean -o a.gif
expect 2 ocean extra -o a.png
expect 0 ocean -s 48x32 -o a.png -e white --sun 30,0,100000
says "--env-intensity"
expect 0 ocean $small -o a.png -e white --sun 30,0,100000 --env-intensity 10000
! grep -q env-intensity err || failed "a warning of light that is there"
expect 0 ocean $small -o a.png --depth 5 --height-of-eye -6
says "below the bed"
expect 0 ocean $small -o a.png --wind 0 --swell 4,8 --eye 0,-0.2,0
says "over a trough"
expect 0 ocean $small -o a.png --wind 0 --swell 4,8 --eye 0,0.2,0
! grep -q camera err || failed "a warning of a camera in the air"
expect 0 ocean $small -o a.png --wind 0 --swell 4,8 --time 4 --eye 0,0.2,0
says "inside of a wave"
expect 0 ocean --wind 9,-75 --info --json
grep -q '"wind_azimuth_deg": *-75.0' out || failed "the wind blows elsewhere: $(cat out)"
expect 6 ocean -o /dev/null/a.png
expect 7 ocean -o a.png --max-memory 1M
says "--max-memory"
expect 7 ocean -o a.png --time-limit 1ms
expect 7 ocean -o a.png --time-limit 1ms --json
grep -q '"exit_code": *7' out || failed "--json does not tell of the time limit"
printf '{"preset": "glass", "sweep": null}' >sea.json
expect 2 ocean --config sea.json -o a.png
printf '{"preset": "glass", "time": 3}' >sea.json
expect 0 ocean --config sea.json $small -o a.png
expect 0 ocean --preset glass $small --time 3 -o b.png
cmp -s a.png b.png || failed "the config makes another image"
expect 0 ocean $small -o a.png --json
grep -q '"output": *"a.png"' out || failed "--json does not name the image"
grep -q '"exit_code": *0' out || failed "--json does not tell the exit code"
expect 2 ocean --wind x -o a.png --json
grep -q '"exit_code": *2' out || failed "--json does not tell the failure"
if ! is_quick; then
    expect 0 ocean --size 16x12 --renderer path -n 2 --denoise -o path.png
    is_type path.png "PNG image data, 16 x 12"
fi
finish
