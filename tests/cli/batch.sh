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
# So does another configuration.
echo '{"ortho":true}' >view.json
expect 0 batch models/b.gltf -o 'img/{stem}.png' --resume -q -- $tiny --config view.json
expect 0 batch models/b.gltf -o 'img/{stem}.png' --resume -- $tiny --config view.json
says "batch: 0 done, 1 kept"
echo '{"ortho":true,"fov":20}' >view.json
expect 0 batch models/b.gltf -o 'img/{stem}.png' --resume -- $tiny --config view.json
says "batch: 1 done, 0 kept"
expect 2 batch models/b.gltf --resume=bytes
says '--resume: "bytes" is none of content'

# ---- manifests ----

line() {
    printf '%s\n' "$1" >>jobs.jsonl
}
line '{"id":"one","input":"models/a.gltf","output":"m/a.png","size":[16,8],"background":"transparent"}'
line ''
line '{"input":"models/b.gltf","output":"m/b.png","ortho":true,"cost":2}'
line '{"input":"models/a.gltf","command":"inspect"}'
line '{"input":"models/a.gltf","command":"convert","output":"m/{stem}.glb"}'
line '{"input":"models/sub/c.gltf"}'
expect 0 batch --manifest jobs.jsonl --results m.jsonl -o 'm/{stem}.png' -j 2 -- $tiny
[ "$(ls m | tr '\n' ' ')" = "a.glb a.png b.png c.png " ] || failed "the outputs are $(ls m)"
is_type m/a.png "16 x 8, 8-bit/color RGBA"
[ "$(count m.jsonl '"status":"done"')" = 5 ] && [ "$(count m.jsonl '"id":"one"')" = 1 ] || failed "results: $(cat m.jsonl)"
grep -F '"command":"inspect"' m.jsonl | grep -qF '"report":{' || failed "the report of inspect is not in the results"
"$facet" batch --manifest - --results m.jsonl -o 'm/{stem}.png' --resume -- $tiny <jobs.jsonl 2>err || failed "a manifest on standard input"
says "batch: 0 done, 5 kept, 0 failed"
expect 0 batch --manifest jobs.jsonl --results m.jsonl -o 'm/{stem}.png' --verify -- $tiny
rm m/b.png
expect 1 batch --manifest jobs.jsonl --results m.jsonl -o 'm/{stem}.png' --verify -- $tiny
grep -qF "missing: m/b.png, of models/b.gltf" out || failed "it verifies: $(cat out)"
says "batch: 4 done, 0 failed, 1 missing"
expect 0 batch --manifest jobs.jsonl --results m.jsonl -o 'm/{stem}.png' --resume --dry-run -- $tiny
[ "$(wc -l <out)" = 1 ] && grep -qF "facet render --size 16 --quality draft --ortho models/b.gltf" out ||
    failed "it would run: $(cat out)"
[ ! -e m/b.png ] || failed "a dry run writes"
sh -c "$(sed "s|^facet|'$facet'|" out)" && [ -s m/b.png ] || failed "the printed command fails: $(cat out)"
expect 0 batch --manifest jobs.jsonl --results m.jsonl -o 'm/{stem}.png' --verify -- $tiny

echo '{"input":"models/sub/c.gltf","output":"d/{dir}.png"}' | "$facet" batch --manifest - -q -- $tiny
[ -s d/models/sub.png ] || failed "{dir} of an item of a manifest"

# Items run as they come.
mkfifo stream
"$facet" batch --manifest - -o 'stream/{stem}.png' -- $tiny <stream 2>err &
process=$!
exec 4>stream
echo '{"input":"models/a.gltf","output":"s/first.png"}' >&4
tries=0
while [ ! -e s/first.png ] && [ $tries -lt 200 ]; do
    sleep 0.1
    tries=$((tries + 1))
done
[ -e s/first.png ] || failed "an item of a stream waits for its end"
printf '{"input":"models/b.gltf","output":"s/second.png"}' >&4
exec 4>&-
wait $process || failed "a stream"
[ -e s/second.png ] || failed "the last line of a stream, without its end, is lost"

# Wrong lines and wrong items fail alone, each with its place; the failed ones are a manifest again.
rm jobs.jsonl
line '{"input":"models/a.gltf","output":"w/a.png"}'
line '{"input":"models/a.gltf","output":"w/b.png","sise":3}'
line 'no JSON'
line '{"input":"models/a.gltf","output":"./w//./a.png"}'
line '{"output":"w/d.png"}'
line '{"input":"models/old.gltf","output":"w/old.png"}'
line '{"input":"models/a.gltf","output":"w/e.png","time":"soon"}'
line '{"input":"models/a.gltf","output":"w/f.png","command":"view"}'
expect 1 batch --manifest jobs.jsonl --failed again.jsonl -- $tiny
says "jobs.jsonl: line 2: unknown option --sise; did you mean --size?"
says "jobs.jsonl: line 3: column 2:"
says "jobs.jsonl: line 4: its output ./w//./a.png is that of item 1 as well"
says "jobs.jsonl: line 5: it has no input"
says 'jobs.jsonl: line 7: --time: "soon" is not a number'
says "jobs.jsonl: line 8: command: it is none of render,"
says "batch: 1 done, 0 kept, 7 failed"
grep -qF '"output":"w/old.png","exit_code":5,"message":"models/old.gltf' again.jsonl || failed "failed: $(cat again.jsonl)"
cp models/b.gltf models/old.gltf
grep -F old.png again.jsonl >once.jsonl
expect 0 batch --manifest once.jsonl -- $tiny
[ -s w/old.png ] || failed "a failed item cannot be run again"

# Too long a line, bytes of 0 and invalid UTF-8 fail as items, and the others are done.
rm jobs.jsonl
line '{"input":"models/a.gltf","output":"v/a.png"}'
(printf '{"input":"'; head -c 3000000 /dev/zero | tr '\0' a; printf '"}\n\0\0\n{"input":"\377"\n') >>jobs.jsonl
line '{"input":"models/a.gltf","output":"v/b.png"}'
expect 1 batch --manifest jobs.jsonl --failed wrong.jsonl -- $tiny
says "jobs.jsonl: line 2: it is longer than 1 MiB"
says "jobs.jsonl: line 3: column"
says "jobs.jsonl: line 4: column"
says "batch: 2 done, 0 kept, 3 failed"
[ "$(wc -l <wrong.jsonl)" = 3 ] || failed "failed lines: $(wc -l <wrong.jsonl)"

# Names that are no UTF-8 are found in the results as well.
mkdir odd
cp models/a.gltf "$(printf 'odd/\377.gltf')"
for run in 1 2; do expect 0 batch odd -o 'odd/{stem}.jpg' --results odd.jsonl --resume -- $tiny; done
says "batch: 0 done, 1 kept, 0 failed"
[ "$(wc -l <odd.jsonl)" = 1 ] || failed "results of a name that is no UTF-8: $(cat odd.jsonl)"

# ---- shards, jobs at a time ----

rm jobs.jsonl
for i in 0 1 2 3 4 5 6 7 8 9; do
    line "{\"input\":\"models/a.gltf\",\"output\":\"all/$i.png\",\"orbit\":\"$((i * 30)),75,105%\"}"
done
expect 0 batch --manifest jobs.jsonl -j 1 -q -- $tiny
mv all serial
for i in 2 0 1; do
    expect 0 batch --manifest jobs.jsonl -j 3 --shard $i/3 --results 'r.{shard}.jsonl' -q -- $tiny
done
diff -r all serial || failed "shards and a serial run differ"
cat r.0.jsonl r.1.jsonl r.2.jsonl | grep -c '"status":"done"' | grep -qx 10 || failed "the results of the shards"
expect 0 batch --manifest jobs.jsonl --results 'r.{shard}.jsonl' --verify --json -- $tiny
grep -qF '"done": 10, "failed": 0, "missing": 0' out || failed "it verifies shards: $(cat out)"

expect 0 batch --manifest jobs.jsonl --resume --progress json -q -- $tiny
tail -n 1 err | grep -qF '"progress": 1.0000, "total": 10, "done": 0, "kept": 10, "failed": 0' || failed "progress: $(cat err)"

# ---- the gallery ----

line '{"input":"models/package.json","output":"all/bad <one>.png"}'
echo '{}' >models/package.json
expect 1 batch --manifest jobs.jsonl --gallery pages/all.html --resume -q -- $tiny
[ "$(grep -c '<img loading="lazy" src="../all/' pages/all.html)" = 10 ] || failed "images of the gallery"
grep -qF '<b>bad &lt;one&gt;.png</b>' pages/all.html || failed "failures of the gallery"
grep -qF '10 done, 1 failed</p>' pages/all.html || failed "the head of the gallery"

# ---- usage ----

expect 2 batch models -o one.png --nothing
expect 2 batch models -o -
says "items cannot share standard output"
expect 2 batch models -o '{stem}_{what}.png'
says "{what} is not a placeholder"
expect 2 batch models --size 256
says "--size is an option of facet render; options of all items stand after --"
expect 2 batch models -- --sise 3
says "unknown option --sise; did you mean --size?"
expect 2 batch models -- --size 3 models/a.gltf
says "stands after --"
expect 2 batch models -- -o x.png
says "it stands before --"
expect 3 batch --manifest nothing.jsonl
expect 3 batch models -- --env missing.hdr
expect 1 batch models/a.gltf models/b.gltf -o same.png -q -- $tiny
says "its output same.png is that of item 1 as well"
finish
