#!/bin/sh
# web.sh FACET DIST - the viewer's module that web/build.sh built, in headless Chromium (CHROMIUM names another one), beside
# facet render. Skipped, or failed where CI_REQUIRES_ALL is set, without Node.js 18 or newer, npm ci in tests/clients, the
# browser, or the built module. FACET_TEST_DATA: models.
set -eu
facet=$1
dist=$2
here=$(cd "$(dirname "$0")" && pwd)
data=${FACET_TEST_DATA-$here/../../../shared/data}
skip() {
    echo "skipped: $1"
    [ -z "${CI_REQUIRES_ALL-}" ] || exit 1
    exit 77
}
command -v node >/dev/null || skip "there is no node"
version=$(node -p 'process.versions.node.split(".")[0]')
[ "$version" -ge 18 ] || skip "Node.js $version is older than 18"
[ -d "$here/../clients/node_modules/playwright-core" ] || skip "npm ci was not run in tests/clients"
[ -x "${CHROMIUM:-/usr/bin/chromium}" ] || skip "there is no ${CHROMIUM:-/usr/bin/chromium}"
[ -f "$dist/facet-viewer/viewer.wasm" ] || skip "./run web --build was not run"
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
