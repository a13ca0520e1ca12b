#!/bin/sh
# codecs.sh node|page FACET DIST - the decoders that are fetched when a file needs them, beside the native command: in Node.js, or in
# headless Chromium (CHROMIUM names another one). Skipped without Node.js 18 or newer, the built package, or, for the page, npm ci in
# tests/clients and the browser. FACET_TEST_DATA: models and images.
set -eu
where=$1
facet=$(readlink -f "$2")
dist=$(readlink -f "$3")
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
for name in draco webp exr zstd; do
    [ -f "$dist/facet-viewer/codec_$name.wasm" ] || skip "./run web --build was not run, or had no source of the decoder $name"
done
if [ "$where" = page ]; then
    [ -d "$here/../clients/node_modules/playwright-core" ] || skip "npm ci was not run in tests/clients"
    [ -x "${CHROMIUM:-/usr/bin/chromium}" ] || skip "there is no ${CHROMIUM:-/usr/bin/chromium}"
fi
[ -d "$data/models" ] || echo "web: there are no models in $data: those of the test only"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
script=codecs.mjs
[ "$where" = node ] || script=codecs_page.mjs
node "$here/$script" "$facet" "$dist" "$work" "$data"
