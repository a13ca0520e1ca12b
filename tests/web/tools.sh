#!/bin/sh
# tools.sh FACET DIST - the command as WebAssembly in Node.js (DIST/facet-viewer/node.js) beside the native one.
# Skipped without Node.js 18 or newer, or the built package. FACET_TEST_DATA: models.
set -eu
facet=$(readlink -f "$1")
dist=$(readlink -f "$2")
. "$(dirname "$0")/lib.sh"
need_node facet-viewer/facet-command.wasm
models=
for model in core/WaterBottle.glb materials/SunglassesKhronos.glb materials/CompareSheen.glb animation/Fox.glb lights/04_lights.glb; do
    [ ! -f "$data/models/$model" ] || models="$models $data/models/$model"
done
[ -n "$models" ] || echo "web: there are no models in $data: those of the test only"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
node "$here/tools.mjs" "$facet" "$dist" "$work" $models
