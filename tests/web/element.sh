#!/bin/sh
# element.sh FACET DIST - the element of DIST/facet-viewer in headless Chromium (CHROMIUM names another one), beside <model-viewer>, and
# its package. Skipped without Node.js 18 or newer, npm ci in tests/clients, the browser, or the built element. FACET_TEST_DATA: models.
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
# shellcheck disable=SC2086
node "$here/element.mjs" "$facet" "$dist" "$work" $models
