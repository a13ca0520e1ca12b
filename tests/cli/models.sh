#!/bin/sh
# models.sh - every model of the test data (quick: every third): an image, or exit 5 with the extension's name; broken ones
# are refused.
set -eu
. "$(dirname "$0")/lib.sh"
needs_data

every=1
is_quick && every=3
find "$data/models" -name '*.glb' -o -name '*.gltf' | sort | awk "NR % $every == 0" >list
while read -r model; do
    code=0
    "$facet" render --size 64 --quality draft --time-limit 60s "$model" -o x.png 2>err || code=$?
    case $code in
    0) [ -s x.png ] || failed "$model: no image" ;;
    5) [ ! -e x.png ] || failed "$model: an image in spite of exit 5" ;;
    *) failed "$model: exit code $code" ;;
    esac
    rm -f x.png
    code=0
    "$facet" inspect "$model" >out 2>err || code=$?
    case $code in 0 | 5) ;; *) failed "inspect $model: exit code $code" ;; esac
done <list

find "$data/malformed" -name '*.glb' -o -name '*.gltf' | sort >list
while read -r model; do
    code=0
    "$facet" render --size 16 --quality draft --time-limit 20s --max-memory 512M "$model" -o x.png >out 2>err || code=$?
    case $code in
    0) [ -s x.png ] || failed "$model: no image" ;;
    2 | 3 | 4 | 5 | 7)
        [ ! -e x.png ] || failed "$model: exit code $code and yet an image"
        [ "$(tail -1 err | wc -c)" -gt 10 ] || failed "$model: exit code $code without a sentence"
        ;;
    *) failed "$model: exit code $code" ;;
    esac
    rm -f x.png
done <list
finish
