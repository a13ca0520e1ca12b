/* server.h - the requests of all clients: a queue, and a pool of jobs that takes from it. It knows nothing of
 * protocols: a client submits requests, and is called when one has ended. */
#ifndef CLI_SERVE_SERVER_H
#define CLI_SERVE_SERVER_H

#include "cli/jobs/job_pool.h"
#include "cli/serve/metrics.h"
#include "cli/serve/poll_set.h"
#include "cli/serve/request.h"
#include "cli/shared/messages.h"

typedef struct server server;
typedef struct ticket ticket;

/* Called once for each request that was taken, unless its client has dropped it; never within server_submit().
 * The answer is the server's, and the ticket is invalid from then on. */
typedef struct server_client {
    void (*done)(void *user, ticket *t, const answer *a);
    void *user;
    bool (*is_congested)(void *user); /* its requests wait, as it does not read its answers; NULL: never */
    transport transport;
} server_client;

typedef struct server_settings {
    request_limits limits;
    unsigned worker_count;
    size_t queue_limit;
    double client_timeout_s;  /* for a client that neither sends the rest of a message nor reads */
    const messages *messages; /* gets a line for each answer, at VERBOSITY_DETAILS */
} server_settings;

/* NULL: no memory. */
server *server_create(const server_settings *settings);
/* Kills the jobs that run; clients are not called. NULL is allowed. */
void server_destroy(server *s);

const server_settings *server_settings_of(const server *s);
metrics *server_metrics(server *s);
size_t server_queue_depth(const server *s);
unsigned server_running(const server *s);
/* Appends version, workers and load as a JSON object. */
void server_describe(const server *s, text *out);
bool server_is_busy(const server *s, answer *refusal); /* whether a request would be refused now, and why */

/* Queues a request; body as in request_create(), which takes it. client must live until the answer. NULL, with the
 * reason in *refusal: it was refused. */
ticket *server_submit(server *s, const method *m, const json_t *params, request_body body,
                      const server_client *client, answer *refusal);
/* Cancels a request; its answer follows, which may be the result if it is there already. */
void server_cancel(server *s, ticket *t);
/* The client has gone: cancels it without an answer. */
void server_drop(server *s, ticket *t);

/* Refuses further requests and those that wait; those that run go on. */
void server_stop(server *s);
bool server_is_stopping(const server *s);
/* Cancels what runs. */
void server_cancel_all(server *s);
/* Whether nothing runs or waits. */
bool server_is_idle(const server *s);

/* Starts jobs, waits for one of the descriptors of set, its moment or the end of a job, and passes answers on. */
void server_turn(server *s, poll_set *set);

#endif
