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

# GNU parallel. Shard 1 fails at first, as its results cannot be written; the log of jobs says which to run again.
rm -rf thumbs
expect 0 farm submit --run "a run" --shards 4 --shard-cpus 1 --print-commands -- batch --manifest jobs.jsonl
cp out commands
mkdir "a run/results/1.jsonl"
code=0
parallel --will-cite -j 2 --joblog joblog <commands >/dev/null 2>err || code=$?
[ $code = 1 ] || failed "parallel: exit code $code, not 1 failed job"
expect 1 farm status --run "a run"
grep -q "18 of 24 items done" out || failed "status: $(cat out)"
grep -q "1 shards unfinished: 1" out || failed "status: $(cat out)"
expect 0 farm retry --run "a run" --print-commands
[ "$(cat out)" = "$(sed -n 2p commands)" ] || failed "retry prints $(cat out)"
rmdir "a run/results/1.jsonl"
parallel --will-cite --joblog joblog --retry-failed >/dev/null 2>err || failed "parallel --retry-failed"
expect 0 farm status --run "a run"
expect 0 farm retry --run "a run" --print-commands
[ ! -s out ] || failed "retry prints $(cat out)"
check parallel

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
