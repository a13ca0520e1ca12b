#!/bin/sh
# pictures.sh - makes the pictures of README.md and web.md.
#     bench/pictures.sh FACET DATA [NAME...]     FACET: the command; DATA: a folder with models/core/WaterBottle.glb, ..;
#                                                NAME: front, turntable, viewer, or all of them
# Writes docs/pictures/NAME. The turntable needs img2webp (Debian: webp), the picture of the viewer a built page (./run web
# --build), Chromium and npm ci in tests/clients. The other pictures have their commands in the pages that show them.
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

[ $# -gt 0 ] || set -- front turntable viewer
for name in "$@"; do
    "$name"
done
