#!/bin/sh
# convergence.sh - error against time of the path tracer, for five scenes of bench/make_scenes: seconds of the whole process,
# wall and CPU, RMSE and relative MSE, mean of (x - r)^2 / (r^2 + 0.01), for 4 to 1024 samples per pixel.
#     bench/convergence.sh [BUILD [SCENE...]]      BUILD: a build folder with benchmarks (build/release)
# SIZE (256), MAX_SAMPLES (1024), REFERENCE (4096): pixels, samples. The reference r is facet's own, of another seed; its own noise is
# subtracted from the errors: N / REFERENCE of them for N samples. REFERENCES: a folder that keeps references between runs.
set -eu
here=$(CDPATH= cd -- "$(dirname -- "$0")/.." && pwd)
build=${1:-$here/build/release}
[ $# -gt 0 ] && shift
facet=$build/src/cli/facet
size=${SIZE:-256}
max_samples=${MAX_SAMPLES:-1024}
reference=${REFERENCE:-4096}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
references=${REFERENCES:-$work/references}
mkdir -p "$references"
"$build/bench/make_scenes" "$work" >"$work/log"

# draw SCENE SAMPLES SEED OUT: renders and prints the line of bench/measure.
draw() {
    case $1 in
    interior | lights | volume) light="--env none" ;;
    sky) light="--env $work/sky.hdr --sun 40,35,8" ;;
    *) light="--env $work/studio.hdr" ;;
    esac
    # shellcheck disable=SC2086
    "$build/bench/measure" 1 "$facet" render -q --renderer path "$work/$1.glb" --camera 0 -s "$size" $light --background env --bounces 12 \
        --filter box --samples "$2" --seed "$3" --format exr32 -o "$4"
}

echo "$("$facet" version), $size x $size, $(nproc) cores, reference of $reference samples"
printf '%-10s %7s %9s %9s %10s %13s\n' scene samples seconds CPU RMSE "relative MSE"
[ $# -gt 0 ] || set -- interior sky glass lights volume
for scene; do
    r=$references/$scene-$size-$reference.exr
    [ -f "$r" ] || draw "$scene" "$reference" 1000 "$r" >"$work/log"
    n=4
    while [ "$n" -le "$max_samples" ]; do
        draw "$scene" "$n" 0 "$work/a.exr" >"$work/errors"
        "$facet" compare "$r" "$work/a.exr" --space linear --alpha ignore --metric rmse,mse-relative \
            >>"$work/errors"
        awk -v scene="$scene" -v n="$n" -v r="$reference" '
            /^wall/ { wall = $2; cpu = $5 }
            { error[$1] = $2 }
            END {
                c = 1 + n / r
                printf "%-10s %7d %9.2f %9.2f %10.4f %13.6f\n", scene, n, wall, cpu, error["rmse"] / sqrt(c),
                    error["mse-relative"] / c
            }
        ' "$work/errors"
        n=$((n * 4))
    done
done
