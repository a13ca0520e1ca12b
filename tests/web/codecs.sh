#!/bin/sh
# codecs.sh node|page FACET DIST - the decoders that are fetched when a file needs them, beside the native command: in Node.js, or in
# headless Chromium (CHROMIUM names another one). Skipped without Node.js 18 or newer, the built package, or, for the page, npm ci in
# tests/clients and the browser. FACET_TEST_DATA: models and images.
set -eu
where=$1
facet=$(readlink -f "$2")
dist=$(readlink -f "$3")
. "$(dirname "$0")/lib.sh"
need_node facet-viewer/viewer.wasm
for name in draco webp exr zstd; do
    [ -f "$dist/facet-viewer/codec_$name.wasm" ] || skip "./run web --build was not run, or had no source of the decoder $name"
done
[ "$where" = node ] || need_browser facet-viewer/viewer.wasm
[ -d "$data/models" ] || echo "web: there are no models in $data: those of the test only"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
script=codecs.mjs
[ "$where" = node ] || script=codecs_page.mjs
node "$here/$script" "$facet" "$dist" "$work" "$data"
