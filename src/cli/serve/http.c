/* http.c - see http.h. libmicrohttpd reads and writes; it has no thread of its own, but runs in the turns of the
 * server's loop. A request that waits for its job is suspended. */
#define _GNU_SOURCE
#include "cli/serve/http.h"

#include "cli/serve/http_answer.h"
#include "cli/shared/interrupt.h"

#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <unistd.h>

/* The slowest client that is waited for, the most connections, bodies (of the largest size) that may be on their way in, and
 * answers on their way out, beyond which no job starts. */
enum { SLOWEST_BYTES_PER_S = 1 << 16, MAX_CONNECTIONS = 128, MAX_BODIES = 8, MAX_UNSENT_BYTES = 512 << 20 };

/* One request of a connection. */
typedef struct exchange {
    http *http;
    struct connection *connection;
    struct MHD_Connection *mhd;
    http_page page;
    json_t *params;
    request_body body;
    size_t body_capacity;
    char *etag; /* of If-None-Match; NULL: none */
    bool is_get, has_begun, is_suspended;
    ticket *ticket;
    server_client client;
    http_response response; /* once it is known */
    size_t unsent_bytes;    /* of the response, counted in http */
} exchange;

/* A connection of a client, which may carry several requests in turn. */
typedef struct connection {
    struct connection *next;
    int fd;
    double deadline; /* interrupt_clock() until which its part must be done; 0: none, a job runs */
    exchange *exchange;
    long entry; /* of the poll_set, while a job runs */
} connection;

struct http {
    server *server;
    http_library library;
    struct MHD_Daemon *daemon;
    connection *connections;
    uint64_t body_bytes, unsent_bytes; /* of all exchanges */
    uint64_t closed_count;             /* connections that have ended */
    int epoll;
    bool is_local; /* reached by this machine only */
    long entry;
};

static double timeout_of(const http *h)
{
    return server_settings_of(h->server)->client_timeout_s;
}

/* Gives the client of a connection time for so many bytes. */
static void allow_time(const http *h, connection *c, size_t bytes)
{
    c->deadline = interrupt_clock() + timeout_of(h) + (double)bytes / SLOWEST_BYTES_PER_S;
}

/* ---- requests ---- */

static void set_failure(exchange *e, answer_kind kind, const char *sentence)
{
    answer a = {0};
    answer_fail(&a, kind, "%s", sentence);
    if (e->page.method && kind != ANSWER_STOPPING)
        metrics_count(server_metrics(e->http->server), TRANSPORT_HTTP, method_index(e->page.method), kind);
    e->response = http_answer(&e->http->library, &a, NULL, e->is_get);
}

static void on_done(void *user, ticket *t, const answer *a)
{
    exchange *e = user;
    (void)t;
    e->ticket = NULL;
    e->response = http_answer(&e->http->library, a, e->etag, e->is_get);
    e->unsent_bytes = a->file_count ? a->files[0].size : 0;
    e->http->unsent_bytes += e->unsent_bytes;
    e->is_suspended = false;
    e->http->library.resume_connection(e->mhd);
}

/* Whether clients do not read the answers that are there. */
static bool is_congested(void *user)
{
    const exchange *e = user;
    return e->http->unsent_bytes > MAX_UNSENT_BYTES;
}

/* The header of a request; NULL: not given. */
static const char *header(const exchange *e, const char *name)
{
    return e->http->library.lookup_connection_value(e->mhd, MHD_HEADER_KIND, name);
}

/* Whether the size that a body states exceeds the limit. */
static bool is_too_large(const exchange *e, size_t size)
{
    return size > server_settings_of(e->http->server)->limits.max_body_bytes;
}

/* Checks the headers of a request with a body. */
static bool check_body(exchange *e, answer *refusal)
{
    const char *length = header(e, MHD_HTTP_HEADER_CONTENT_LENGTH);
    if (e->page.method->inputs[1])
        return answer_fail(refusal, ANSWER_WRONG_VERB, "%s takes GET with two paths",
                           e->page.method->verb->name);
    if (!http_type_is_model(header(e, MHD_HTTP_HEADER_CONTENT_TYPE)))
        return answer_fail(refusal, ANSWER_UNSUPPORTED,
                           "the body must be the %s itself, as by curl --data-binary @FILE, not a form",
                           e->page.method->inputs[0]);
    if (length && is_too_large(e, strtoull(length, NULL, 10)))
        return answer_fail(refusal, ANSWER_TOO_LARGE,
                           "the body is larger than the limit of %.6g MiB (--max-body)",
                           (double)server_settings_of(e->http->server)->limits.max_body_bytes / 1048576.0);
    return true;
}

/* Whether a web page of another site makes the request, as browsers say: those send requests to this machine, too. */
static bool is_of_another_site(const exchange *e)
{
    const char *origin = header(e, MHD_HTTP_HEADER_ORIGIN), *site = header(e, "Sec-Fetch-Site"),
               *page = header(e, MHD_HTTP_HEADER_REFERER);
    if (origin)
        return !http_page_is_local(origin);
    return site && strcmp(site, "cross-site") == 0 && !(page && http_page_is_local(page));
}

/* Checks what is known from the head of a request. */
static bool check_head(exchange *e, const char *url, const char *action, answer *refusal)
{
    const char *host = header(e, MHD_HTTP_HEADER_HOST), *etag = header(e, MHD_HTTP_HEADER_IF_NONE_MATCH);
    bool is_post = strcmp(action, MHD_HTTP_METHOD_POST) == 0;
    e->is_get = strcmp(action, MHD_HTTP_METHOD_GET) == 0;
    e->page = http_page_find(url);
    e->etag = etag ? strdup(etag) : NULL;
    if (e->http->is_local && host && !http_host_is_local(host))
        return answer_fail(refusal, ANSWER_FORBIDDEN,
                           "this server answers for localhost only, not for %.100s", host);
    if (e->http->is_local && is_of_another_site(e))
        return answer_fail(refusal, ANSWER_FORBIDDEN,
                           "this server does not answer web pages of other sites than localhost");
    if (e->page.kind == HTTP_PAGE_NONE)
        return answer_fail(refusal, ANSWER_NO_METHOD, "there is no page %.200s; / lists them", url);
    if (!e->page.method)
        return e->is_get || strcmp(action, MHD_HTTP_METHOD_HEAD) == 0 ||
               answer_fail(refusal, ANSWER_WRONG_VERB, "%.200s takes GET", url);
    if (!e->is_get && !is_post)
        return answer_fail(refusal, ANSWER_WRONG_VERB, "%.200s takes GET and POST", url);
    if (server_is_busy(e->http->server, refusal) || (is_post && !check_body(e, refusal)))
        return false;
    e->params = http_read_query(&e->http->library, e->mhd, e->page.method, refusal);
    return e->params != NULL;
}

/* The body is complete, or not wanted any more. */
static void forget_body(exchange *e)
{
    e->http->body_bytes -= e->body.size;
    e->body = (request_body){0};
}

/* Keeps a part of the body. */
static void add_body(exchange *e, const char *bytes, size_t size)
{
    const uint64_t most = server_settings_of(e->http->server)->limits.max_body_bytes * MAX_BODIES;
    if (e->response.response)
        return;
    if (e->http->body_bytes + size > most) {
        set_failure(e, ANSWER_BUSY, "the server is busy: other models are on their way; try again");
        return;
    }
    if (is_too_large(e, e->body.size + size)) {
        set_failure(e, ANSWER_TOO_LARGE, "the body is larger than the limit (--max-body)");
        return;
    }
    if (e->body.size + size > e->body_capacity) {
        size_t capacity = 2 * (e->body.size + size);
        unsigned char *grown = realloc(e->body.bytes, capacity);
        if (!grown) {
            set_failure(e, ANSWER_BUSY, "the server is out of memory; try again");
            return;
        }
        e->body.bytes = grown;
        e->body_capacity = capacity;
    }
    memcpy(e->body.bytes + e->body.size, bytes, size);
    e->body.size += size;
    e->http->body_bytes += size;
    e->connection->deadline += (double)size / SLOWEST_BYTES_PER_S;
}

/* Submits the request, whose body is complete, and suspends it unless it was refused. */
static void submit(exchange *e)
{
    answer refusal = {0};
    request_body body = e->body;
    if (!e->is_get && !body.bytes) {
        set_failure(e, ANSWER_USAGE, "the body is empty; POST takes the model as body");
        return;
    }
    forget_body(e);
    e->client = (server_client){on_done, e, is_congested, TRANSPORT_HTTP};
    e->ticket = server_submit(e->http->server, e->page.method, e->params, body, &e->client, &refusal);
    if (!e->ticket) {
        e->response = http_answer(&e->http->library, &refusal, NULL, e->is_get);
        return;
    }
    e->connection->deadline = 0.0;
    e->is_suspended = true;
    e->http->library.suspend_connection(e->mhd);
}

static void open_page(exchange *e)
{
    const server *s = e->http->server;
    text body = {0};
    if (e->page.kind == HTTP_PAGE_HEALTH) {
        server_describe(s, &body);
        text_add(&body, "\n");
        e->response =
            http_text(&e->http->library, "application/json", &body, server_is_stopping(s) ? 503 : 200);
    } else if (e->page.kind == HTTP_PAGE_METRICS) {
        unsigned clients = 0;
        for (const connection *c = e->http->connections; c; c = c->next)
            clients++;
        const metrics_now now = {server_queue_depth(s), server_settings_of(s)->queue_limit, server_running(s),
                                 server_settings_of(s)->worker_count, clients};
        metrics_print(server_metrics(e->http->server), &now, &body);
        e->response = http_text(&e->http->library, "text/plain; version=0.0.4; charset=utf-8", &body, 200);
    } else {
        e->response = http_index(&e->http->library);
    }
    text_destroy(&body);
}

static enum MHD_Result send_response(exchange *e)
{
    struct MHD_Response *response = e->response.response;
    const http_library *l = &e->http->library;
    if (!response)
        return MHD_NO; /* no memory: the connection ends */
    allow_time(e->http, e->connection, 64u << 20);
    if (e->response.status == MHD_HTTP_METHOD_NOT_ALLOWED)
        l->add_response_header(response, MHD_HTTP_HEADER_ALLOW,
                               e->page.method && !e->page.method->inputs[1] ? "GET, POST" : "GET");
    if (server_is_stopping(e->http->server))
        l->add_response_header(response, MHD_HTTP_HEADER_CONNECTION, "close");
    enum MHD_Result is_queued = l->queue_response(e->mhd, e->response.status, response);
    l->destroy_response(response);
    e->response.response = NULL;
    return is_queued;
}

/* ---- what libmicrohttpd calls ---- */

static connection *connection_of(const http *h, struct MHD_Connection *mhd)
{
    const union MHD_ConnectionInfo *info =
        h->library.get_connection_info(mhd, MHD_CONNECTION_INFO_SOCKET_CONTEXT);
    return info ? info->socket_context : NULL;
}

/* Begins a request; a refusal is answered before its body has come. */
static enum MHD_Result begin(http *h, struct MHD_Connection *mhd, const char *url, const char *action,
                             void **context)
{
    exchange *e = calloc(1, sizeof *e);
    answer refusal = {0};
    if (!e)
        return MHD_NO;
    *context = e;
    e->http = h;
    e->mhd = mhd;
    e->connection = connection_of(h, mhd);
    if (!e->connection)
        return MHD_NO;
    e->connection->exchange = e;
    allow_time(h, e->connection, 0);
    if (check_head(e, url, action, &refusal))
        return MHD_YES;
    set_failure(e, refusal.kind, refusal.message);
    return send_response(e);
}

static enum MHD_Result on_request(void *user, struct MHD_Connection *mhd, const char *url, const char *action,
                                  const char *version, const char *data, size_t *size, void **context)
{
    exchange *e = *context;
    (void)version;
    if (!e)
        return begin(user, mhd, url, action, context);
    if (*size) {
        add_body(e, data, *size);
        *size = 0;
        return MHD_YES;
    }
    if (!e->response.response && !e->page.method)
        open_page(e);
    else if (!e->response.response)
        submit(e);
    return e->is_suspended ? MHD_YES : send_response(e);
}

static void on_completed(void *user, struct MHD_Connection *mhd, void **context,
                         enum MHD_RequestTerminationCode code)
{
    exchange *e = *context;
    http *h = user;
    (void)mhd;
    (void)code;
    if (!e)
        return;
    if (e->ticket)
        server_drop(h->server, e->ticket);
    if (e->connection) {
        e->connection->exchange = NULL;
        allow_time(h, e->connection, 0);
    }
    if (e->response.response)
        h->library.destroy_response(e->response.response);
    h->unsent_bytes -= e->unsent_bytes;
    json_decref(e->params);
    free(e->body.bytes);
    forget_body(e);
    free(e->etag);
    free(e);
    *context = NULL;
}

static void on_connection(void *user, struct MHD_Connection *mhd, void **context,
                          enum MHD_ConnectionNotificationCode code)
{
    http *h = user;
    connection *c = *context;
    if (code == MHD_CONNECTION_NOTIFY_STARTED) {
        const union MHD_ConnectionInfo *info =
            h->library.get_connection_info(mhd, MHD_CONNECTION_INFO_CONNECTION_FD);
        c = calloc(1, sizeof *c);
        if (!c || !info) {
            free(c);
            return;
        }
        *c = (connection){.next = h->connections, .fd = info->connect_fd, .entry = POLL_SET_NONE};
        allow_time(h, c, 0);
        h->connections = c;
        *context = c;
        return;
    }
    h->closed_count++;
    for (connection **at = &h->connections; *at; at = &(*at)->next)
        if (*at == c) {
            *at = c->next;
            free(c);
            break;
        }
    *context = NULL;
}

static void ignore_log(void *user, const char *format, va_list arguments)
{
    (void)user;
    (void)format;
    (void)arguments;
}

/* ---- the loop ---- */

facet_result http_create(server *s, const http_address *address, http **out, facet_error *error)
{
    http *h = calloc(1, sizeof *h);
    if (!h)
        return fail_memory(error, "a server", 0);
    *h = (http){.server = s, .is_local = address->is_loopback, .epoll = -1};
    facet_result result = http_library_open(&h->library, error);
    if (result != FACET_OK) {
        free(h);
        return result;
    }
    h->daemon = h->library.start_daemon(
        MHD_USE_EPOLL | MHD_ALLOW_SUSPEND_RESUME | MHD_USE_ERROR_LOG, 0, NULL, NULL, on_request, h,
        MHD_OPTION_EXTERNAL_LOGGER, ignore_log, NULL, MHD_OPTION_LISTEN_SOCKET, address->fd,
        MHD_OPTION_NOTIFY_COMPLETED, on_completed, h, MHD_OPTION_NOTIFY_CONNECTION, on_connection, h,
        MHD_OPTION_CONNECTION_LIMIT, (unsigned)MAX_CONNECTIONS, MHD_OPTION_CONNECTION_TIMEOUT,
        (unsigned)timeout_of(h) + 1, MHD_OPTION_END);
    const union MHD_DaemonInfo *info =
        h->daemon ? h->library.get_daemon_info(h->daemon, MHD_DAEMON_INFO_EPOLL_FD) : NULL;
    if (!info) {
        if (h->daemon)
            h->library.stop_daemon(h->daemon);
        http_library_close(&h->library);
        free(h);
        return fail(error, FACET_ERROR_SYSTEM, "--http: libmicrohttpd cannot serve at %s", address->name);
    }
    h->epoll = info->epoll_fd;
    *out = h;
    return FACET_OK;
}

void http_prepare(http *h, poll_set *set)
{
    MHD_UNSIGNED_LONG_LONG milliseconds;
    h->entry = poll_set_add(set, h->epoll, POLLIN);
    if (h->library.get_timeout(h->daemon, &milliseconds) == MHD_YES)
        poll_set_until(set, interrupt_clock() + 1e-3 * (double)milliseconds);
    for (connection *c = h->connections; c; c = c->next) {
        c->entry =
            c->exchange && c->exchange->is_suspended ? poll_set_add(set, c->fd, POLLRDHUP) : POLL_SET_NONE;
        if (c->deadline > 0.0)
            poll_set_until(set, c->deadline);
    }
}

/* Ends the requests of clients that have gone, and connections of those that are too slow. */
static void check_clients(http *h, const poll_set *set)
{
    double now = interrupt_clock();
    for (connection *c = h->connections; c; c = c->next) {
        exchange *e = c->exchange;
        if (e && e->is_suspended && poll_set_events(set, c->entry) && e->ticket) {
            server_drop(h->server, e->ticket);
            e->ticket = NULL;
            set_failure(e, ANSWER_CANCELLED, "the client has gone");
            e->is_suspended = false;
            e->http->library.resume_connection(e->mhd);
        } else if (c->deadline > 0.0 && now > c->deadline) {
            shutdown(c->fd, SHUT_RDWR); /* libmicrohttpd sees the end, and cleans up */
            c->deadline = 0.0;
        }
        c->entry = POLL_SET_NONE;
    }
}

void http_handle(http *h, const poll_set *set)
{
    uint64_t before;
    check_clients(h, set);
    do { /* at MAX_CONNECTIONS it stops listening, and listens again in the turn after one has ended */
        before = h->closed_count;
        h->library.run(h->daemon);
    } while (h->closed_count != before);
}

void http_stop(http *h)
{
    int listener = h->library.quiesce_daemon(h->daemon);
    if (listener >= 0)
        close(listener);
}

bool http_has_output(const http *h)
{
    for (const connection *c = h->connections; c; c = c->next)
        if (c->exchange)
            return true;
    return false;
}

void http_destroy(http *h)
{
    if (!h)
        return;
    for (connection *c = h->connections; c; c = c->next)
        if (c->exchange && c->exchange->is_suspended) {
            c->exchange->ticket = NULL;
            c->exchange->is_suspended = false;
            h->library.resume_connection(c->exchange->mhd);
        }
    h->library.stop_daemon(h->daemon);
    http_library_close(&h->library);
    free(h);
}
