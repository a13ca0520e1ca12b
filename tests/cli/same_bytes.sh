#!/bin/sh
# same_bytes.sh - the bytes of an image do not depend on the number of threads, on the run, nor on the vector width of the
# processor.
set -eu
. "$(dirname "$0")/lib.sh"

for options in "--size 160x120" "--size 97x61 --format exr --aov all --env-rotation 30" \
    "--size 64 --quality final --background env --format webp"; do
    for threads in 1 2 3 7; do
        expect 0 render $options -j $threads -o image.$threads --format png $options
    done
    expect 0 render $options -o image.default --format png $options
    for other in 2 3 7 default; do
        cmp -s image.1 image.$other || failed "-j $other differs from -j 1: $options"
    done
done

# Instruction sets without fused multiply-adds, which --isa portable chooses from. The built-in scene has pixels that
# AVX2 and AVX-512 change.
for options in "--size 160x120" "--size 97x61 --renderer path --samples 8"; do
    expect 0 render $options -o image.portable --format png
    for isa in sse2 sse4.2 avx; do
        "$facet" render $options -o image.$isa --format png --isa $isa 2>err || {
            says "instruction set" # this processor lacks it
            continue
        }
        cmp -s image.portable image.$isa || failed "--isa $isa differs from portable: $options"
    done
done
expect 0 render --size 48 -o image.native --format png --isa native
expect 2 render --size 48 -o image.none --isa mmx
finish
