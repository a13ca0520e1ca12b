/* batch_policy.h - what follows from the result of an item: the rules of docs/batch.md. */
#ifndef CLI_BATCH_POLICY_H
#define CLI_BATCH_POLICY_H

#include "cli/batch/batch_item.h"
#include "cli/jobs/job.h"

typedef enum batch_answer {
    ANSWER_DONE,
    ANSWER_FAILED, /* for good */
    ANSWER_LATER,  /* try again after a while */
    ANSWER_ALONE   /* try again without others, with half of the threads */
} batch_answer;

/* The answer to a result of an item, whose tries include this one. *wait_s: the pause of ANSWER_LATER. */
batch_answer batch_answer_to(const batch_item *item, const job_result *result, double *wait_s);

/* Whether such a failure may be one of the machine instead of the item: reading, writing, something lacks, signals. A model
 * or a file of it that is missing from a folder that can be read is a failure of the item. */
bool batch_is_machine_failure(const batch_item *item, const job_result *result);

/* Whether an item that failed so for good should be tried on another machine. */
bool batch_is_for_others(const batch_item *item, int exit_code);

#endif
