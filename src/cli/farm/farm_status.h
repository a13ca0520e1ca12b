/* farm_status.h - what is done of a run: from the results of its shards, and from Slurm. */
#ifndef CLI_FARM_STATUS_H
#define CLI_FARM_STATUS_H

#include "cli/farm/farm_run.h"
#include "cli/farm/farm_slurm.h"

/* A shard; one that is no part of a catalog counts as one item. */
typedef struct farm_shard {
    uint64_t items, done, failed; /* failed: not worth another try, such as an invalid model */
    farm_place place;
    char history[24]; /* its last state in Slurm's accounting; "": unknown */
} farm_shard;

/* {0} initially. */
typedef struct farm_status {
    farm_shard *shards; /* run->shard_count */
    uint64_t items, done, failed;
    uint64_t to_retry;                  /* items that failed as if by the machine */
    uint32_t running, waiting, missing; /* shards; missing: unfinished, and nowhere in Slurm */
    json_t *failures;                   /* the first FARM_FAILURES: objects with name and message */
} farm_status;
enum { FARM_FAILURES = 20 };

facet_result farm_status_read(const farm_run *run, farm_status *out, facet_error *error);
void farm_status_destroy(farm_status *s); /* {0} is allowed */

/* Whether every item of the shard has a result. */
bool farm_shard_is_finished(const farm_shard *s);
/* Whether nothing is left to do: every item is done. */
bool farm_status_is_complete(const farm_status *s);

#endif
