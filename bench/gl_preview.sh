#!/bin/sh
# gl_preview.sh - the difference of OpenGL's images from the preview's, model by model: mean of 8-bit codes as rendered by
# default, and with one sample per pixel, where both shade the same points: without antialiasing. The table of docs/gl.md.
#     bench/gl_preview.sh FACET FOLDER      every .glb and .gltf below FOLDER, worst first
set -eu
facet=$1
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
difference() # MODEL OPTIONS...
{
    model=$1
    shift
    for renderer in preview gl; do
        "$facet" render "$model" -o "$work/$renderer.png" --size 256x256 --renderer $renderer -q "$@" || return 0
    done
    "$facet" compare "$work/preview.png" "$work/gl.png" --json |
        sed -n 's/.*"mae": \([^,]*\),.*/\1/p' | awk '{ printf "%.2f", 255 * $1 }'
}
find "$2" -name '*.glb' -o -name '*.gltf' | sort | while IFS= read -r model; do
    mean=$(difference "$model")
    [ -n "$mean" ] || continue # not a model that can be drawn
    same=-
    awk "BEGIN { exit !($mean < 1) }" || same=$(difference "$model" --samples 1)
    printf '| %s | %s | %s |\n' "$(basename "$model")" "$mean" "$same"
done | sort -t '|' -k 3 -rn
