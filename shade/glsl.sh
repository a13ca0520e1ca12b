#!/bin/sh
# glsl.sh VERSION [MAIN...] > shader: one complete shader: a line "#version VERSION" (VERSION "none": no such line),
# the GLSL dialect, the headers of shade/ in the order of shade.h, and the files MAIN. #include lines are for C
# only and dropped.
set -eu
here=$(dirname "$0")
[ $# -ge 1 ] || { echo "usage: glsl.sh VERSION [MAIN...]" >&2; exit 2; }
[ "$1" = none ] || echo "#version $1"
shift
cat "$here/lang/lang_glsl.glsl"
sed -n 's/^#include "\([a-z_]*\.h\)"$/\1/p' "$here/shade.h" | while read -r header; do
    grep -v '^#include' "$here/$header"
done
[ $# -eq 0 ] || grep -hv '^#include' "$@"
