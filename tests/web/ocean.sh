#!/bin/sh
# ocean.sh FACET DIST - the ocean page and the gallery that web/build.sh built, in headless Chromium (CHROMIUM names another one),
# beside facet ocean. Skipped without Node.js 18 or newer, npm ci in tests/clients, the browser, or the built pages.
set -eu
facet=$1
dist=$2
here=$(cd "$(dirname "$0")" && pwd)
skip() {
    echo "skipped: $1"
    [ -z "${CI_REQUIRES_ALL-}" ] || exit 1
    exit 77
}
command -v node >/dev/null || skip "there is no node"
[ "$(node -p 'process.versions.node.split(".")[0]')" -ge 18 ] || skip "Node.js is older than 18"
[ -d "$here/../clients/node_modules/playwright-core" ] || skip "npm ci was not run in tests/clients"
[ -x "${CHROMIUM:-/usr/bin/chromium}" ] || skip "there is no ${CHROMIUM:-/usr/bin/chromium}"
[ -f "$dist/facet-viewer/ocean.wasm" ] || skip "./run web --build was not run"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
node "$here/ocean.mjs" "$facet" "$dist" "$work"
