#!/bin/sh
# pictures.sh - makes the pictures of README.md, web.md and ocean.md.
#     bench/pictures.sh FACET DATA [NAME...]     FACET: the command; DATA: a folder with models/core/WaterBottle.glb, ..;
#                                                NAME: front, turntable, viewer, a picture of ocean.md (ocean, ocean_boat, ..),
#                                                or all of them
# Writes docs/pictures/NAME. Needs img2webp (Debian: webp) for the turntable; for the picture of the viewer a built
# page (./run web --build), Chromium and npm ci in tests/clients. The pictures of ocean.md are made by the commands that stand below
# them there, those of python.md by docs/examples/python/page.py. bench/gallery.sh and bench/peers make the others.
set -eu
facet=$(readlink -f "$1")
data=$(readlink -f "$2")
shift 2
here=$(cd "$(dirname "$0")" && pwd)
pictures=$here/../docs/pictures
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

front() {
    python3 "$here/pictures/still_life.py" "$data/models" "$work/deck.glb"
    "$facet" ocean --preset lagoon --wind 6 --with "$work/deck.glb@0,0" --eye 0.06,1.43,1.4 --target 0.06,1.333,0 --fov 19.5 \
        --sun 13,78 --tone-mapping neutral --exposure -0.15 --renderer path --samples 64 --denoise \
        -s 1600x720 --jpeg-quality 88 -o "$pictures/front.jpg"
}

turntable() {
    "$facet" render "$data/models/materials/SheenChair.glb" --turntable 36 --orbit 0,72,105% --ground shadow \
        -q -s 400x300 -o "$work/chair_####.png"
    img2webp -lossy -q 75 -m 6 -d 80 "$work"/chair_*.png -o "$pictures/turntable.webp"
}

viewer() {
    node "$here/pictures/viewer.mjs" "$here/../build/web/dist" "$data/models/materials/MaterialsVariantsShoe.glb" "$pictures/viewer.jpg"
}

# Joins the lines of the commands of ocean.md and prints that which writes NAME.jpg.
command_of() {
    sed -n 's/^    //p' "$here/../docs/ocean.md" | sed -e ':a' -e '/\\$/N; s/\\\n *//; ta' | grep -e "-o $1.jpg"
}

sea() {
    line=$(command_of "$1")
    python3 "$here/pictures/boat.py" "$work/boat.glb"
    (cd "$work" && eval "\"$facet\" ${line#facet } -q --jpeg-quality 82")
    mv "$work/$1.jpg" "$pictures/"
}

[ $# -gt 0 ] || set -- front turntable viewer ocean ocean_winds ocean_boat ocean_lagoon ocean_below ocean_storm
for name in "$@"; do
    case $name in
    ocean*) sea "$name" ;;
    *) "$name" ;;
    esac
done
