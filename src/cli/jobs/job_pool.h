/* job_pool.h - a number of jobs at a time. The caller polls; nothing happens between calls. No thread may run in this
 * process while a job is started. When this process ends, in whatever way, its jobs are killed.
 *
 *     job_pool *pool = job_pool_create(4);
 *     while (more jobs or job_pool_running(pool)) {
 *         while (more jobs && job_pool_has_slot(pool))
 *             job_pool_start(pool, &job, &error);
 *         job_result result;
 *         if (job_pool_wait(pool, NULL, 0, 1.0, &result)) {
 *             ..
 *             job_result_destroy(&result);
 *         }
 *     }
 *     job_pool_destroy(pool);
 */
#ifndef CLI_JOB_POOL_H
#define CLI_JOB_POOL_H

#include "cli/jobs/job.h"

#include <poll.h>

typedef struct job_pool job_pool;

/* A pool of slot_count (at least 1) slots; NULL: no memory. */
job_pool *job_pool_create(unsigned slot_count);
/* Kills the jobs that run. NULL is allowed. */
void job_pool_destroy(job_pool *pool);

unsigned job_pool_running(const job_pool *pool);
bool job_pool_has_slot(const job_pool *pool);

/* Starts a job in a free slot. Fails with FACET_ERROR_SYSTEM where the system has no process or descriptor for it,
 * FACET_ERROR_MEMORY, and FACET_ERROR_UNSUPPORTED where there are no processes (WebAssembly). */
facet_result job_pool_start(job_pool *pool, const job_request *job, facet_error *error);

/* Waits until a job has ended, which is written to *result (true), or until timeout_s has passed, a descriptor of others
 * has an event (their revents are set), or a signal was handled (false). Several jobs may have ended: call it again. A
 * timeout of 0 does not wait. */
bool job_pool_wait(job_pool *pool, struct pollfd *others, size_t other_count, double timeout_s,
                   job_result *result);

/* Cancels the jobs with that job_request.user: their results follow. */
void job_pool_cancel(job_pool *pool, const void *user);
/* Cancels all jobs. */
void job_pool_cancel_all(job_pool *pool);

#endif
