#!/bin/sh
# explorer.sh FACET DIST - the BRDF explorer of the built page in headless Chromium (CHROMIUM names another one) beside facet plot.
# Skipped without Node.js 18 or newer, npm ci in tests/clients, the browser, or the built page.
set -eu
facet=$(readlink -f "$1")
dist=$(readlink -f "$2")
. "$(dirname "$0")/lib.sh"
need_browser facet-viewer/facet-command.wasm axe-core
node "$here/explorer.mjs" "$facet" "$dist"
