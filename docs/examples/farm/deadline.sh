#!/bin/sh
# deadline.sh - one large image in Thinkbox Deadline 10, by its CommandLine plug-in: task N runs chunk.sh N. Untested.
set -eu
facet farm submit --run /shared/huge --shards 40 --print-commands -- \
    render /shared/huge.glb -o /shared/huge.exr --size 32768x16384 >/dev/null
deadlinecommand -SubmitCommandLineJob -executable /bin/sh -arguments "/shared/huge/chunk.sh <STARTFRAME>" -frames 0-39 \
    -chunksize 1 -name facet-huge
# When the job has ended: sh /shared/huge/finish.sh merges the parts, or says which are missing.
