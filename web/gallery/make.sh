#!/bin/sh
# make.sh FACET DIST - the gallery's models (DIST/models) and pictures (DIST/pictures), made by this project's own tools.
# FACET: the command of the native build; without it there are no pictures. Kept until this folder's files change.
set -eu
facet=$1
dist=$2
here=$(CDPATH= cd -- "$(dirname -- "$0")" && pwd)
stamp=$dist/pictures/.made
[ ! -f "$stamp" ] || [ "$stamp" -ot "$here/make.sh" ] || [ "$stamp" -ot "$here/make_models.mjs" ] || exit 0
mkdir -p "$dist/pictures"
node "$here/make_models.mjs" "$dist/models"
[ -x "$facet" ] || { echo "web: there is no $facet: the gallery has no pictures" >&2; exit 0; }
"$facet" convert -q "$here/../../docs/examples/obj/boat.obj" "$dist/models/boat.glb"
cp "$here/../../docs/examples/gltf/spin.gltf" "$dist/models/spin.gltf"

# draw NAME COMMAND OPTION... - a picture of a card
draw() {
    picture=$dist/pictures/$1.webp
    shift
    "$facet" "$@" -q -s 400x250 -o "$picture"
}
draw builtin render --background '#eef1f5'
for name in roughness clearcoat sheen glass iridescence; do
    draw "$name" render "$dist/models/$name.glb" --background '#eef1f5'
done
draw boat-before render "$dist/models/boat.glb" --shading ogl1 --orbit 40deg,70deg,90% --background '#eef1f5'
draw boat render "$dist/models/boat.glb" --orbit 40deg,70deg,90% --background '#eef1f5'
draw spin render "$dist/models/spin.gltf" --background '#eef1f5' --time 0.4
draw ocean ocean --wind 8 --sun 9,0 --heading 14
draw sunset ocean --wind 7 --sun 2,0 --heading 8
draw lagoon ocean --preset lagoon --sun 65,120 --eye 0,2,0 --target 0,0,7 --fov 50 --exposure 0.8 --tone-mapping aces
draw gale ocean --preset gale --sun 30,0
draw below ocean --preset lagoon --sun 50,0 --height-of-eye -1.2
# two images, 2 pixels between them and 30 rows of labels below
"$facet" ocean --wind 8 --sun 20,0 --before-after -q -s 199x220 -o "$dist/pictures/before.webp"
"$facet" plot brdf --roughness 0.15,0.3,0.6 --angle 50 -q -s 400x250 --title '' -o "$dist/pictures/explorer.png" ||
    cp "$dist/pictures/roughness.webp" "$dist/pictures/explorer.png" # a facet without cairo
: >"$stamp"
