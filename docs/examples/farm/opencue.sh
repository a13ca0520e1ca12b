#!/bin/sh
# opencue.sh - a catalog in OpenCue: a frame of the layer is a shard. Untested. cuecmd takes a file of commands and makes a
# job of it; --chunk puts several commands into a frame.
set -eu
facet farm submit --run /shared/catalog --print-commands -- batch --manifest /shared/jobs.jsonl -- --size 256 \
    >/shared/catalog.txt
cuecmd /shared/catalog.txt --chunk 1 --cores 4 --job-name facet_catalog
# When the job has ended: what is missing is a shorter list of commands.
#     facet farm status --run /shared/catalog
#     facet farm retry --run /shared/catalog --print-commands >/shared/again.txt
