#!/bin/sh
# gl.sh DIST - the renderer's own tests (tests/web/gl/gl_tests.def) as WebAssembly in headless Chromium (CHROMIUM names another one).
# Builds them beside DIST, by the build folder of web/build.sh. Skipped without Node.js 18 or newer, npm ci in tests/clients, the
# browser, or that build.
set -eu
dist=$1
. "$(dirname "$0")/lib.sh"
need_browser facet-viewer/viewer.wasm
build=$(CDPATH= cd -- "$dist/.." && pwd)
generated=$(sed -n 's/^FACET_GENERATED:[A-Z]*=//p' "$build/CMakeCache.txt")
[ -f "$generated/../tests/parity/parity.glsl" ] || skip "the native build has no tests/parity: EGL and GLES were missing"
log=$(mktemp)
trap 'rm -f "$log"' EXIT
cmake --build "$build" --target gl_tests >"$log" 2>&1 || {
    tail -n 30 "$log"
    echo "gl: the tests were not built"
    exit 1
}
node "$here/gl.mjs" "$build/tests" "$generated/../tests/parity/parity.glsl"
