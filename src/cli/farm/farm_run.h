/* farm_run.h - a run: a command that is done in shards, and its folder, which holds
 *
 *     run.json      this record
 *     chunk.sh      does one shard: sh chunk.sh SHARD
 *     slurm.sh      the array job of Slurm, which runs chunk.sh
 *     finish.sh     the job after the array: merges parts, says what is missing
 *     results/      what each shard did: SHARD.jsonl of facet batch, SHARD.json of facet render --json
 *     parts/        parts of an image, for facet merge
 *     log/          standard output and standard error of the jobs */
#ifndef CLI_FARM_RUN_H
#define CLI_FARM_RUN_H

#include "base/result.h"

#include <jansson.h>
#include <stdint.h>

enum { FARM_PATH_SIZE = 4096 };

/* {0} initially. */
typedef struct farm_run {
    char *folder; /* absolute */
    json_t *root; /* of run.json */
    /* members of root */
    const char *verb;     /* batch or render */
    uint32_t shard_count; /* at least 1 */
    uint64_t item_count;  /* of a catalog; else 0 */
} farm_run;

/* Makes the folder and those in it, for farm_run_save(). FACET_ERROR_WRITE; FACET_ERROR_ARGUMENT where it holds a run. */
facet_result farm_run_create(const char *folder, farm_run *out, facet_error *error);
/* Reads run.json of folder. FACET_ERROR_READ where there is none, FACET_ERROR_INVALID. */
facet_result farm_run_load(const char *folder, farm_run *out, facet_error *error);
/* Writes run.json from root, which has the members of farm_run, and reads them. */
facet_result farm_run_save(farm_run *run, facet_error *error);
void farm_run_destroy(farm_run *run); /* {0} is allowed */

/* Writes a text file into the folder of the run. */
facet_result farm_run_write(const farm_run *run, const char *name, const char *text, facet_error *error);
/* A whole number of run.json; 0: there is none. */
json_int_t farm_run_number(const farm_run *run, const char *name);

/* The kinds of runs. */
bool farm_run_is_catalog(const farm_run *run);

#endif
