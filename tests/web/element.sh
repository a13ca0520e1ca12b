#!/bin/sh
# element.sh FACET DIST - the element of DIST/facet-viewer in headless Chromium (CHROMIUM names another one), beside <model-viewer>, and
# its package. Skipped without Node.js 18 or newer, npm ci in tests/clients, the browser, or the built element. FACET_TEST_DATA: models.
set -eu
facet=$1
dist=$2
. "$(dirname "$0")/lib.sh"
need_browser facet-viewer/viewer.wasm
[ -d "$here/node_modules/@google" ] || echo "element: npm ci was not run in tests/web: without model-viewer and the compiler of types"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
if command -v npm >/dev/null; then
    archive=$(sh "$here/../../web/pack.sh" "$dist")
    compiler=$here/node_modules/typescript/lib/tsc.js
    [ -f "$compiler" ] || compiler=
    # shellcheck disable=SC2086
    node "$here/pack.mjs" "$archive" "$work" $compiler
else
    echo "element: there is no npm: not packed"
fi
models=
for model in core/WaterBottle.glb animation/Fox.glb; do
    [ ! -f "$data/models/$model" ] || models="$models $data/models/$model"
done
node "$here/element.mjs" "$facet" "$dist" "$work" $models
