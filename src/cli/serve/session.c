/* session.c - see session.h. */
#include "cli/serve/session.h"

#include "cli/serve/rpc.h"
#include "cli/shared/interrupt.h"

#include <stdlib.h>
#include <string.h>

/* The answers of a batch, which go out together. */
typedef struct batch {
    text answers;
    size_t due;
} batch;

struct reply {
    reply *next;
    session *session;
    json_t *id;     /* NULL: a notification */
    batch *batch;   /* NULL: none */
    ticket *ticket; /* NULL: none yet */
    const method *method;
};

struct session {
    server *server;
    const protocol *protocol;
    line_stream stream;
    server_client client;
    reply *replies;
    bool has_timeout;
};

/* A client whose unread answers exceed the first gets no more jobs, and one whose unread answers exceed nothing
 * is read from. */
enum { CONGESTED_BYTES = 4 << 20, BASE64_OVERHEAD_BYTES = 1 << 16, SLOWEST_BYTES_PER_S = 1 << 16 };

static void on_done(void *user, ticket *t, const answer *a)
{
    session *s = user;
    for (reply *r = s->replies; r; r = r->next)
        if (r->ticket == t) {
            r->ticket = NULL;
            s->protocol->finish(r, a);
            return;
        }
}

static bool is_congested(void *user)
{
    const session *s = user;
    return line_stream_unsent(&s->stream) > CONGESTED_BYTES;
}

session *session_create(server *s, const protocol *p, int in, int out, bool has_timeout)
{
    session *made = calloc(1, sizeof *made);
    if (!made)
        return NULL;
    uint64_t body = server_settings_of(s)->limits.max_body_bytes;
    *made = (session){
        .server = s,
        .protocol = p,
        .stream = {.in = in, .out = out, .max_line = (size_t)(body / 3 * 4) + BASE64_OVERHEAD_BYTES},
        .client = {on_done, made, is_congested, p->transport},
        .has_timeout = has_timeout};
    return made;
}

/* ---- replies ---- */

static void send_line(session *s, text *line)
{
    if (line->data && !line->has_failed)
        line_stream_send(&s->stream, line->data, line->length);
    text_destroy(line);
}

/* Counts an answer of a batch, and sends the batch after the last. */
static void end_in_batch(session *s, batch *b)
{
    if (--b->due)
        return;
    if (b->answers.length) {
        text_add(&b->answers, "]");
        send_line(s, &b->answers);
    }
    text_destroy(&b->answers);
    free(b);
}

/* Where the answer of a reply is written. */
static text *begin_answer(reply *r, text *single)
{
    if (!r->batch)
        return single;
    text_add(&r->batch->answers, r->batch->answers.length ? "," : "[");
    return &r->batch->answers;
}

static void end_reply(reply *r, text *single)
{
    session *s = r->session;
    if (r->batch)
        end_in_batch(s, r->batch);
    else
        send_line(s, single);
    for (reply **at = &s->replies; *at; at = &(*at)->next)
        if (*at == r) {
            *at = r->next;
            break;
        }
    json_decref(r->id);
    free(r);
}

void reply_result(reply *r, const char *json, size_t length)
{
    text single = {0};
    if (r->id)
        rpc_add_result(begin_answer(r, &single), r->id, json, length);
    end_reply(r, &single);
}

void reply_error(reply *r, int code, const char *message, const char *data)
{
    text single = {0};
    if (r->id)
        rpc_add_error(begin_answer(r, &single), r->id, code, message, data);
    end_reply(r, &single);
}

void reply_failure(reply *r, const answer *a)
{
    text data = {0};
    text_json_begin_object(&data, NULL);
    text_json_integer(&data, "exit_code", a->exit_code);
    text_json_string(&data, "message", a->message);
    text_json_string(&data, "reason", answer_codes[a->kind].word);
    text_json_end_object(&data);
    reply_error(r, answer_codes[a->kind].rpc_code, a->message, data.data);
    text_destroy(&data);
}

void reply_discard(reply *r)
{
    json_decref(r->id);
    r->id = NULL;
    text single = {0};
    end_reply(r, &single);
}

server *reply_server(const reply *r)
{
    return r->session->server;
}

bool reply_is_wanted(const reply *r)
{
    return r->id != NULL;
}

const method *reply_method(const reply *r)
{
    return r->method;
}

void reply_submit(reply *r, const method *m, const json_t *params)
{
    session *s = r->session;
    answer refusal = {0};
    r->method = m;
    r->ticket = server_submit(s->server, m, params, (request_body){0}, &s->client, &refusal);
    if (!r->ticket)
        s->protocol->finish(r, &refusal);
}

bool reply_cancel(const reply *r, const json_t *id)
{
    for (reply *other = r->session->replies; other; other = other->next)
        if (other != r && other->ticket && other->id && json_equal(other->id, id)) {
            server_cancel(r->session->server, other->ticket);
            return true;
        }
    return false;
}

/* ---- messages ---- */

static void handle_call(session *s, const rpc_call *call, batch *b)
{
    reply *r = calloc(1, sizeof *r);
    if (!r) {
        if (b)
            end_in_batch(s, b);
        return;
    }
    *r = (reply){.next = s->replies, .session = s, .id = json_incref(call->id), .batch = b};
    s->replies = r;
    if (call->error && !r->id)
        r->id = json_null(); /* errors of the message are always answered */
    if (call->error)
        reply_error(r, call->error, call->problem, "{\"exit_code\":2}");
    else if (call->is_response) /* this server calls no method of its clients */
        reply_discard(r);
    else
        s->protocol->call(r, call->method, call->params);
}

static void handle_line(session *s, const char *line, size_t length)
{
    rpc_message message;
    if (strspn(line, " \t\r\n") >= length || !rpc_parse(line, length, &message))
        return;
    batch *b = message.is_batch ? calloc(1, sizeof *b) : NULL;
    if (b)
        b->due = message.count;
    for (size_t i = 0; i < message.count && (b || !message.is_batch); i++)
        handle_call(s, &message.calls[i], b);
    rpc_message_destroy(&message);
}

static void refuse_line(session *s)
{
    text line = {0};
    rpc_add_error(&line, NULL, RPC_PARSE_ERROR, "the message is longer than the server accepts (--max-body)",
                  "{\"exit_code\":7}");
    send_line(s, &line);
}

/* Handles the lines that have come, as long as the client reads the answers. */
static void handle_lines(session *s)
{
    const char *line;
    size_t length;
    line_event event = LINE_NONE;
    while (!is_congested(s) && (event = line_stream_next(&s->stream, &line, &length)) != LINE_NONE)
        if (event == LINE_READY)
            handle_line(s, line, length);
        else
            refuse_line(s);
}

/* When the client will have had time enough for the rest of a line, or to read; a very large number: nothing is due. */
static double moment_of_patience(const session *s)
{
    const line_stream *l = &s->stream;
    double timeout = server_settings_of(s->server)->client_timeout_s, moment = 1e300;
    if (s->has_timeout && l->waits_in > 0.0)
        moment = l->waits_in + timeout + (double)(l->end - l->start) / SLOWEST_BYTES_PER_S;
    if (s->has_timeout && l->waits_out > 0.0 && l->waits_out + timeout < moment)
        moment = l->waits_out + timeout;
    return moment;
}

void session_prepare(session *s, poll_set *set)
{
    bool reads = !is_congested(s);
    if (!reads && s->stream.waits_in > 0.0)
        s->stream.waits_in = interrupt_clock(); /* the line is not awaited */
    line_stream_prepare(&s->stream, set, reads);
    poll_set_until(set, moment_of_patience(s));
}

bool session_handle(session *s, const poll_set *set)
{
    line_stream_handle(&s->stream, set);
    handle_lines(s);
    bool is_done = s->stream.has_ended && s->stream.start == s->stream.end && !s->replies &&
                   !line_stream_unsent(&s->stream);
    return !is_done && !s->stream.is_broken && interrupt_clock() <= moment_of_patience(s);
}

bool session_has_output(const session *s)
{
    return line_stream_unsent(&s->stream) > 0;
}

void session_destroy(session *s)
{
    if (!s)
        return;
    while (s->replies) {
        reply *r = s->replies;
        s->replies = r->next;
        if (r->ticket)
            server_drop(s->server, r->ticket);
        if (r->batch && --r->batch->due == 0) {
            text_destroy(&r->batch->answers);
            free(r->batch);
        }
        json_decref(r->id);
        free(r);
    }
    line_stream_destroy(&s->stream);
    free(s);
}
