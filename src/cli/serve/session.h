/* session.h - a client that sends messages of JSON-RPC 2.0, one a line: its calls, batches, and the answers that
 * are due. What methods there are is up to a protocol. */
#ifndef CLI_SERVE_SESSION_H
#define CLI_SERVE_SESSION_H

#include "cli/serve/line_stream.h"
#include "cli/serve/server.h"

typedef struct session session;
typedef struct reply reply;

/* Each call ends with reply_result() or reply_error(), at once or after reply_submit() in finish(). */
typedef struct protocol {
    transport transport;
    void (*call)(reply *r, const char *method, const json_t *params /* NULL: none */);
    void (*finish)(reply *r, const answer *a);
} protocol;

extern const protocol rpc_protocol, mcp_protocol;

/* in, out: descriptors, which the caller closes. has_timeout: for clients that may be anybody. NULL: no memory. */
session *session_create(server *s, const protocol *p, int in, int out, bool has_timeout);
/* Drops its requests. NULL is allowed. */
void session_destroy(session *s);
void session_prepare(session *s, poll_set *set);
/* Reads, answers and writes. Returns whether the session goes on. */
bool session_handle(session *s, const poll_set *set);
bool session_has_output(const session *s);

/* ---- for protocols ---- */

server *reply_server(const reply *r);
bool reply_is_wanted(const reply *r); /* false for notifications */
/* The method of reply_submit(). */
const method *reply_method(const reply *r);
void reply_result(reply *r, const char *json, size_t length); /* r is invalid from then on */
void reply_error(reply *r, int code, const char *message, const char *data /* JSON, or NULL */);
void reply_discard(reply *r); /* no answer */
/* The error of an answer that is a failure, with exit code and sentence as data. */
void reply_failure(reply *r, const answer *a);
/* Submits a request for the call; a refusal goes to finish(). */
void reply_submit(reply *r, const method *m, const json_t *params);
/* Cancels the call with that id in the same session. Whether there is one. */
bool reply_cancel(const reply *r, const json_t *id);

#endif
