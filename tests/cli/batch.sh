#!/bin/sh
# batch.sh - facet batch: items of folders and manifests, results, limits, retries, resuming, interruptions.
set -eu
. "$(dirname "$0")/lib.sh"
tiny="--size 16 --quality draft"
mkdir -p models/sub
write_triangle models/a.gltf
cp models/a.gltf models/b.gltf
cp models/a.gltf models/sub/c.gltf
echo '{"asset":{"version":"1.0"}}' >models/old.gltf

# count FILE TEXT: the number of lines with it.
count() {
    grep -cF -- "$2" "$1" || true
}

# A folder: the invalid model is reported, the others are rendered, as facet render does it.
expect 1 batch models -o 'img/{dir}/{stem}.png' --results r.jsonl -j 2 -- $tiny
says "models/old.gltf: asset.version"
says "batch: 3 done, 0 kept, 1 failed"
[ "$(find img -type f | LC_ALL=C sort | tr '\n' ' ')" = "img/a.png img/b.png img/sub/c.png " ] || failed "the outputs are $(find img)"
"$facet" render models/a.gltf -o a.png $tiny
cmp a.png img/a.png || failed "batch and render differ"
[ "$(count r.jsonl '"status":"done"')" = 3 ] && [ "$(count r.jsonl '"status":"failed"')" = 1 ] || failed "results: $(cat r.jsonl)"
expect 1 batch models -o 'img/{dir}/{stem}.png' --results r.jsonl --resume -q --json -- $tiny
grep -qF '"done": 0, "kept": 3, "failed": 1' out || failed "resumed: $(cat out)"
finish
