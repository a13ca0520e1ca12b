#!/bin/sh
# legacy_peers.sh - facet convert beside obj2gltf (npm, bench/peers) and assimp (Debian's assimp-utils), on the OBJ files of
# the test data: error of the materials by the same metric, and time. Medians of several runs, commands alternating.
#     bench/legacy_peers.sh BUILD [RUNS]      BUILD: a build with benchmarks
# With FACET_BIG_OBJ=FILE also the time for a large file.
set -eu
build=$1
runs=${2:-5}
here=$(CDPATH= cd -- "$(dirname -- "$0")" && pwd)
data=${FACET_TEST_DATA:-$here/../../shared/data}/obj
obj2gltf=$here/peers/node_modules/.bin/obj2gltf
[ -d "$data" ] || { echo "legacy_peers: there is no folder $data" >&2; exit 1; }
[ -x "$obj2gltf" ] || echo "legacy_peers: (cd bench/peers && npm ci) gets obj2gltf; left out" >&2
command -v assimp >/dev/null || echo "legacy_peers: assimp-utils is not installed; left out" >&2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# seconds COMMAND...: the median of its wall times
seconds() {
    i=0
    while [ $i -lt "$runs" ]; do
        begin=$(date +%s%N)
        "$@" >/dev/null 2>&1 || { echo failed; return; }
        end=$(date +%s%N)
        echo $((end - begin))
        i=$((i + 1))
    done | sort -n | awk '{ t[NR] = $1 } END { if (NR) printf "%.3f", t[int((NR + 1) / 2)] / 1e9 }'
}

convert_all() { # convert_all OBJ: each converter's file, and its time
    set -- "$1" facet "$build/src/cli/facet convert --mtl-colors linear -q $1 $work/facet.glb"
    printf '%s' "$2 $(seconds $3) s"
    printf '%s' "; facet, fit $(seconds "$build/src/cli/facet" convert --mtl-colors linear --method fit -q "$1" "$work/fit.glb") s"
    printf '%s' "; facet, core $(seconds "$build/src/cli/facet" convert --mtl-colors linear --profile core -q "$1" "$work/core.glb") s"
    [ ! -x "$obj2gltf" ] || printf '%s' "; obj2gltf $(seconds "$obj2gltf" -i "$1" -o "$work/obj2gltf.glb") s"
    ! command -v assimp >/dev/null || printf '%s' "; assimp $(seconds assimp export "$1" "$work/assimp.glb") s"
    echo
}

for obj in "$data"/c-ray/teapot.obj "$data"/cornell/CornellBox-Glossy.obj "$data"/cornell/CornellBox-Sphere.obj \
    "$data"/obj2gltf/box-multiple-materials/box-multiple-materials.obj "$data"/obj2gltf/box-groups/box-groups.obj \
    "$data"/tinyobjloader/map-bump.obj ${FACET_BIG_OBJ:-}; do
    rm -f "$work"/*.glb
    times=$(convert_all "$obj")
    set --
    for name in facet fit core obj2gltf assimp; do
        [ ! -f "$work/$name.glb" ] || set -- "$@" "$name=$work/$name.glb"
    done
    "$build/bench/legacy_peers" "$obj" "$@" | sed "1s|.*/||"
    echo "  $times"
done
