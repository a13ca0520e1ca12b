#!/bin/sh
# still.sh - from execve to the last byte of the PNG: wall time, CPU time and peak memory of whole processes, for
# facet and for the peers that are installed (f3d; three.js in headless Chromium), on the same inputs.
#     bench/still.sh [BUILD [RUNS]]        BUILD: a build folder with benchmarks (build/release); RUNS: 11
# The peers in Chromium need `npm ci` in bench/peers and in tests/clients once.
set -eu
here=$(CDPATH= cd -- "$(dirname -- "$0")/.." && pwd)
build=${1:-$here/build/release}
runs=${2:-11}
facet=$build/src/cli/facet
measure=$build/bench/measure
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
"$build/bench/make_models" "$work"

# line NAME COMMAND...: one row.
line() {
    name=$1
    shift
    printf '%-36s' "$name"
    "$measure" "$runs" "$@" 2>"$work/errors" || { tail -n 1 "$work/errors"; }
}

echo
echo "$("$facet" version), 512 x 512, 4 samples per pixel, $(nproc) cores"
line "built-in scene" "$facet" render -q -s 512 -o "$work/a.png"
for model in small textured heavy; do
    line "$model" "$facet" render -q -s 512 -o "$work/$model.png" "$work/$model.glb"
    line "$model, 1k HDR" "$facet" render -q -s 512 -o "$work/$model.png" -e "$work/light_1k.hdr" "$work/$model.glb"
done
if "$facet" render -q -s 16 --renderer gl -o "$work/gl.png" 2>"$work/errors"; then
    for model in small textured heavy; do
        line "--renderer gl, $model, 1k HDR" "$facet" render -q -s 512 --renderer gl -o "$work/$model.png" \
            -e "$work/light_1k.hdr" "$work/$model.glb"
    done
else
    tail -n 1 "$work/errors"
fi
echo "stages of textured, 1k HDR:"
"$facet" render -vv -s 512 -o "$work/textured.png" -e "$work/light_1k.hdr" "$work/textured.glb" 2>&1 | sed 's/^/    /'

runs=3
if command -v f3d >/dev/null 2>&1; then
    xvfb=
    [ -n "${DISPLAY-}" ] || xvfb="xvfb-run -a"
    for model in small textured heavy; do
        line "f3d, $model, 1k HDR" $xvfb f3d "$work/$model.glb" --output "$work/f3d.png" --resolution 512,512 \
            --hdri "$work/light_1k.hdr"
    done
else
    echo "f3d is not installed: skipped"
fi
if [ -d "$here/bench/peers/node_modules" ] && [ -x "${CHROMIUM:-/usr/bin/chromium}" ]; then
    for model in small textured heavy; do
        line "three.js in Chromium, $model, HDR" node "$here/bench/peers/threejs.mjs" "$work/$model.glb" \
            "$work/light_1k.hdr" "$work/three.png"
    done
else
    echo "Chromium or bench/peers/node_modules is missing: skipped"
fi
