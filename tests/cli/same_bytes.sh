#!/bin/sh
# same_bytes.sh - the bytes of a picture do not depend on the number of threads, nor on the run.
set -eu
. "$(dirname "$0")/lib.sh"

for options in "--size 160x120" "--size 97x61 --format exr --aov depth,normal --env-rotation 30" \
    "--size 64 --quality final --background env --format webp"; do
    for threads in 1 2 3 7; do
        expect 0 render $options -j $threads -o picture.$threads --format png $options
    done
    expect 0 render $options -o picture.default --format png $options
    for other in 2 3 7 default; do
        cmp -s picture.1 picture.$other || failed "-j $other differs from -j 1: $options"
    done
done
finish
