#!/bin/sh
# shards.sh - shards without an engine: processes that are killed at random moments and run again, faked engines, and GNU
# parallel. The outputs are complete and in the bytes of one process; no temporary file is left.
set -eu
here=$(CDPATH= cd -- "$(dirname -- "$0")" && pwd)
. "$here/cluster.sh"
needs parallel parallel
. "$here/../cli/lib.sh"

# write_manifest FOLDER: 24 items with odd names.
write_manifest() {
    for i in $(seq 1 24); do
        echo "{\"input\": \"tri.gltf\", \"output\": \"$1/it's \$$i (a).png\", \"size\": 24, \"orbit\": [$((i * 15)), 75]}"
    done
}
write_triangle tri.gltf
write_manifest thumbs >jobs.jsonl
expect 0 batch --manifest jobs.jsonl
mv thumbs wanted

# check NAME: thumbs is as wanted, without temporary files.
check() {
    # a file system that has no files without a name may keep what a killed process was writing
    [ "$(stat -f -c %T .)" != overlayfs ] || find thumbs -name '*.png.????????' -delete
    diff -r thumbs wanted >differences || failed "$1: $(head -3 differences)"
    left=$(find . -name '.*' ! -name . | head -3)
    [ -z "$left" ] || failed "$1 leaves $left"
}

# Three shards; one is killed at a random moment, then all run again.
tries=12
is_quick && tries=3
for try in $(seq 1 $tries); do
    rm -rf thumbs r.*
    processes=
    for i in 0 1 2; do
        "$facet" batch --manifest jobs.jsonl --shard $i/3 --resume --results r.$i -j 1 -q >/dev/null 2>&1 &
        processes="$processes $!"
        [ $i = $((try % 3)) ] && victim=$!
    done
    sleep 0.$(($(od -An -N1 -tu1 /dev/urandom) % 30 + 10))
    kill -9 $victim 2>/dev/null || true
    for process in $processes; do
        wait $process 2>/dev/null || true
    done
    for i in 0 1 2; do
        expect 0 batch --manifest jobs.jsonl --shard $i/3 --resume --results r.$i -j 1
    done
    check "kill $try"
done

# as VARIABLE=VALUE... -- CODE: a shard of the manifest in an environment of an engine.
as() {
    (
        while [ "$1" != -- ]; do
            export "$1"
            shift
        done
        expect "$2" batch --manifest jobs.jsonl --shard auto
        exit $status
    ) || status=1
}
rm -rf thumbs
as OMPI_COMM_WORLD_RANK=0 OMPI_COMM_WORLD_SIZE=2 -- 0
as JOB_COMPLETION_INDEX=1 FACET_SHARD_COUNT=2 -- 0
check "shards of two engines"
as SLURM_ARRAY_TASK_ID=7 SLURM_ARRAY_TASK_MIN=3 SLURM_ARRAY_TASK_MAX=7 SLURM_ARRAY_TASK_COUNT=2 -- 2
says "is not known to be whole"
as PBS_ARRAY_INDEX=1 -- 2
says "number of shards is not in the environment"
as FACET=1 -- 2
says "the environment has none of FACET_SHARD=I/N, SLURM_ARRAY_TASK_ID, JOB_COMPLETION_INDEX"

# A run whose folder needs quotes. GNU parallel. Shard 1 fails at first, as its results cannot be written; the log of jobs says which to run again.
rm -rf thumbs
run="it's a \"run\" of \$5"
expect 0 farm submit --run "$run" --shards 4 --shard-cpus 1 --print-commands -- batch --manifest jobs.jsonl
cp out commands
mkdir "$run/results/1.jsonl"
code=0
parallel --will-cite -j 2 --joblog joblog <commands >/dev/null 2>err || code=$?
[ $code = 1 ] || failed "parallel: exit code $code, not 1 failed job"
expect 1 farm status --run "$run"
grep -q "18 of 24 items done" out || failed "status: $(cat out)"
grep -q "shards unfinished: 1 (1)" out || failed "status: $(cat out)"
expect 0 farm retry --run "$run" --print-commands
[ "$(cat out)" = "$(sed -n 2p commands)" ] || failed "retry prints $(cat out)"
rmdir "$run/results/1.jsonl"
parallel --will-cite --joblog joblog --retry-failed >/dev/null 2>err || failed "parallel --retry-failed"
expect 0 farm status --run "$run"
expect 0 farm retry --run "$run" --print-commands
[ ! -s out ] || failed "retry prints $(cat out)"
check parallel

# Without --shards and costs a sample is rendered, which the shards keep. What is quick needs one shard.
rm -rf thumbs
expect 0 farm submit --run sampled --shard-cpus 1 --print-commands -- batch --manifest jobs.jsonl
[ "$(wc -l <out)" = 1 ] || failed "the sample gives $(wc -l <out) shards"
[ "$(find thumbs -type f | wc -l)" = 8 ] || failed "the sample is $(find thumbs -type f | wc -l) items, not 8"
sh sampled/chunk.sh 0 2>err || failed "chunk.sh"
[ "$(grep -c '"kept"' sampled/results/0.jsonl)" = 8 ] || failed "the shard did not keep the sample"
check "a run with a sample"
sed 's/}$/, "cost": 50}/' jobs.jsonl >costs.jsonl
expect 0 farm submit --run costs --shard-cpus 2 --target-time 100s --print-commands -- batch --manifest costs.jsonl
[ "$(wc -l <out)" = 6 ] || failed "costs of 1200 core seconds give $(wc -l <out) shards, not 6"

# Frames, and an image in parts; finish.sh merges it, or names what is missing.
expect 0 render tri.gltf --size 24 --turntable 5 -o 'wanted_##.png'
expect 0 farm submit --run frames --shards 2 --print-commands -- render tri.gltf --size 24 --turntable 5 -o 'frame_##.png'
sh out
expect 0 farm status --run frames
for i in 1 2 3 4 5; do
    cmp wanted_0$i.png frame_0$i.png || failed "frame $i"
done
expect 0 render tri.gltf --size 50 -o still_wanted.jpg --jpeg-quality 60
expect 0 farm submit --run "still's" --shards 3 --print-commands -- render tri.gltf --size 50 -qo still.jpg --jpeg-quality=60
sed 2d out | sh
sh "still's/finish.sh" >out 2>err && failed "finish.sh without a part"
grep -q -- "--shard 1/3" out || failed "finish.sh does not say which part is missing: $(cat out)"
expect 0 farm retry --run "still's" --print-commands
[ "$(wc -l <out)" = 1 ] || failed "retry prints $(cat out)"
sh out
sh "still's/finish.sh" >out 2>err || failed "finish.sh"
cmp still.jpg still_wanted.jpg || failed "the merged image differs"

# Slurm's accounting says how an unfinished shard ended.
mkdir fake
printf '#!/bin/sh\necho "7_1|TIMEOUT"\n' >fake/sacct
printf '#!/bin/sh\necho "7 0 PD"\n' >fake/squeue
printf '#!/bin/sh\ncase $* in *afterany:7*) echo 8 ;; *) echo 7 ;; esac\n' >fake/sbatch
chmod +x fake/*
PATH=$PWD/fake:$PATH
expect 0 farm submit --run slow --shards 3 --at-once 2 --sbatch=--partition=long -- render tri.gltf -o slow.png
says "3 of 3 shards submitted"
expect 1 farm status --run slow
grep -q "shards waiting: 1 (0)" out || failed "status: $(cat out)"
grep -q "shard 1: TIMEOUT" out || failed "status: $(cat out)"
expect 1 farm status --run slow --json
grep -q '"shards_unfinished": 2' out || failed "status --json: $(cat out)"
expect 0 farm retry --run slow
says "2 of 3 shards submitted"
expect 2 farm submit --run slow --shards 3 -- render tri.gltf -o slow.png
says "holds a run already"

# The examples can be parsed.
examples=$here/../../docs/examples/farm
for example in "$examples"/*.sh; do
    sh -n "$example" || failed "$example"
done
if command -v python3 >/dev/null 2>&1 && python3 -c 'import yaml' 2>/dev/null; then
    python3 -c 'import json, sys, yaml; json.load(open(sys.argv[1])); [yaml.safe_load(open(a)) for a in sys.argv[2:]]' \
        "$examples/aws-batch.json" "$examples/kubernetes.yaml" "$examples/openjd.yaml" || failed "an example cannot be parsed"
fi
finish
