#!/bin/sh
# sge.sh - a catalog as an array job of Grid Engine: qsub sge.sh. Untested. Its tasks are numbered from 1, and it says how
# many there are; resubmitted as a part (-t 17-17) it needs --shard auto/400.
#$ -N facet-catalog
#$ -t 1-400
#$ -tc 64
#$ -pe smp 4
#$ -l h_rt=00:30:00
#$ -r y -notify
#$ -cwd -j y
facet batch --manifest jobs.jsonl --shard auto/400 --resume --results "results/$SGE_TASK_ID.jsonl" -j 4 -- --size 256
code=$?
[ $code = 75 ] && exit 99 # Grid Engine runs a task again that exits with 99
exit $code
