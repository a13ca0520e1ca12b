/* job_warm.h - what jobs share: prepared in this process before the first of them is forked. */
#ifndef CLI_JOB_WARM_H
#define CLI_JOB_WARM_H

#include "cli/jobs/job_options.h"

/* Loads and filters the environment that jobs with these words (verb first) need, unless it is shared already: the file or
 * sky of --env, for facet render also the studio. Its threads have ended on return. Further environments than 8 are left to
 * the jobs. Fails as loading it does, and as job_words_check(). */
facet_result job_warm(const job_words *words, facet_error *error);

#endif
