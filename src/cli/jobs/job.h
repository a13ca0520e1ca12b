/* job.h - jobs: runs of a verb in child processes of this one, for facet batch and facet serve. A crash, a hang, a leak or
 * the memory of a job affects no other job. A child is forked, not started: it shares what this process has prepared
 * (job_warm.h) and costs about a millisecond. */
#ifndef CLI_JOB_H
#define CLI_JOB_H

#include "base/result.h"

#include <jansson.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Name of an output that becomes job_result.output; it has no extension, so that --format is needed. */
#define JOB_OUTPUT "/dev/fd/3"

/* A job to start. {0}, with words. */
typedef struct job_request {
    const char *const
        *words;        /* the verb and its arguments without "facet", NULL-terminated; --json is added */
    const char *name;  /* begins messages about the end of the child: the model */
    const void *input; /* standard input of the verb, input_size bytes; NULL: empty */
    size_t input_size;
    size_t max_output_bytes;   /* of job_result.output; a longer one ends the job; 0: none is expected */
    double time_limit_s;       /* wall clock, after which the child is ended; 0: none */
    uint64_t max_memory_bytes; /* of data, as a fence around the verb's own --max-memory; 0: none */
    void *user;                /* for job_result */
} job_request;

typedef enum job_end {
    JOB_EXITED,    /* by itself */
    JOB_KILLED,    /* by a signal from elsewhere: a crash, or the kernel for lack of memory */
    JOB_TIMED_OUT, /* ended at time_limit_s */
    JOB_CANCELLED, /* by job_pool_cancel() */
    JOB_OVERFLOWED /* ended, as its output exceeded max_output_bytes */
} job_end;

/* A finished job. {0} initially; for job_result_destroy(). */
typedef struct job_result {
    job_end end;
    int exit_code; /* of the verb; else 128 + signal, EXIT_LIMIT, EXIT_AGAIN, EXIT_LIMIT, by the order of job_end */
    int signal;     /* JOB_KILLED: by which the child ended; else 0 */
    json_t *report; /* the object of --json; NULL: none was printed */
    /* Why the job failed: one sentence, from the report, from standard error, or about its end. NULL: it did not, or
     * there is no memory. */
    char *message;
    char *log; /* standard error, at most 64 KiB; NULL: empty */
    unsigned char *output;
    size_t output_size;
    double seconds;             /* from start to end */
    double cpu_seconds;         /* of all its threads */
    uint64_t peak_memory_bytes; /* resident; what is shared with this process included */
    void *user;
} job_result;

void job_result_destroy(job_result *result); /* leaves {0} */

#endif
