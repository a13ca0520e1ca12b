#!/bin/sh
# page.sh FACET DIST - the viewer's page of DIST in headless Chromium (CHROMIUM names another one). Skipped without Node.js 18 or newer,
# npm ci in tests/clients, the browser, or the built page.
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
version=$(node -p 'process.versions.node.split(".")[0]')
[ "$version" -ge 18 ] || skip "Node.js $version is older than 18"
[ -d "$here/../clients/node_modules/axe-core" ] || skip "npm ci was not run in tests/clients"
[ -x "${CHROMIUM:-/usr/bin/chromium}" ] || skip "there is no ${CHROMIUM:-/usr/bin/chromium}"
[ -f "$dist/facet-viewer/viewer.wasm" ] || skip "./run web --build was not run"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
# shellcheck disable=SC2086
node "$here/page.mjs" "$facet" "$dist" "$work"
