/* farm_slurm.h - submits a run to Slurm, and asks what it does, by Slurm's own programs: sbatch, scontrol, squeue, sacct. */
#ifndef CLI_FARM_SLURM_H
#define CLI_FARM_SLURM_H

#include "cli/farm/farm_run.h"

/* What Slurm knows about a shard. */
typedef enum farm_place { FARM_NOWHERE, FARM_WAITING, FARM_RUNNING } farm_place;

/* The largest number of elements of an array (MaxArraySize); Slurm's default, 1001, where it does not answer. */
uint32_t farm_slurm_max_shards(void);

/* "0-3,7": the shards that are set, as --array takes them. A text for free(); NULL: no memory. */
char *farm_shard_list(const bool *shards, uint32_t count);

/* Submits the shards that are set as an array, and the job that follows it; adds both to run.json. */
facet_result farm_slurm_submit(farm_run *run, const bool *shards, facet_error *error);

/* Writes the place of each shard. Without Slurm all are FARM_NOWHERE. */
void farm_slurm_places(const farm_run *run, farm_place *places);

/* Calls add() for each shard's last state in Slurm's accounting, such as "TIMEOUT"; not at all without accounting. */
void farm_slurm_history(const farm_run *run, void (*add)(void *user, uint32_t shard, const char *state),
                        void *user);

#endif
