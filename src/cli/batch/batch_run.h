/* batch_run.h - runs the items of facet batch. */
#ifndef CLI_BATCH_RUN_H
#define CLI_BATCH_RUN_H

#include "cli/batch/batch_leftovers.h"
#include "cli/batch/batch_progress.h"
#include "cli/batch/batch_results.h"
#include "cli/batch/batch_source.h"
#include "cli/jobs/job_pool.h"

enum { BATCH_KEPT_FAILURES = 100 }; /* in the object of --json */

/* {0}, with plan, source, results, failed, history, messages and progress. */
typedef struct batch_run {
    const batch_plan *plan;
    batch_source *source;
    batch_lines results, failed;
    batch_history history; /* of earlier runs */
    const messages *messages;
    json_t *reasons;  /* why items failed, by id, for the gallery; NULL: not wanted */
    json_t *failures; /* receives the first failures; NULL: not wanted */
    batch_progress progress;
    uint64_t for_others; /* failures that another machine may not have */

    job_pool *pool;
    batch_map outputs; /* numbers of items by their outputs */
    batch_leftovers leftovers;
    batch_item *later, *alone; /* lists of items to try again */
    unsigned alone_count;
    unsigned start_failures;    /* in a row */
    batch_item *running_alone;  /* NULL: none */
    bool is_at_end, is_waiting; /* of the source */
    double stop_time;           /* interrupt_clock() of the signal; 0: none */
    bool is_suspect;            /* the machine */
    unsigned suspect_count;     /* of the last items in a row whose first try failed as if by the machine */
    char reason[512];           /* of the last of them */
} batch_run;

/* Runs all items. FACET_ERROR_CANCELLED: a signal came, or the machine is suspect: what is left can be run again. Other
 * failures are of the manifest, of --results, or of the system. */
facet_result batch_run_all(batch_run *run, facet_error *error);

void batch_run_destroy(batch_run *run);

#endif
