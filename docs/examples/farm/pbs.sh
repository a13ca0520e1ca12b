#!/bin/sh
# pbs.sh - a catalog as an array job of PBS Professional or OpenPBS: qsub pbs.sh. Untested. PBS gives a job its index
# (PBS_ARRAY_INDEX), not their number: auto/400 repeats it.
#PBS -N facet-catalog
#PBS -J 0-399
#PBS -l select=1:ncpus=4:mem=4gb
#PBS -l walltime=00:30:00
#PBS -r y
#PBS -j oe
cd "$PBS_O_WORKDIR" || exit 75
exec facet batch --manifest jobs.jsonl --shard auto/400 --resume --results "results/$PBS_ARRAY_INDEX.jsonl" -j 4 -- --size 256
