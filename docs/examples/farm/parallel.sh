#!/bin/sh
# parallel.sh - a catalog on a few machines without a scheduler, by GNU parallel over ssh. The machines of hosts.txt (a line
# each; ":" is this one) see the same files. Run it again after a failure: what is done is skipped.
set -eu
run=catalog
[ -e $run/run.json ] || facet farm submit --run $run --print-commands -- batch --manifest jobs.jsonl -- --size 256 >$run.commands
facet farm retry --run $run --print-commands |
    parallel --sshloginfile hosts.txt --jobs 1 --joblog $run/parallel.log --retries 3 || true
facet farm status --run $run
