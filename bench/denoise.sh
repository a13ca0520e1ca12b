#!/bin/sh
# denoise.sh - error of images of few samples before and after --denoise: RMSE, relative MSE (mean of
# (x - r)^2 / (r^2 + 0.01)) and FLIP of the tone-mapped images.
#     bench/denoise.sh [BUILD [SCENE...]]      BUILD: a build folder with benchmarks (build/release)
# SIZE (256), SAMPLES (16), REFERENCE (1024): pixels, samples. The noise of the reference r, of another seed, is subtracted
# from the squared errors. REFERENCES: a folder that keeps references between runs. FACET_TEST_DATA: the folder of models and
# environments of some scenes, which are skipped without it.
set -eu
here=$(CDPATH= cd -- "$(dirname -- "$0")/.." && pwd)
build=${1:-$here/build/release}
[ $# -gt 0 ] && shift
facet=$build/src/cli/facet
size=${SIZE:-256}
samples=${SAMPLES:-16}
reference=${REFERENCE:-1024}
data=${FACET_TEST_DATA:-}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
references=${REFERENCES:-$work/references}
mkdir -p "$references"
"$build/bench/make_scenes" "$work" >"$work/log"

# draw SCENE SAMPLES SEED OUT OPTION...
draw() {
    name=$1 count=$2 seed=$3 out=$4
    shift 4
    case $name in
    interior | lights | volume) set -- "$@" "$work/$name.glb" --camera 0 --env none --background env ;;
    sky) set -- "$@" "$work/sky.glb" --camera 0 --env "$work/sky.hdr" --sun 40,35,8 --background env ;;
    glass) set -- "$@" "$work/glass.glb" --camera 0 --env "$work/studio.hdr" --background env ;;
    bottle) set -- "$@" "$data/models/core/WaterBottle.glb" --env "$data/env/royal_esplanade_1k.hdr" --background env ;;
    cornell) set -- "$@" "$data/models/scenes/CornellBox.glb" --env none --background env ;;
    toycar) set -- "$@" "$data/models/materials/ToyCar.glb" --env "$data/env/leadenhall_market_1k.hdr" ;;
    chair) set -- "$@" "$data/models/materials/SheenChair.glb" --env "$work/sky.hdr" --sun 30,45 --ground shadow ;;
    esac
    "$facet" render -q --renderer path -s "$size" --samples "$count" --seed "$seed" --format exr32 -o "$out" "$@"
}

# compare A B: RMSE, relative MSE, FLIP
compare() {
    "$facet" compare "$1" "$2" --space linear --metric rmse,mse-relative | awk '{ printf "%s ", $NF }'
    "$facet" compare "$1" "$2" --space display --tone-mapping neutral --metric flip | awk '{ printf "%s ", $NF }'
}

[ $# -gt 0 ] || set -- interior sky glass lights volume ${data:+bottle cornell toycar chair}
echo "$("$facet" version), $size x $size, $samples samples, reference of $reference"
printf '%-9s %9s %9s %6s %10s %10s %6s %7s %7s %6s\n' scene RMSE after left relMSE after left FLIP after left
for scene; do
    r=$references/$scene-$size-$reference.exr
    [ -f "$r" ] || draw "$scene" "$reference" 1000 "$r"
    draw "$scene" "$samples" 1 "$work/noisy.exr"
    draw "$scene" "$samples" 1 "$work/calm.exr" --denoise
    echo "$(compare "$r" "$work/noisy.exr") $(compare "$r" "$work/calm.exr")" |
        awk -v scene="$scene" -v n="$samples" -v r="$reference" '
            function after(noisy, calm) { return calm > noisy * n / r ? calm - noisy * n / r : 0 }
            {
                before = $1 * $1 / (1 + n / r); left = after(before, $4 * $4)
                relative = $2 / (1 + n / r); left_relative = after(relative, $5)
                printf "%-9s %9.4f %9.4f %6.2f %10.6f %10.6f %6.2f %7.4f %7.4f %6.2f\n", scene,
                       sqrt(before), sqrt(left), sqrt(left / before),
                       relative, left_relative, left_relative / relative, $3, $6, $6 / $3
            }'
done
