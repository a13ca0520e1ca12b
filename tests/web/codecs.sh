#!/bin/sh
# codecs.sh FACET DIST - the decoders that are fetched when a file needs them, in Node.js beside the native command.
# Skipped without Node.js 18 or newer, or the built package. FACET_TEST_DATA: models and images.
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
for name in draco webp exr; do
    [ -f "$dist/facet-viewer/codec_$name.wasm" ] || skip "./run web --build was not run, or had no source of the decoder $name"
done
[ -d "$data/models" ] || echo "web: there are no models in $data: those of the test only"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
node "$here/codecs.mjs" "$facet" "$dist" "$work" "$data"
