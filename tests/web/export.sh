#!/bin/sh
# export.sh FACET DIST - pages of facet view --html and, with Rscript, of docs/examples/r/facet_page.R in headless Chromium: export.mjs.
set -eu
facet=$1
dist=$(CDPATH= cd -- "$2" 2>/dev/null && pwd || echo "$2")
. "$(dirname "$0")/lib.sh"
need_browser pages/single.html
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
trap 'exit 1' HUP INT TERM
models=
for model in core/WaterBottle.glb materials/SunglassesKhronos.glb extensions/Box_Draco.glb; do
    [ ! -f "$data/models/$model" ] || models="$models $data/models/$model"
done
if RGL_USE_NULL=TRUE Rscript -e 'library(rgl); library(jsonlite)' >/dev/null 2>&1; then
    FACET_WEB="$dist" Rscript "$here/../r/page.R" "$here/../../docs/examples/r" "$facet" "$work"
else
    echo "no pages of R: Rscript with rgl and jsonlite is not here"
fi
node "$here/export.mjs" "$facet" "$dist" "$work" $models
