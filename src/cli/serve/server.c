/* server.c - see server.h. */
#include "cli/serve/server.h"

#include "cli/shared/interrupt.h"

#include <stdlib.h>
#include <string.h>

struct ticket {
    ticket *next; /* in the queue, or in the list of what runs */
    request request;
    const server_client *client; /* NULL: it has gone */
    double start;
    bool is_cancelled;
};

struct server {
    server_settings settings;
    job_pool *pool;
    ticket *queue, *running; /* the queue in order of arrival */
    size_t queue_depth;
    uint64_t held_bytes; /* of the inputs of all requests */
    metrics metrics;
    bool is_stopping;
};

/* Inputs that wait in memory or in the temporary folder, in units of the largest one. */
enum { HELD_BODIES = 8 };

server *server_create(const server_settings *settings)
{
    server *s = calloc(1, sizeof *s);
    job_pool *pool = job_pool_create(settings->worker_count);
    if (!s || !pool) {
        job_pool_destroy(pool);
        free(s);
        return NULL;
    }
    s->settings = *settings;
    s->pool = pool;
    return s;
}

static void destroy_list(ticket *list)
{
    while (list) {
        ticket *next = list->next;
        request_destroy(&list->request);
        free(list);
        list = next;
    }
}

void server_destroy(server *s)
{
    if (!s)
        return;
    job_pool_destroy(s->pool);
    destroy_list(s->queue);
    destroy_list(s->running);
    folder_remove(&s->settings.limits.folder);
    free(s);
}

const server_settings *server_settings_of(const server *s)
{
    return &s->settings;
}

metrics *server_metrics(server *s)
{
    return &s->metrics;
}

size_t server_queue_depth(const server *s)
{
    return s->queue_depth;
}

unsigned server_running(const server *s)
{
    return job_pool_running(s->pool);
}

bool server_is_idle(const server *s)
{
    return !s->queue && !s->running;
}

void server_describe(const server *s, text *out)
{
    text_json_begin_object(out, NULL);
    text_json_string(out, "status", s->is_stopping ? "stopping" : "ok");
    text_json_string(out, "facet", facet_version());
    text_json_integer(out, "workers", s->settings.worker_count);
    text_json_integer(out, "running", server_running(s));
    text_json_integer(out, "waiting", (int64_t)s->queue_depth);
    text_json_end_object(out);
}

/* ---- taking requests ---- */

bool server_is_busy(const server *s, answer *refusal)
{
    const uint64_t most = s->settings.limits.max_body_bytes * HELD_BODIES;
    const size_t free_slots = s->settings.worker_count - job_pool_running(s->pool);
    if (s->is_stopping)
        answer_fail(refusal, ANSWER_STOPPING, "the server is stopping");
    else if (s->queue_depth >= s->settings.queue_limit + free_slots)
        answer_fail(refusal, ANSWER_BUSY, "the server is busy: %zu requests are waiting; try again",
                    s->queue_depth);
    else if (s->held_bytes > most)
        answer_fail(refusal, ANSWER_BUSY, "the server is busy: %llu MiB of models are waiting; try again",
                    (unsigned long long)(s->held_bytes >> 20));
    return refusal->kind != ANSWER_DONE;
}

static void append(ticket **list, ticket *t)
{
    while (*list)
        list = &(*list)->next;
    *list = t;
    t->next = NULL;
}

ticket *server_submit(server *s, const method *m, const json_t *params, request_body body,
                      const server_client *client, answer *refusal)
{
    ticket *t = server_is_busy(s, refusal) ? NULL : calloc(1, sizeof *t);
    if (!t) {
        if (refusal->kind == ANSWER_DONE)
            answer_fail(refusal, ANSWER_BUSY, "the server is out of memory; try again");
        free(body.bytes);
    } else if (!request_create(&s->settings.limits, m, params, body, &t->request, refusal)) {
        free(t);
        t = NULL;
    }
    if (!t) {
        metrics_count(&s->metrics, client->transport, method_index(m), refusal->kind);
        return NULL;
    }
    t->client = client;
    t->start = interrupt_clock();
    s->held_bytes += t->request.held_bytes;
    s->queue_depth++;
    append(&s->queue, t);
    return t;
}

/* ---- the end of requests ---- */

static bool take_out(ticket **list, const ticket *t)
{
    for (; *list; list = &(*list)->next)
        if (*list == t) {
            *list = t->next;
            return true;
        }
    return false;
}

/* Passes the answer on, and ends a ticket that is in no list any more. */
static void end(server *s, ticket *t, answer *a)
{
    double seconds = interrupt_clock() - t->start;
    const char *name = t->request.name;
    message_at(s->settings.messages, VERBOSITY_DETAILS, "%s%s%s: %s, exit code %d, %.3f s%s%s",
               t->request.method->verb->name, name[0] ? " " : "", name,
               t->client ? answer_codes[a->kind].word : "client gone", a->exit_code, seconds,
               a->message[0] ? ": " : "", a->message);
    if (t->client) {
        metrics_count(&s->metrics, t->client->transport, method_index(t->request.method), a->kind);
        metrics_time(&s->metrics, method_index(t->request.method), seconds);
        t->client->done(t->client->user, t, a);
    } else {
        metrics_gone(&s->metrics);
    }
    s->held_bytes -= t->request.held_bytes;
    answer_destroy(a);
    request_destroy(&t->request);
    free(t);
}

static void end_failed(server *s, ticket *t, answer_kind kind, const char *sentence)
{
    answer a = {0};
    answer_fail(&a, kind, "%s", sentence);
    end(s, t, &a);
}

void server_cancel(server *s, ticket *t)
{
    t->is_cancelled = true; /* one that waits ends in the next turn: never within a call of its client */
    job_pool_cancel(s->pool, t);
}

void server_drop(server *s, ticket *t)
{
    t->client = NULL;
    server_cancel(s, t);
}

void server_stop(server *s)
{
    s->is_stopping = true;
}

bool server_is_stopping(const server *s)
{
    return s->is_stopping;
}

void server_cancel_all(server *s)
{
    for (ticket *t = s->running; t; t = t->next)
        server_cancel(s, t);
    for (ticket *t = s->queue; t; t = t->next)
        server_cancel(s, t);
}

/* ---- turns ---- */

/* Ends requests in the queue that are cancelled, or all if the server stops. */
static void clean_queue(server *s)
{
    for (ticket *t = s->queue, *next; t; t = next) {
        next = t->next;
        if (!t->is_cancelled && !s->is_stopping)
            continue;
        take_out(&s->queue, t);
        s->queue_depth--;
        if (t->is_cancelled)
            end_failed(s, t, ANSWER_CANCELLED, "the request was cancelled");
        else
            end_failed(s, t, ANSWER_STOPPING, "the server is stopping");
        next = s->queue; /* the client may have cancelled others */
    }
}

/* The first request whose client reads its answers; NULL: none. */
static ticket *next_in_queue(const server *s)
{
    for (ticket *t = s->queue; t; t = t->next)
        if (!t->client || !t->client->is_congested || !t->client->is_congested(t->client->user))
            return t;
    return NULL;
}

/* Threads of a job: all of them for a single request, a share when there are more. */
static uint32_t share_of_threads(const server *s)
{
    unsigned others = job_pool_running(s->pool) + (unsigned)s->queue_depth;
    unsigned jobs = others < s->settings.worker_count ? others : s->settings.worker_count;
    uint32_t threads = s->settings.limits.max_threads / (jobs ? jobs : 1);
    return threads ? threads : 1;
}

static void start_jobs(server *s)
{
    ticket *t;
    while (job_pool_has_slot(s->pool) && (t = next_in_queue(s))) {
        facet_error error;
        job_request work = request_job(&t->request, &s->settings.limits, share_of_threads(s));
        work.user = t;
        take_out(&s->queue, t);
        s->queue_depth--;
        if (job_pool_start(s->pool, &work, &error) != FACET_OK)
            end_failed(s, t, ANSWER_ENVIRONMENT, error.message);
        else
            append(&s->running, t);
    }
}

static void finish(server *s, job_result *result)
{
    answer a = {0};
    ticket *t = result->user;
    metrics_job(&s->metrics, result);
    take_out(&s->running, t);
    request_finish(&t->request, result, &a);
    if (t->is_cancelled && a.kind != ANSWER_DONE) {
        a.kind = ANSWER_DONE;
        answer_fail(&a, ANSWER_CANCELLED, "the request was cancelled");
    }
    end(s, t, &a);
    job_result_destroy(result);
}

void server_turn(server *s, poll_set *set)
{
    clean_queue(s);
    start_jobs(s);
    for (size_t i = 0; i < set->count; i++)
        set->entries[i].revents = 0;
    double left = set->moment - interrupt_clock();
    job_result result;
    while (job_pool_wait(s->pool, set->entries, set->count, left > 0.0 ? left : 0.0, &result)) {
        finish(s, &result);
        left = 0.0; /* others that have ended, and the descriptors as they are now */
    }
}
