#!/bin/sh
# run_r_example.sh FACET - the example of docs/r.md, verbatim: an rgl scene to facet, to glTF, back to R; and the vignette's
# curves. If rgl can render without a screen, its image is compared with facet's.
# Needs Rscript with rgl and jsonlite; skips (77) without.
set -eu
facet=$(cd "$(dirname "$1")" && pwd)/$(basename "$1")
examples=$(cd "$(dirname "$0")/../../docs/examples/r" && pwd)
tests=$(cd "$(dirname "$0")" && pwd)

if ! RGL_USE_NULL=TRUE Rscript -e 'library(rgl); library(jsonlite)' > /dev/null 2>&1; then
    echo "skipped: Rscript with rgl and jsonlite is not here"
    exit 77
fi
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
trap 'exit 1' HUP INT TERM
cd "$folder"

RGL_USE_NULL=TRUE Rscript "$examples/scene.R" .
"$facet" convert scene.obj scene.glb --parameters scene.json --keep-sources --report report.html
"$facet" convert scene.glb back.json --to ogl1
"$facet" render scene.obj --parameters scene.json --shading ogl1 -s 128 -o as-rgl.png
"$facet" render scene.glb -s 128 -o scene.png
"$facet" render scene.json --shading ogl1 -s 128 -o balls.png
RGL_USE_NULL=TRUE Rscript "$tests/check.R" "$examples" "$facet"

if "$facet" plot legacy --heaviside ramp -o vignette.csv; then
    Rscript "$examples/vignette.R" vignette.csv
fi

if ! command -v xvfb-run > /dev/null; then
    echo "not compared with rgl's own pictures: xvfb-run is needed"
    exit 0
fi
mkdir drawn
if ! xvfb-run -a -s "-screen 0 1024x768x24" sh -c "Rscript '$examples/snapshot.R' drawn &&
    Rscript '$tests/appearances.R' '$examples' drawn" > drawn.log 2>&1 || ! [ -s drawn/translucent/rgl.png ]; then
    echo "not compared with rgl's own pictures: rgl cannot draw here:"
    cat drawn.log
    exit 0
fi

# differ FOLDER SIZE MOST: renders rgl's scene; at most MOST pixels may differ by more than one of 255 levels.
is_good=true
differ() {
    # shellcheck disable=SC2046
    "$facet" render "$1/scene.obj" --parameters "$1/scene.json" --shading ogl1 --ogl1-variant rgl-desktop \
        $(cat "$1/camera.txt") -s "$2" --samples 1 --background '#E5E5E5' -q -o "$1/facet.png"
    count=$("$facet" compare "$1/rgl.png" "$1/facet.png" --alpha ignore --threshold 0.005 --metric differing |
        tr -dc '0-9')
    echo "$1: $count pixels differ from rgl's by more than a level, at most $3 are allowed"
    [ "$count" -le "$3" ] || is_good=false
}
# 0 were measured for these scenes. Drivers may differ where an edge passes exactly through the center of a pixel.
for name in plain two_lights world_light point_light point_light_of_view fog_linear fog_exp fog_exp2 unlit flat texture; do
    differ drawn/$name 256 20
done
# Silhouettes, where rgl sorts whole triangles: 93 measured.
differ drawn/translucent 256 250
# The small balls, which rgl draws with triangles of its own, and the surface, whose squares it cuts along the other
# diagonal.
differ drawn 512 16000
$is_good
