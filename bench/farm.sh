#!/bin/sh
# farm.sh - where the time of a large run goes: a model of facet farm on a cluster, from costs that were measured.
#
#     sh bench/farm.sh [NAME=VALUE...] [RESULTS.jsonl...]
#
# RESULTS.jsonl of facet batch give the cost of an item and its spread (cpu_seconds of the items that were done; needs jq).
# Otherwise, and for all else, the values below. The model draws the cost of every shard, and hands shards to nodes as Slurm
# does: the next one to the first node that is free. Within a shard, workers take items as they come.
#
#     models=1000000     items of the catalog
#     item_s=0.062       mean cost of an item, core seconds
#     spread=1.6         standard deviation of that cost over its mean
#     nodes=1000 cores=1 of the cluster, and of a node; a shard takes a node
#     target_s=180       --target-time
#     max_shards=1001    MaxArraySize
#     node_share=0.95    speed of a core while all cores of its node work, relative to one alone
#     start_s=0.1        start of a shard: facet batch, its environment and tables
#     element_s=1.7      an element of an array: prolog, srun, epilog, the scheduler's round
#     rate=100           elements that Slurm starts in a second
#     store_s=0.001      of an item beside its work, per core: fork, report, fsync, rename
#     lost=1             nodes lost during the run; noticed after lost_s=300, as SlurmdTimeout is
#     finish_s=10        the job after the array: facet farm status over all results
#     seed=1
set -eu
settings= files=
for word; do
    case $word in
    *=*) settings="$settings $word" ;;
    *) files="$files $word" ;;
    esac
done
measured=
for file in $files; do
    [ -s "$file" ] || {
        echo "farm.sh: $file: no results are there" >&2
        exit 2
    }
done
if [ -n "$files" ]; then
    measured=$(cat $files | jq -r 'select(.status == "done" and .cpu_seconds) | .cpu_seconds' |
        awk '{ n++; s += $1; q += $1 * $1 } END { if (!n) exit; m = s / n; printf "item_s=%g spread=%g", m, sqrt(q / n - m * m) / m }')
fi
# The operating point is printed as a table: a row per share of the nodes' time.
echo $measured $settings | awk '
function normal(   u) { # Box and Muller 1958
    do u = rand(); while (u == 0)
    return sqrt(-2 * log(u)) * cos(6.283185307179586 * rand())
}
function sift(i,   child, t) { # a heap of the times at which nodes are free
    while ((child = 2 * i) <= nodes) {
        if (child < nodes && free[child + 1] < free[child])
            child++
        if (free[i] <= free[child])
            return
        t = free[i]; free[i] = free[child]; free[child] = t
        i = child
    }
}
BEGIN {
    v["models"] = 1e6; v["item_s"] = 0.062; v["spread"] = 1.6; v["nodes"] = 1000; v["cores"] = 1; v["target_s"] = 180
    v["max_shards"] = 1001; v["node_share"] = 0.95; v["start_s"] = 0.1; v["element_s"] = 1.7; v["rate"] = 100
    v["store_s"] = 0.001; v["lost"] = 1; v["lost_s"] = 300; v["finish_s"] = 10; v["seed"] = 1
}
{
    for (i = 1; i <= NF; i++) {
        split($i, pair, "=")
        if (!(pair[1] in v)) {
            print "farm.sh: there is no value " pair[1] >"/dev/stderr"
            exit 2
        }
        v[pair[1]] = pair[2] + 0
    }
}
END {
    if (!("models" in v) || NF && !(pair[1] in v))
        exit 2
    srand(v["seed"])
    nodes = v["nodes"]
    work = v["models"] * (v["item_s"] + v["store_s"]) / v["node_share"]
    shards = int(work / (v["cores"] * v["target_s"])) + 1
    # --shards: a multiple of the nodes, since one shard more is a round more
    rounds = int((shards + nodes - 1) / nodes)
    if (rounds * nodes > v["max_shards"] && v["max_shards"] >= nodes)
        rounds = int(v["max_shards"] / nodes)
    shards = rounds * nodes
    per_shard = v["models"] / shards
    for (i = 1; i <= nodes; i++)
        free[i] = 0
    for (s = 0; s < shards; s++) {
        # the sum of many independent items is normal; the last items of a shard leave cores idle
        sum = per_shard * v["item_s"] * (1 + v["spread"] / sqrt(per_shard) * normal())
        busy = (sum + per_shard * v["store_s"]) / v["node_share"] / v["cores"]
        tail = v["item_s"] * (1 + v["spread"]) * (v["cores"] - 1) / v["cores"]
        begin = s / v["rate"]
        if (free[1] > begin)
            begin = free[1]
        waited += begin - free[1]
        free[1] = begin + v["element_s"] + v["start_s"] + busy + tail
        tails += tail
        sift(1)
    }
    for (i = 1; i <= nodes; i++) {
        if (free[i] > end)
            end = free[i]
        all += free[i]
    }
    # a lost node: its shard runs again elsewhere, after Slurm has noticed; only items in flight are rendered twice
    late = end / 2 + v["lost_s"] + v["element_s"] + v["start_s"] + busy / 2
    wall = (v["lost"] > 0 && late > end ? late : end) + v["finish_s"]
    ideal = v["models"] * v["item_s"] / v["node_share"] / v["cores"]
    useful = ideal
    store = v["models"] * v["store_s"] / v["node_share"] / v["cores"]
    again = v["lost"] * (v["element_s"] + v["start_s"] + v["item_s"])
    total = all - waited + again + v["finish_s"]
    printf "%d models of %.3g core seconds on %d nodes of %d cores: %d shards of %.0f models, %.0f s each\n", v["models"],
        v["item_s"], nodes, v["cores"], shards, per_shard, per_shard * v["item_s"] / v["node_share"] / v["cores"]
    printf "node time %.1f h, of which items %.1f h: efficiency %.3f\n", total / 3600, useful / 3600, useful / total
    printf "wall-clock time %.0f s; %.0f s if nothing but items took time\n\n", wall, ideal / nodes
    printf "| where the time of the nodes goes | share |\n| --- | --- |\n"
    printf "| items | %.2f %% |\n", 100 * useful / total
    printf "| fork, report, outputs, results | %.2f %% |\n", 100 * store / total
    printf "| elements of the array | %.2f %% |\n", 100 * shards * v["element_s"] / total
    printf "| start of facet batch | %.2f %% |\n", 100 * shards * v["start_s"] / total
    printf "| cores idle at the end of a shard | %.2f %% |\n", 100 * tails / total
    printf "| shards of lost nodes, again | %.2f %% |\n", 100 * again / total
    printf "| the finishing job | %.2f %% |\n\n", 100 * v["finish_s"] / total
    printf "| where the wall-clock time goes | s |\n| --- | --- |\n"
    printf "| items, evenly on all nodes | %.0f |\n", ideal / nodes
    printf "| the overhead above, per node | %.0f |\n", (all - waited - ideal) / nodes
    printf "| Slurm starts the elements, mean | %.0f |\n", waited / nodes
    printf "| until the last node ends, mean | %.0f |\n", end - all / nodes
    printf "| a lost node is noticed, its shard ends elsewhere | %.0f |\n", wall - v["finish_s"] - end
    printf "| the finishing job | %.0f |\n", v["finish_s"]
}'
