#!/bin/sh
# batch_faults.sh - facet batch among items that crash, hang and take memory, killed and interrupted at any moment.
set -eu
. "$(dirname "$0")/lib.sh"
tiny="--size 16 --quality draft"
write_triangle a.gltf
mkfifo hang.gltf
process=

# A pipe without a writer hangs its reader.
trap '[ -z "$process" ] || kill -9 $process 2>/dev/null; rm -rf "$work"' EXIT

item() {
    printf '%s\n' "$1" >>jobs.jsonl
}

# Children of a process.
children() {
    cat "/proc/$1/task/$1/children" 2>/dev/null || true
}

# wait_for CONDITION: until the shell text is true, at most 30 s.
wait_for() {
    tries=0
    until eval "$1"; do
        tries=$((tries + 1))
        [ $tries -lt 300 ] || { failed "it never happens: $1"; return 0; }
        sleep 0.1
    done
}

# ---- a hang, a hog ----

for i in 0 1 2 3; do item "{\"input\":\"a.gltf\",\"output\":\"o/$i.png\"}"; done
item '{"input":"hang.gltf","output":"o/hang.png"}'
item '{"input":"a.gltf","output":"o/hog.png","size":4000,"max-memory":"20M"}'
item '{"input":"a.gltf","output":"o/4.png"}'
expect 1 batch --manifest jobs.jsonl -j 2 --time-limit 1s --results r.jsonl -- $tiny
says "hang.gltf"
says "the limit is 20 MiB (--max-memory)"
says "batch: 5 done, 0 kept, 2 failed"
[ "$(ls -A o | tr '\n' ' ')" = "0.png 1.png 2.png 3.png 4.png " ] || failed "the outputs are $(ls -A o)"
grep -F hang.png r.jsonl | grep -F '"exit_code":7' | grep -qF '"tries":2' || failed "the hang: $(grep -F hang.png r.jsonl)"
grep -F hog.png r.jsonl | grep -F '"exit_code":7' | grep -qF '"tries":2' || failed "the hog: $(grep -F hog.png r.jsonl)"

# ---- a crash ----

if [ -e "/proc/$$/task/$$/children" ]; then
    rm jobs.jsonl
    item '{"input":"hang.gltf","output":"c/crash.png"}'
    for i in 0 1 2; do item "{\"input\":\"a.gltf\",\"output\":\"c/$i.png\"}"; done
    "$facet" batch --manifest jobs.jsonl -j 2 --results c.jsonl -- $tiny 2>err &
    process=$!
    wait_for '[ -e c/2.png ] && [ -n "$(children $process)" ]'
    kill -SEGV $(children $process)
    sleep 0.3
    wait_for '[ -n "$(children $process)" ]' # once more, alone
    kill -SEGV $(children $process)
    code=0
    wait $process || code=$?
    process=
    [ $code = 1 ] || failed "exit code $code after a crash"
    says "hang.gltf: its process crashed and was ended by signal 11"
    grep -F crash.png c.jsonl | grep -F '"signal":11' | grep -qF '"tries":2' || failed "the crash: $(cat c.jsonl)"
    [ "$(grep -c '"status":"done"' c.jsonl)" = 3 ] || failed "a crash takes others with it: $(cat c.jsonl)"

    # Three crashes in a row are those of the models, if the machine can render.
    mkdir -p poison
    for i in 0 1 2; do mkfifo "poison/$i.gltf"; done
    "$facet" batch poison/0.gltf poison/1.gltf poison/2.gltf a.gltf -j 1 -o 'p/{stem}.png' --results p.jsonl -- $tiny 2>err &
    process=$!
    while kill -0 $process 2>/dev/null; do
        child=$(children $process)
        sleep 0.8
        [ -z "$child" ] || [ "$child" != "$(children $process)" ] || kill -SEGV $child 2>/dev/null || true
    done
    code=0
    wait $process || code=$?
    process=
    [ $code = 1 ] || failed "exit code $code after three crashes in a row: $(cat err)"
    [ -s p/a.png ] || failed "three crashes in a row end the batch"

    # Jobs end with their parent, however that ends.
    "$facet" batch --manifest jobs.jsonl -j 1 -- $tiny 2>err &
    process=$!
    wait_for '[ -n "$(children $process)" ]'
    child=$(children $process)
    kill -9 $process
    wait $process 2>/dev/null || true
    process=
    wait_for '! kill -0 $child 2>/dev/null'
fi

# ---- reading, writing, the machine ----

# A folder that comes late, as one of another machine may, is read in the end.
(sleep 1.5; mkdir late.new; write_triangle late.new/late.gltf; mv late.new late) &
expect 0 batch late/late.gltf -o 'l/{stem}.png' --results l.jsonl -- $tiny
grep -qF '"tries":3' l.jsonl || grep -qF '"tries":2' l.jsonl || failed "a late file: $(cat l.jsonl)"
# Missing files are failures of their items, on any machine.
expect 1 batch no1.gltf no2.gltf no3.gltf a.gltf -j 1 --shard 0/1 -o 'm/{stem}.png' -- $tiny
says "batch: 1 done, 0 kept, 3 failed"
[ -e m/a.png ] || failed "missing files stop the batch"
# Three items in a row that cannot be read for another reason: the machine is suspect.
expect 75 batch gone/no1.gltf gone/no2.gltf gone/no3.gltf a.gltf -j 1 -o 'l/{stem}.png' -- $tiny
says "three items in a row failed as if by this machine"
[ ! -e l/a.png ] || failed "a suspect machine goes on"

# Few descriptors delay items, and pipes at the place of files do not hang the batch.
(ulimit -n 20; expect 0 batch a.gltf a.gltf -j 8 -o 'few/{index}.png' -- $tiny)
mkfifo pipe.png
echo '{"input":"a.gltf","output":"pipe.png"}' >pipe.jsonl
timeout 20 "$facet" batch --manifest pipe.jsonl --resume --dry-run -- $tiny >out 2>err || failed "a pipe as output: exit $?"
echo '{"input":"hang.gltf","output":"hang.png"}' >pipe.jsonl
timeout 20 "$facet" batch --manifest pipe.jsonl --resume=content --dry-run -- $tiny >out 2>err || failed "a pipe as input: exit $?"

# ---- killed at any moment ----

rm -f jobs.jsonl
for i in 0 1 2 3 4 5 6 7 8 9 10 11; do
    item "{\"input\":\"a.gltf\",\"output\":\"k/$i.png\",\"orbit\":\"$((i * 30)),75,105%\",\"size\":\"$((100 + i))\"}"
done
expect 0 batch --manifest jobs.jsonl -q
mv k whole
rounds=12
is_quick && rounds=4
for round in $(seq $rounds); do
    rm -rf k k.jsonl
    "$facet" batch --manifest jobs.jsonl -j 2 --results k.jsonl --resume -q &
    process=$!
    sleep "0.$(printf '%03d' $((round * 37 % 400)))"
    kill -9 $process 2>/dev/null || true
    wait $process 2>/dev/null || true
    process=
    expect 0 batch --manifest jobs.jsonl -j 2 --results k.jsonl --resume -q
    diff -r k whole >err 2>&1 || { failed "round $round: other outputs after kill -9"; break; }
    expect 0 batch --manifest jobs.jsonl --results k.jsonl --verify -q
done

# ---- SIGTERM: what runs ends, the rest is left ----

rm -rf k k.jsonl jobs.jsonl
for i in 0 1 2 3; do
    item "{\"input\":\"a.gltf\",\"output\":\"t/$i.png\",\"renderer\":\"path\",\"samples\":$((64 + i)),\"size\":256}"
done
"$facet" batch --manifest jobs.jsonl -j 1 --results t.jsonl 2>err &
process=$!
wait_for '[ -e t/0.png ]'
kill -TERM $process
code=0
wait $process || code=$?
process=
[ $code = 75 ] || [ $code = 0 ] || failed "exit code $code after SIGTERM"
[ $code = 0 ] || says "batch: interrupted; --resume continues"
expect 0 batch --manifest jobs.jsonl --results t.jsonl --resume -j 2
[ "$(ls -A t | tr '\n' ' ')" = "0.png 1.png 2.png 3.png " ] || failed "the outputs are $(ls -A t)"
[ "$(grep -c '"status":"done"' t.jsonl)" = 4 ] || failed "results after SIGTERM: $(cat t.jsonl)"
finish
