#!/bin/sh
# web.sh FACET DIST - the page that web/build.sh built, in headless Chromium (CHROMIUM names another one), beside facet render.
# Skipped without Node.js 18 or newer, npm ci in tests/clients, the browser, or the built page. FACET_TEST_DATA: models.
set -eu
facet=$1
dist=$2
here=$(cd "$(dirname "$0")" && pwd)
data=${FACET_TEST_DATA-$here/../../../shared/data}
command -v node >/dev/null || { echo "skipped: there is no node"; exit 77; }
version=$(node -p 'process.versions.node.split(".")[0]')
[ "$version" -ge 18 ] || { echo "skipped: Node.js $version is older than 18"; exit 77; }
[ -d "$here/../clients/node_modules/playwright-core" ] || { echo "skipped: npm ci was not run in tests/clients"; exit 77; }
[ -x "${CHROMIUM:-/usr/bin/chromium}" ] || { echo "skipped: there is no ${CHROMIUM:-/usr/bin/chromium}"; exit 77; }
[ -f "$dist/facet-viewer/viewer.wasm" ] || { echo "skipped: ./run web --build was not run"; exit 77; }
models=
for model in core/WaterBottle.glb materials/SunglassesKhronos.glb materials/AttenuationTest.glb materials/CompareDispersion.glb \
    materials/CompareSheen.glb materials/AnisotropyStrengthTest.glb materials/UnlitTest.glb animation/Fox.glb \
    lights/04_lights.glb gltf/Suzanne/Suzanne.gltf; do
    [ ! -f "$data/models/$model" ] || models="$models $data/models/$model"
done
[ -n "$models" ] || echo "web: there are no models in $data: the built-in scene and a glass only"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
# shellcheck disable=SC2086
node "$here/web.mjs" "$facet" "$dist" "$work" $models
