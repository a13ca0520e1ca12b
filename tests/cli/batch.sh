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
# hash_of OUTPUT: of the settings, by the results.
hash_of() {
    grep -F "\"output\":\"$1\"" r.jsonl | tail -n 1 | sed 's/.*"hash":"\([^"]*\)".*/\1/'
}
"$facet" render models/a.gltf -o a.png $tiny --tag "$(hash_of img/a.png)"
cmp a.png img/a.png || failed "batch and render differ"
[ "$(count r.jsonl '"status":"done"')" = 3 ] && [ "$(count r.jsonl '"status":"failed"')" = 1 ] || failed "results: $(cat r.jsonl)"
expect 1 batch models -o 'img/{dir}/{stem}.png' --results r.jsonl --resume -q --json -- $tiny
grep -qF '"done": 0, "kept": 3, "failed": 1' out || failed "resumed: $(cat out)"

# Images have their tag: other settings are rendered again, the same are kept also without results; what killed processes
# have left is removed.
touch img/a.png.0123abcd img/a.png.1 img/other.0123abcd img/a.0123abcd
expect 0 batch models/a.gltf models/b.gltf -o 'img/{stem}.png' --resume -- --quality draft --size=16
says "batch: 0 done, 2 kept"
[ "$(ls img | tr '\n' ' ')" = "a.0123abcd a.png a.png.1 b.png other.0123abcd sub " ] || failed "it leaves $(ls img | tr '\n' ' ')"
rm img/a.0123abcd img/a.png.1 img/other.0123abcd
expect 0 batch models/a.gltf models/b.gltf -o 'img/{stem}.png' --resume -- $tiny --ortho
says "batch: 2 done, 0 kept"
"$facet" render models/a.gltf -o img/a.png $tiny --ortho
expect 0 batch models/a.gltf models/b.gltf -o 'img/{stem}.png' --resume -- $tiny --ortho
says "batch: 1 done, 1 kept"
expect 0 batch models/a.gltf -o 'img/{stem}.exr' -q -- $tiny
expect 0 batch models/a.gltf -o 'img/{stem}.exr' --resume -- $tiny
says "batch: 0 done, 1 kept"
# With --resume=content also other bytes of the model are rendered again.
expect 0 batch models/b.gltf -o 'img/{stem}.png' --resume=content -q -- $tiny
expect 0 batch models/b.gltf -o 'img/{stem}.png' --resume=content -- $tiny
says "batch: 0 done, 1 kept"
echo >>models/b.gltf
expect 0 batch models/b.gltf -o 'img/{stem}.png' --resume=content -- $tiny
says "batch: 1 done, 0 kept"
expect 2 batch models/b.gltf --resume=bytes
says '--resume: "bytes" is none of content'
finish
