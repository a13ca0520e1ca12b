#!/bin/sh
# slurm.sh - facet farm on a real Slurm of two nodes on this machine: a catalog with an invalid model and one that hangs, and
# an image in parts, while a node is lost and a shard is asked to end. Everything that can be done is done, in the bytes of
# one process. Needs root, slurm-wlm and munge; without them it is skipped, or fails where CI_REQUIRES_ALL is set.
set -eu
here=$(CDPATH= cd -- "$(dirname -- "$0")" && pwd)
. "$here/cluster.sh"
needs slurm-wlm slurmctld slurmd sbatch srun squeue scontrol scancel
needs munge munged
[ "$(id -u)" = 0 ] || missing "the daemons of Slurm need root"
own_processes sh "$here/slurm.sh" "$@"
. "$here/../cli/lib.sh"
trap 'cluster_stop; rm -rf "$work"' EXIT
trap 'exit 1' INT TERM HUP

# 30 items: one is no model, one a pipe that nobody writes to.
write_triangle tri.gltf
echo "not a model" >bad.glb
mkfifo hang.glb
for i in $(seq 1 30); do
    input=tri.gltf
    [ $i = 4 ] && input=bad.glb
    [ $i = 11 ] && input=hang.glb
    echo "{\"input\": \"$input\", \"output\": \"thumbs/it's $i.png\", \"orbit\": [$((i * 20)), 75]}"
done >jobs.jsonl
settings="--size 96 --renderer path --samples 64"
still="render tri.gltf --size 96 --renderer path --samples 64"
expect 0 $still -o "still wanted.png"
grep -v '"bad.glb"\|"hang.glb"' jobs.jsonl >good.jsonl
expect 0 batch --manifest good.jsonl --time-limit 8s -- $settings
mv thumbs wanted

cluster_start
expect 0 farm submit --run "a catalog" --shards 6 --shard-cpus 1 -- batch --manifest jobs.jsonl --time-limit 8s -- $settings
catalog=$(sed -n 's/.*"array": "\([0-9]*\)".*/\1/p' "a catalog/run.json")
expect 0 farm submit --run still --shards 3 --shard-cpus 1 -- $still -o "still got.png"
says "still: 3 of 3 shards submitted"

# element_on NODE: an element of the catalog whose step runs there; false: none.
element_on() {
    element=$(squeue -h -s -w "$1" -o %i | sed -n "s/^${catalog}_\([0-9]*\)\.0$/\1/p" | head -n 1)
    [ -n "$element" ]
}
wait_for 20 "no element ran on n2" element_on n2
expect 1 farm status --run "a catalog"
grep -q "shards running" out || failed "status: $(cat out)"
kill_node n2
# Asks an element to end, until one did with items left, so that it exited with 75 and was requeued.
is_requeued() {
    element_on n1 || return 1
    controller=$work/daemons/slurmctld.log
    before=$(wc -l <"$controller")
    timeout 2 scancel --signal=TERM "${catalog}_$element" 2>/dev/null || true # it waits for what follows the signal
    sleep 1
    tail -n "+$((before + 1))" "$controller" | grep -q "Requeuing JobId=${catalog}_$element("
}
wait_for 40 "no element that ended with 75 was requeued" is_requeued

queue_is_empty() {
    [ -z "$(squeue -h)" ]
}
wait_for 90 "the jobs did not end" queue_is_empty
expect 1 farm status --run "a catalog"
grep -q "28 of 30 items done" out || failed "status: $(cat out)"
grep -q "items failed: 2" out || failed "status: $(cat out)"
grep -q "bad.glb" out || failed "status does not name bad.glb: $(cat out)"
expect 0 farm status --run still
diff -r thumbs wanted >differences || failed "$(head -3 differences)"
cmp "still got.png" "still wanted.png" || failed "the merged image differs"
# Nothing is left to do but what failed; when that is repaired, it is done, too.
expect 0 farm retry --run "a catalog"
says "0 of 6 shards submitted"
rm hang.glb
cp tri.gltf bad.glb
cp tri.gltf hang.glb
expect 0 farm retry --run "a catalog" --with-failed
says "1 of 6 shards submitted"
wait_for 60 "the jobs did not end" queue_is_empty
expect 0 farm status --run "a catalog"
finish
