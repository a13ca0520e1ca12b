#!/bin/sh
# shade.sh - bench/shade with each installed compiler, for the baseline instruction set and for AVX2.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
tmp=$(mktemp -d)
trap 'rm -rf "$tmp"' EXIT
flags="-std=c11 -O3 -fno-math-errno -fno-trapping-math -ffp-contract=off"
case $(uname -m) in x86_64) sets="baseline avx2" ;; *) sets=baseline ;; esac
for cc in gcc clang; do
    command -v $cc > /dev/null || { echo "skip: no $cc"; continue; }
    for set in $sets; do
        if [ "$set" = baseline ]; then march=; else march=-m$set; fi
        $cc $flags $march -I"$here/.." -I"$here/../src" "$here/shade.c" "$here/../src/base/clock.c" -o "$tmp/shade" -lm
        printf '%s: ' "$set"
        "$tmp/shade"
    done
done
