#!/bin/sh
# web.sh FACET DIST - the viewer's module that web/build.sh built, in headless Chromium (CHROMIUM names another one), beside
# facet render. Skipped, or failed where CI_REQUIRES_ALL is set, without Node.js 18 or newer, npm ci in tests/clients, the
# browser, or the built module. FACET_TEST_DATA: models.
set -eu
facet=$1
dist=$2
. "$(dirname "$0")/lib.sh"
need_browser facet-viewer/viewer.wasm
models=
for model in core/WaterBottle.glb materials/SunglassesKhronos.glb materials/AttenuationTest.glb materials/CompareDispersion.glb \
    materials/CompareSheen.glb materials/AnisotropyStrengthTest.glb materials/UnlitTest.glb animation/Fox.glb \
    lights/04_lights.glb gltf/Suzanne/Suzanne.gltf; do
    [ ! -f "$data/models/$model" ] || models="$models $data/models/$model"
done
[ -n "$models" ] || echo "web: there are no models in $data: the built-in scene and a glass only"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
node "$here/web.mjs" "$facet" "$dist" "$work" $models
