#!/bin/sh
# views.sh FACET DIST - views of the viewer's page with many settings at once, in headless Chromium. Skipped as page.sh.
set -eu
facet=$1
dist=$2
. "$(dirname "$0")/lib.sh"
need_browser facet-viewer/facet-command.wasm
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
node "$here/views.mjs" "$facet" "$dist" "$work"
