/* metrics.c - see metrics.h. */
#define _POSIX_C_SOURCE 200809L
#include "cli/serve/metrics.h"

#include "facet/facet.h"

#include <stdio.h>
#include <unistd.h>

static const double bounds[METRICS_BUCKET_COUNT - 1] = {0.005, 0.01, 0.025, 0.05, 0.1, 0.25,
                                                        0.5,   1.0,  2.5,   10.0, 60.0};

void metrics_count(metrics *m, transport by, size_t which, answer_kind kind)
{
    m->requests[by][which][kind]++;
}

void metrics_time(metrics *m, size_t which, double seconds)
{
    int i = 0;
    while (i < METRICS_BUCKET_COUNT - 1 && seconds > bounds[i])
        i++;
    m->buckets[which][i]++;
    m->seconds[which] += seconds;
}

void metrics_job(metrics *m, const job_result *result)
{
    m->jobs[result->end]++;
    m->cpu_seconds += result->cpu_seconds;
    if (result->peak_memory_bytes > m->peak_job_bytes)
        m->peak_job_bytes = result->peak_memory_bytes;
}

void metrics_gone(metrics *m)
{
    m->gone++;
}

/* ---- the text ---- */

static void head(text *out, const char *name, const char *type, const char *help)
{
    text_addf(out, "# HELP %s %s\n# TYPE %s %s\n", name, help, name, type);
}

static void print_one(text *out, const char *name, const char *type, const char *help, double value)
{
    head(out, name, type, help);
    text_addf(out, "%s %.15g\n", name, value);
}

/* Answers of one transport and method, by code: the status of HTTP, or the error of JSON-RPC (0: none). */
static void print_requests(const metrics *m, int by, size_t which, text *out)
{
    static const char *const words[TRANSPORT_COUNT] = {"jsonrpc", "mcp", "http"};
    for (int kind = 0; kind < ANSWER_KIND_COUNT; kind++) {
        const answer_code *code = &answer_codes[kind];
        uint64_t count = m->requests[by][which][kind];
        if (count)
            text_addf(out,
                      "facet_requests_total{transport=\"%s\",method=\"%s\",code=\"%d\",reason=\"%s\"} %llu\n",
                      words[by], methods[which].verb->name,
                      by == TRANSPORT_HTTP ? code->http_status : code->rpc_code, code->word,
                      (unsigned long long)count);
    }
}

static void print_times(const metrics *m, size_t which, text *out)
{
    const char *name = methods[which].verb->name;
    uint64_t count = 0;
    for (int i = 0; i < METRICS_BUCKET_COUNT; i++) {
        count += m->buckets[which][i];
        if (i < METRICS_BUCKET_COUNT - 1)
            text_addf(out, "facet_request_seconds_bucket{method=\"%s\",le=\"%g\"} %llu\n", name, bounds[i],
                      (unsigned long long)count);
        else
            text_addf(out, "facet_request_seconds_bucket{method=\"%s\",le=\"+Inf\"} %llu\n", name,
                      (unsigned long long)count);
    }
    text_addf(out, "facet_request_seconds_sum{method=\"%s\"} %.9g\n", name, m->seconds[which]);
    text_addf(out, "facet_request_seconds_count{method=\"%s\"} %llu\n", name, (unsigned long long)count);
}

/* Resident memory of this process, bytes; 0: unknown. */
static double resident_bytes(void)
{
    unsigned long total, resident = 0;
    FILE *file = fopen("/proc/self/statm", "re");
    if (!file)
        return 0.0;
    if (fscanf(file, "%lu %lu", &total, &resident) != 2)
        resident = 0;
    fclose(file);
    return (double)resident * (double)sysconf(_SC_PAGESIZE);
}

void metrics_print(const metrics *m, const metrics_now *now, text *out)
{
    static const char *const ends[METRICS_JOB_END_COUNT] = {"exited", "killed", "timed_out", "cancelled",
                                                            "overflowed"};
    head(out, "facet_build_info", "gauge", "The version of facet.");
    text_addf(out, "facet_build_info{version=\"%s\"} 1\n", facet_version());
    head(out, "facet_requests_total", "counter", "Answered requests, by transport, method and code.");
    for (int by = 0; by < TRANSPORT_COUNT; by++)
        for (size_t which = 0; which < METHOD_COUNT; which++)
            print_requests(m, by, which, out);
    head(out, "facet_request_seconds", "histogram", "Time from arrival to answer, waiting included.");
    for (size_t which = 0; which < METHOD_COUNT; which++)
        print_times(m, which, out);
    head(out, "facet_jobs_total", "counter", "Jobs that have ended, by how.");
    for (int i = 0; i < METRICS_JOB_END_COUNT; i++)
        text_addf(out, "facet_jobs_total{end=\"%s\"} %llu\n", ends[i], (unsigned long long)m->jobs[i]);
    print_one(out, "facet_abandoned_total", "counter", "Requests whose client has gone.", (double)m->gone);
    print_one(out, "facet_refused_clients_total", "counter", "Connections beyond the limit.",
              (double)m->refused_clients);
    print_one(out, "facet_job_cpu_seconds_total", "counter", "CPU time of all jobs.", m->cpu_seconds);
    print_one(out, "facet_job_peak_memory_bytes", "gauge", "Largest resident memory of a job so far.",
              (double)m->peak_job_bytes);
    print_one(out, "facet_queue_depth", "gauge", "Requests that wait.", (double)now->queue_depth);
    print_one(out, "facet_queue_limit", "gauge", "Requests that may wait.", (double)now->queue_limit);
    print_one(out, "facet_jobs_running", "gauge", "Jobs that run.", now->running);
    print_one(out, "facet_workers", "gauge", "Jobs that may run at a time.", now->workers);
    print_one(out, "facet_clients", "gauge", "Connections of HTTP.", now->clients);
    print_one(out, "process_resident_memory_bytes", "gauge",
              "Resident memory of the server without its jobs.", resident_bytes());
}
