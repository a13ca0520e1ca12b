#!/bin/sh
# validator.sh - files written by facet convert have no errors in Khronos' glTF validator: the models of the shared data, OBJ
# files included, as .glb and some as .gltf. Skipped without Node.js, the validator or the data.
set -eu
facet=$1
here=$(cd "$(dirname "$0")" && pwd)
data=${FACET_TEST_DATA:-}
command -v node >/dev/null || { echo "skipped: there is no node"; exit 77; }
[ -d "$here/node_modules/gltf-validator" ] || { echo "skipped: npm ci was not run in tests/validator"; exit 77; }
[ -n "$data" ] && [ -d "$data/models" ] || { echo "skipped: FACET_TEST_DATA names no folder with models"; exit 77; }
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
find "$data/models" \( -name '*.glb' -o -name '*.gltf' \) -not -path '*/gltf1/*' >"$work/list"
[ ! -d "$data/obj" ] || find "$data/obj" -name '*.obj' >>"$work/list"
sort -o "$work/list" "$work/list"
number=0
status=0
while read -r model; do
    number=$((number + 1))
    name=$(basename "$model")
    out="$work/$number-${name%.*}.glb"
    if ! "$facet" convert -q "$model" "$out" 2>"$work/err"; then
        echo "$model: $(cat "$work/err")"
        status=1
    fi
    case $name in # again with all statements of MTL
    *.obj) "$facet" convert -q "$model" "${out%.glb}-glass.glb" --glass --mirrors --ambient occlusion --profile core ||
        status=1 ;;
    esac
    [ $((number % 8)) != 0 ] || "$facet" convert -q "$model" "${out%.glb}.gltf" || status=1
done <"$work/list"
[ $number -gt 50 ] || { echo "only $number models were found"; status=1; }
node "$here/validate.mjs" "$work"/*.glb "$work"/*.gltf || status=1
exit $status
