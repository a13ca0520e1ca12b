#!/bin/sh
# clients.sh - output of facet bake, read by other programs. usage: clients.sh FACET ktx_parse|three|khronos|filament
#     ktx_parse   ktx-parse and our own strict reader, in Node.js only
#     three       three.js' KTX2Loader, PMREMGenerator and LightProbe  } in headless Chromium, where it is installed
#     khronos     Khronos' glTF Sample Renderer and its libktx         } (CHROMIUM names another one)
#     filament    Filament's web build                                 }
# Skipped without Node.js 18 or newer, npm ci in this folder, or the browser.
set -eu
facet=$1
client=$2
here=$(cd "$(dirname "$0")" && pwd)
command -v node >/dev/null || { echo "skipped: there is no node"; exit 77; }
version=$(node -p 'process.versions.node.split(".")[0]')
[ "$version" -ge 18 ] || { echo "skipped: Node.js $version is older than 18"; exit 77; }
[ -d "$here/node_modules/ktx-parse" ] || { echo "skipped: npm ci was not run in tests/clients"; exit 77; }
[ "$client" = ktx_parse ] || [ -x "${CHROMIUM:-/usr/bin/chromium}" ] || {
    echo "skipped: there is no ${CHROMIUM:-/usr/bin/chromium}"
    exit 77
}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
node "$here/$client.mjs" "$facet" "$work"
