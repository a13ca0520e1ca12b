/* metrics.h - what the server has done, in the text format of Prometheus (0.0.4). */
#ifndef CLI_SERVE_METRICS_H
#define CLI_SERVE_METRICS_H

#include "base/text.h"
#include "cli/jobs/job.h"
#include "cli/serve/answer.h"
#include "cli/serve/method.h"

typedef enum transport { TRANSPORT_RPC, TRANSPORT_MCP, TRANSPORT_HTTP, TRANSPORT_COUNT } transport;

enum { METRICS_BUCKET_COUNT = 12, METRICS_JOB_END_COUNT = 5 };

/* {0} initially. */
typedef struct metrics {
    uint64_t requests[TRANSPORT_COUNT][METHOD_COUNT][ANSWER_KIND_COUNT];
    uint64_t buckets[METHOD_COUNT][METRICS_BUCKET_COUNT]; /* not cumulative; the last is above all bounds */
    double seconds[METHOD_COUNT];
    uint64_t jobs[METRICS_JOB_END_COUNT];
    uint64_t gone;            /* requests whose client left */
    uint64_t refused_clients; /* connections beyond the limit, and messages that are none */
    double cpu_seconds;       /* of the jobs */
    uint64_t peak_job_bytes;
} metrics;

void metrics_count(metrics *m, transport by, size_t which, answer_kind kind);
void metrics_time(metrics *m, size_t which, double seconds);
void metrics_job(metrics *m, const job_result *result);
void metrics_gone(metrics *m);

/* What is measured at the moment. */
typedef struct metrics_now {
    size_t queue_depth, queue_limit;
    unsigned running, workers, clients;
} metrics_now;
void metrics_print(const metrics *m, const metrics_now *now, text *out);

#endif
