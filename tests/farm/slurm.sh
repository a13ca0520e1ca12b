#!/bin/sh
# slurm.sh - facet farm on a real Slurm of two nodes on this machine: a catalog with an invalid model and one that hangs, and
# a sharded image, while a node is lost. Everything that can be done is done, in the same bytes as without a cluster.
# Needs root, slurm-wlm and munge; skipped, or failed where CI_REQUIRES_ALL is set, without them.
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
cluster_start
expect 0 farm submit --run still --shards 6 --shard-cpus 1 -- render -o still.png --size 300 --quality final
cat out err
runs_on_n2() { squeue -h -w n2 -t R -o %A | grep -q .; }
wait_for 20 "nothing ran on n2" runs_on_n2
kill_node n2
"$facet" farm status --run still || true
queue_is_empty() { [ -z "$(squeue -h)" ]; }
wait_for 60 "the queue did not become empty" queue_is_empty
"$facet" farm status --run still || true
cat still/log/*
finish
