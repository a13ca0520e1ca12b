#!/bin/sh
# explorer.sh FACET DIST - the BRDF explorer of the built page in headless Chromium (CHROMIUM names another one) beside facet plot.
# Skipped without Node.js 18 or newer, npm ci in tests/clients, the browser, or the built page.
set -eu
facet=$(readlink -f "$1")
dist=$(readlink -f "$2")
here=$(cd "$(dirname "$0")" && pwd)
skip() {
    echo "skipped: $1"
    [ -z "${CI_REQUIRES_ALL-}" ] || exit 1
    exit 77
}
command -v node >/dev/null || skip "there is no node"
version=$(node -p 'process.versions.node.split(".")[0]')
[ "$version" -ge 18 ] || skip "Node.js $version is older than 18"
[ -d "$here/../clients/node_modules/axe-core" ] || skip "npm ci was not run in tests/clients"
[ -x "${CHROMIUM:-/usr/bin/chromium}" ] || skip "there is no ${CHROMIUM:-/usr/bin/chromium}"
[ -f "$dist/facet-viewer/facet-command.wasm" ] || skip "./run web --build was not run"
node "$here/explorer.mjs" "$facet" "$dist"
