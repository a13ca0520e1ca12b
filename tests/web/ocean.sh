#!/bin/sh
# ocean.sh FACET DIST - the ocean page and the gallery that web/build.sh built, in headless Chromium (CHROMIUM names another one),
# beside facet ocean. Skipped without Node.js 18 or newer, npm ci in tests/clients, the browser, or the built pages.
set -eu
facet=$1
dist=$2
. "$(dirname "$0")/lib.sh"
need_browser facet-viewer/ocean.wasm
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
node "$here/ocean.mjs" "$facet" "$dist" "$work"
