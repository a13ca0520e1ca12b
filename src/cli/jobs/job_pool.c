/* job_pool.c - see job_pool.h. */
#define _GNU_SOURCE
#include "cli/jobs/job_pool.h"

#include "cli/jobs/job_child.h"
#include "cli/shared/failure.h"
#include "cli/shared/interrupt.h"

#include <errno.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* From SIGTERM, upon which a child may remove its temporary files, to SIGKILL, s. */
static const double grace_s = 1.0;

typedef struct slot {
    bool is_running;
    job_child child;
    char *name;
    double start, time_limit, kill_at; /* interrupt_clock(); 0: no limit; not ended yet */
    job_end end;                       /* why it is being ended; JOB_EXITED: it is not */
    double limit_s;
    size_t max_output_bytes, capacity;
    size_t entry; /* in polled, while it runs */
    job_result result;
} slot;

struct job_pool {
    unsigned slot_count, running;
    slot *slots;
    struct pollfd *polled; /* one per slot, and room for others */
    size_t polled_capacity;
};

job_pool *job_pool_create(unsigned slot_count)
{
    job_pool *pool = calloc(1, sizeof *pool);
    if (pool)
        *pool = (job_pool){.slot_count = slot_count, .slots = calloc(slot_count, sizeof *pool->slots)};
    if (pool && !pool->slots) {
        free(pool);
        return NULL;
    }
    return pool;
}

unsigned job_pool_running(const job_pool *pool)
{
    return pool->running;
}

bool job_pool_has_slot(const job_pool *pool)
{
    return pool->running < pool->slot_count;
}

facet_result job_pool_start(job_pool *pool, const job_request *job, facet_error *error)
{
    slot *s = pool->slots;
    while (s->is_running)
        s++;
    *s = (slot){.name = strdup(job->name ? job->name : job->words[0]),
                .start = interrupt_clock(),
                .limit_s = job->time_limit_s,
                .max_output_bytes = job->max_output_bytes,
                .result = {.user = job->user}};
    if (!s->name)
        return fail_memory(error, "a job", 0);
    s->time_limit = job->time_limit_s > 0.0 ? s->start + job->time_limit_s : 0.0;
    facet_result result = job_child_start(job, &s->child, error);
    if (result != FACET_OK) {
        free(s->name);
        return result;
    }
    s->is_running = true;
    pool->running++;
    return FACET_OK;
}

/* ---- ending ---- */

/* Begins to end a job: first politely. */
static void end_slot(slot *s, job_end why)
{
    if (s->end != JOB_EXITED)
        return;
    s->end = why;
    s->kill_at = interrupt_clock() + grace_s;
    job_child_signal(&s->child, SIGTERM);
    job_child_signal(&s->child, SIGCONT); /* if it was stopped */
}

static void check_time(slot *s, double now)
{
    if (s->time_limit > 0.0 && now >= s->time_limit)
        end_slot(s, JOB_TIMED_OUT);
    if (s->end != JOB_EXITED && now >= s->kill_at) {
        job_child_signal(&s->child, SIGKILL);
        s->kill_at = now + grace_s;
    }
}

static char *describe_end(const slot *s, const job_result *r)
{
    char *message = NULL;
    int length = 0;
    switch (r->end) {
    case JOB_EXITED:
        return r->message;
    case JOB_KILLED:
        length = asprintf(&message, "%s: its process %s by signal %d (%s)%s", s->name,
                          r->signal == SIGKILL ? "was killed" : "crashed and was ended", r->signal,
                          strsignal(r->signal), r->signal == SIGKILL ? ", perhaps for lack of memory" : "");
        break;
    case JOB_TIMED_OUT:
        length = asprintf(&message, "%s: it was ended after its time limit of %.4g s", s->name, s->limit_s);
        break;
    case JOB_CANCELLED:
        length = asprintf(&message, "%s: it was cancelled", s->name);
        break;
    case JOB_OVERFLOWED:
        length = asprintf(&message, "%s: its output is larger than %zu bytes", s->name, s->max_output_bytes);
        break;
    }
    return length < 0 ? NULL : message;
}

/* Ends a job whose process has ended, and moves its result to *out. */
static void finish(job_pool *pool, slot *s, job_result *out)
{
    job_result *r = &s->result;
    job_child_finish(&s->child, r);
    r->seconds = interrupt_clock() - s->start;
    bool is_done = r->end == JOB_EXITED && r->exit_code == EXIT_DONE && s->end != JOB_OVERFLOWED;
    if (s->end != JOB_EXITED && !is_done) {
        r->end = s->end;
        r->signal = 0;
        r->exit_code = s->end == JOB_CANCELLED ? EXIT_AGAIN : EXIT_LIMIT;
        free(r->message);
        r->message = NULL;
    }
    r->message = describe_end(s, r);
    *out = *r;
    free(s->name);
    *s = (slot){0};
    pool->running--;
}

/* ---- output ---- */

/* Reads what has come. Returns whether the child has ended. */
static bool drain(slot *s)
{
    enum { BLOCKS = 256 }; /* then the other jobs have their turn */
    job_result *r = &s->result;
    for (int i = 0; i < BLOCKS; i++) {
        unsigned char block[65536];
        ssize_t n = read(s->child.output, block, sizeof block);
        if (n == 0)
            return true;
        if (n < 0)
            return errno != EAGAIN && errno != EINTR;
        size_t size = (size_t)n;
        if (r->output_size + size > s->max_output_bytes) {
            end_slot(s, JOB_OVERFLOWED);
            continue;
        }
        if (r->output_size + size > s->capacity) {
            size_t wanted = 2 * (r->output_size + size);
            unsigned char *grown = realloc(r->output, wanted);
            if (!grown) {
                end_slot(s, JOB_OVERFLOWED);
                continue;
            }
            r->output = grown;
            s->capacity = wanted;
        }
        memcpy(r->output + r->output_size, block, size);
        r->output_size += size;
    }
    return false;
}

/* ---- waiting ---- */

/* Until when to wait at most: the next time at which a job is to be ended. */
static double next_moment(const job_pool *pool, double until)
{
    for (unsigned i = 0; i < pool->slot_count; i++) {
        const slot *s = &pool->slots[i];
        if (!s->is_running)
            continue;
        double moment = s->end != JOB_EXITED ? s->kill_at : s->time_limit;
        if (moment > 0.0 && moment < until)
            until = moment;
    }
    return until;
}

/* Room for the descriptors of all slots and others; false: no memory. */
static bool reserve(job_pool *pool, size_t other_count)
{
    size_t wanted = pool->slot_count + other_count;
    if (wanted <= pool->polled_capacity)
        return true;
    struct pollfd *grown = realloc(pool->polled, wanted * sizeof *grown);
    if (!grown)
        return false;
    pool->polled = grown;
    pool->polled_capacity = wanted;
    return true;
}

/* Polls once, at most until the moment. Returns poll()'s value. */
static int poll_once(job_pool *pool, struct pollfd *others, size_t other_count, double moment)
{
    size_t running = 0; /* free slots would count for the limit of descriptors */
    for (unsigned i = 0; i < pool->slot_count; i++)
        if (pool->slots[i].is_running) {
            pool->slots[i].entry = running;
            pool->polled[running++] = (struct pollfd){.fd = pool->slots[i].child.output, .events = POLLIN};
        }
    if (other_count)
        memcpy(pool->polled + running, others, other_count * sizeof *others);
    double left = moment - interrupt_clock();
    int milliseconds = left <= 0.0 ? 0 : left > 1e5 ? 100000000 : (int)(left * 1e3) + 1;
    int count = poll(pool->polled, running + other_count, milliseconds);
    if (other_count)
        memcpy(others, pool->polled + running, other_count * sizeof *others);
    return count;
}

bool job_pool_wait(job_pool *pool, struct pollfd *others, size_t other_count, double timeout_s,
                   job_result *result)
{
    double until = interrupt_clock() + timeout_s;
    if (!reserve(pool, other_count))
        return false;
    for (;;) {
        int count = poll_once(pool, others, other_count, next_moment(pool, until));
        if (count < 0)
            return false;
        double now = interrupt_clock();
        for (unsigned i = 0; i < pool->slot_count; i++) {
            slot *s = &pool->slots[i];
            if (!s->is_running)
                continue;
            if (pool->polled[s->entry].revents && drain(s)) {
                finish(pool, s, result);
                return true;
            }
            check_time(s, now);
        }
        for (size_t i = 0; i < other_count; i++)
            if (others[i].revents)
                return false;
        if (now >= until)
            return false;
    }
}

void job_pool_cancel(job_pool *pool, const void *user)
{
    for (unsigned i = 0; i < pool->slot_count; i++)
        if (pool->slots[i].is_running && pool->slots[i].result.user == user)
            end_slot(&pool->slots[i], JOB_CANCELLED);
}

void job_pool_cancel_all(job_pool *pool)
{
    for (unsigned i = 0; i < pool->slot_count; i++)
        if (pool->slots[i].is_running)
            end_slot(&pool->slots[i], JOB_CANCELLED);
}

void job_pool_destroy(job_pool *pool)
{
    if (!pool)
        return;
    for (unsigned i = 0; i < pool->slot_count; i++) {
        slot *s = &pool->slots[i];
        job_result result = {.user = NULL};
        if (!s->is_running)
            continue;
        job_child_signal(&s->child, SIGKILL);
        finish(pool, s, &result);
        job_result_destroy(&result);
    }
    free(pool->slots);
    free(pool->polled);
    free(pool);
}

void job_result_destroy(job_result *result)
{
    json_decref(result->report);
    free(result->message);
    free(result->log);
    free(result->output);
    *result = (job_result){0};
}
