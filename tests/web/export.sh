#!/bin/sh
# export.sh FACET DIST - pages of facet view --html and, with Rscript, of docs/examples/r/facet_page.R in headless Chromium: export.mjs.
set -eu
facet=$1
dist=$(CDPATH= cd -- "$2" 2>/dev/null && pwd || echo "$2")
here=$(cd "$(dirname "$0")" && pwd)
data=${FACET_TEST_DATA-$here/../../../shared/data}
skip() {
    echo "skipped: $1"
    [ -z "${CI_REQUIRES_ALL-}" ] || exit 1
    exit 77
}
command -v node >/dev/null || skip "there is no node"
[ -d "$here/../clients/node_modules/playwright-core" ] || skip "npm ci was not run in tests/clients"
[ -x "${CHROMIUM:-/usr/bin/chromium}" ] || skip "there is no ${CHROMIUM:-/usr/bin/chromium}"
[ -f "$dist/pages/single.html" ] || skip "./run web --build was not run"
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
# shellcheck disable=SC2086
node "$here/export.mjs" "$facet" "$dist" "$work" $models
