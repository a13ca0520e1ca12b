/* job_child.h - the child process of a job. */
#ifndef CLI_JOB_CHILD_H
#define CLI_JOB_CHILD_H

#include "cli/jobs/job.h"

#include <sys/types.h>

/* A running child. Descriptors are -1 where there is none. */
typedef struct job_child {
    pid_t process;
    int output; /* reads what the child writes to JOB_OUTPUT, without blocking; at its end the child has ended */
    int out, log; /* files without a name: its standard output and standard error */
} job_child;

/* Forks the child, which runs the job's verb. */
facet_result job_child_start(const job_request *job, job_child *child, facet_error *error);
/* Signals the child and all processes that it has started. */
void job_child_signal(const job_child *child, int number);
/* Waits for the end of the child and writes what it left to end, exit_code, signal, report, message, log, cpu_seconds and
 * peak_memory_bytes of result. Closes the descriptors. */
void job_child_finish(job_child *child, job_result *result);

#endif
