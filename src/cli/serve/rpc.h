/* rpc.h - messages of JSON-RPC 2.0, one a line, as specified at jsonrpc.org (2013): reads what a client
 * sends, and writes responses. It knows nothing of connections and methods. */
#ifndef CLI_SERVE_RPC_H
#define CLI_SERVE_RPC_H

#include "base/text.h"

#include <jansson.h>

/* Codes of the specification. */
enum {
    RPC_PARSE_ERROR = -32700,
    RPC_INVALID_REQUEST = -32600,
    RPC_NO_METHOD = -32601,
    RPC_INVALID_PARAMS = -32602,
    RPC_INTERNAL = -32603
};

enum { RPC_MAX_CALLS = 1000 }; /* of one batch */

/* One call of a message. It is valid until rpc_message_destroy(). */
typedef struct rpc_call {
    json_t *id;         /* a string, a number or null; NULL: a notification, which is not answered */
    const char *method; /* NULL: not a call */
    json_t *params;     /* an object, or NULL: none */
    int error;          /* 0, or RPC_INVALID_REQUEST, .. with problem; answer it with id (or null) */
    const char *problem;
    bool is_response; /* the answer of a client to a call of the server, with its id */
} rpc_call;

typedef struct rpc_message {
    json_t *root;
    rpc_call *calls;
    size_t count;
    bool is_batch;
    char problem[256]; /* storage of the sentence of a parse error */
} rpc_message;

/* Reads a line of length bytes, which need not end with 0. A message that is not valid has one call with an error. False: no
 * memory. */
bool rpc_parse(const char *line, size_t length, rpc_message *out);
void rpc_message_destroy(rpc_message *message); /* {0} is allowed */

/* Appends a response, without a line end. id NULL: null. result and data are JSON text; data NULL: none. */
void rpc_add_result(text *t, const json_t *id, const char *result, size_t length);
void rpc_add_error(text *t, const json_t *id, int code, const char *message, const char *data);
/* Appends value as JSON text in one line. */
void rpc_add_json(text *t, const json_t *value);

#endif
