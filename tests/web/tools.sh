#!/bin/sh
# tools.sh FACET DIST - the command as WebAssembly in Node.js (DIST/facet-viewer/node.js) beside the native one.
# Skipped without Node.js 18 or newer, or the built package. FACET_TEST_DATA: models.
set -eu
facet=$(readlink -f "$1")
dist=$(readlink -f "$2")
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
[ -f "$dist/facet-viewer/facet-command.wasm" ] || skip "./run web --build was not run"
models=
for model in core/WaterBottle.glb materials/SunglassesKhronos.glb materials/CompareSheen.glb animation/Fox.glb lights/04_lights.glb; do
    [ ! -f "$data/models/$model" ] || models="$models $data/models/$model"
done
[ -n "$models" ] || echo "web: there are no models in $data: those of the test only"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
# shellcheck disable=SC2086
node "$here/tools.mjs" "$facet" "$dist" "$work" $models
