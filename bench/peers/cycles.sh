#!/bin/sh
# cycles.sh - the path tracer beside Blender's Cycles on the same scenes: relative MSE, mean of (x - r)^2 / (r^2 + 0.01), and
# seconds of processors for the same number of samples, each against a reference r of its own with another seed, so that
# differences of the models do not count; how far the two references are apart; and what facet has of Cycles' error when
# both have had the same time, for an error that falls as 1 / time.
#     bench/peers/cycles.sh [BUILD [SCENE...]]      BUILD: a build folder with benchmarks; textured glass interior
# SIZE (256), SAMPLES ("16 64"), REFERENCE (1024), SEEDS ("0 1 2"); REFERENCES: a folder that keeps references from one run to
# the next. Seconds and errors are medians over the seeds: where a path that is met once in thousands lights one pixel up, a
# single image says little.
# Seconds of the clock say the same on a machine with nothing else to do; SECONDS_OF=clock prints those.
# Needs blender 3.4 and python3-numpy (Debian; both are for this alone).
set -eu
here=$(CDPATH= cd -- "$(dirname -- "$0")/../.." && pwd)
build=${1:-$here/build/release}
[ $# -gt 0 ] && shift
facet=$build/src/cli/facet
size=${SIZE:-256}
reference=${REFERENCE:-1024}
if ! command -v blender >/dev/null 2>&1; then
    echo "blender is not installed: skipped"
    exit 0
fi
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
references=${REFERENCES:-$work/references}
mkdir -p "$references"
"$build/bench/make_scenes" "$work" >"$work/log"
"$build/bench/make_models" "$work" >"$work/log"

# Each prints seconds: cycles and facet SCENE SAMPLES SEED OUT.
cycles() {
    case $1 in
    textured) options="--env $work/light_1k.hdr --eye 0,1,4.5 --fov 30" ;;
    glass) options="--env $work/studio.hdr" ;;
    *) options= ;;
    esac
    # shellcheck disable=SC2086
    blender -b --factory-startup -P "$here/bench/peers/cycles.py" -- "$work/$1.glb" "$4" --size "$size" --samples "$2" \
        --seed "$3" $options >"$work/blender" 2>&1
    if [ "${SECONDS_OF-}" = clock ]; then
        sed -n 's/^cycles: \([0-9.]*\) s.*/\1/p' "$work/blender"
    else
        sed -n 's/^cycles: .*CPU \([0-9.]*\) s.*/\1/p' "$work/blender"
    fi
}
facet() {
    case $1 in
    textured) options="--env $work/light_1k.hdr --eye 0,1,4.5 --target 0,0,0 --fov 30" ;;
    glass) options="--env $work/studio.hdr --camera 0" ;;
    *) options="--env none --camera 0" ;;
    esac
    # shellcheck disable=SC2086
    "$build/bench/measure" 1 "$facet" render -q --renderer path "$work/$1.glb" -s "$size" --samples "$2" --seed "$3" \
        --bounces 12 --filter box --background env --format exr32 -o "$4" $options >"$work/times"
    if [ "${SECONDS_OF-}" = clock ]; then awk '{ print $2 }' "$work/times"; else awk '{ print $5 }' "$work/times"; fi
}
error() {
    "$facet" compare "$1" "$2" --space linear --alpha ignore --metric mse-relative | awk '{ print $2 }'
}
# The middle one of the numbers in a file, one to a line.
median() {
    sort -g "$1" | awk '{ v[NR] = $1 } END { print v[int((NR + 1) / 2)] }'
}

echo "$("$facet" version), $(blender --version | head -n 1), $size x $size, references of $reference samples"
printf '%-10s %7s | %9s %12s | %9s %12s | %s\n' scene samples "Cycles s" error "facet s" error "at equal time"
[ $# -gt 0 ] || set -- textured glass interior
for scene; do
    for renderer in cycles facet; do
        r=$references/${renderer}_$scene-$size-$reference.exr
        [ -f "$r" ] || $renderer "$scene" "$reference" 99 "$r" >"$work/log"
    done
    for n in ${SAMPLES:-16 64}; do
        for renderer in cycles facet; do
            rm -f "$work/$renderer.s" "$work/$renderer.e"
            for seed in ${SEEDS:-0 1 2}; do
                $renderer "$scene" "$n" "$seed" "$work/$renderer.exr" >>"$work/$renderer.s"
                error "$references/${renderer}_$scene-$size-$reference.exr" "$work/$renderer.exr" >>"$work/$renderer.e"
            done
        done
        for part in cycles.s cycles.e facet.s facet.e; do
            median "$work/$part"
        done |
            awk -v scene="$scene" -v n="$n" -v r="$reference" '
                { v[NR] = $1 }
                END {
                    c = 1 + n / r # the noise of the references
                    printf "%-10s %7d | %9.2f %12.6f | %9.2f %12.6f | %.2f\n", scene, n, v[1], v[2] / c, v[3], v[4] / c,
                        v[4] * v[3] / (v[2] * v[1])
                }'
    done
    printf '%-10s %s\n' "$scene" "the references are $(error "$references/cycles_$scene-$size-$reference.exr" \
        "$references/facet_$scene-$size-$reference.exr") apart"
done
