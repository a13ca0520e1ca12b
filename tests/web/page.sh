#!/bin/sh
# page.sh FACET DIST - the viewer's page of DIST in headless Chromium (CHROMIUM names another one). Skipped without Node.js 18 or newer,
# npm ci in tests/clients, the browser, or the built page.
set -eu
facet=$1
dist=$2
. "$(dirname "$0")/lib.sh"
need_browser facet-viewer/viewer.wasm axe-core
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
node "$here/page.mjs" "$facet" "$dist" "$work"
