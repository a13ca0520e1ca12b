/* rpc.c - see rpc.h. */
#include "cli/serve/rpc.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---- reading ---- */

static void set_error(rpc_call *call, int code, const char *problem)
{
    call->method = NULL;
    call->error = code;
    call->problem = problem;
}

static bool is_version_2(const json_t *object)
{
    const char *version = json_string_value(json_object_get(object, "jsonrpc"));
    return version && strcmp(version, "2.0") == 0;
}

/* Reads the method and the parameters of a call whose id is known. */
static void read_call(const json_t *object, rpc_call *call)
{
    json_t *params = json_object_get(object, "params");
    call->method = json_string_value(json_object_get(object, "method"));
    if (!is_version_2(object))
        set_error(call, RPC_INVALID_REQUEST, "jsonrpc: it must be \"2.0\"");
    else if (!call->method)
        set_error(call, RPC_INVALID_REQUEST, "method: it must be text");
    else if (params && !json_is_object(params))
        set_error(call, RPC_INVALID_PARAMS,
                  "params: they must be an object, whose members are the parameters");
    else
        call->params = params;
}

static void read_object(json_t *object, rpc_call *call)
{
    *call = (rpc_call){0};
    if (!json_is_object(object)) {
        set_error(call, RPC_INVALID_REQUEST, "it must be an object with jsonrpc, method, params and id");
        return;
    }
    json_t *id = json_object_get(object, "id");
    if (id && !json_is_string(id) && !json_is_number(id) && !json_is_null(id)) {
        set_error(call, RPC_INVALID_REQUEST, "id: it must be text or a number");
        return;
    }
    call->id = id;
    call->is_response = id && !json_object_get(object, "method") &&
                        (json_object_get(object, "result") || json_object_get(object, "error"));
    if (!call->is_response)
        read_call(object, call);
}

/* Makes the message one call with an error. */
static void refuse_whole(rpc_message *out, int code, const char *problem)
{
    out->is_batch = false;
    out->count = 1;
    out->calls[0] = (rpc_call){0};
    set_error(&out->calls[0], code, problem);
}

/* Room for the calls of the message. */
static bool allocate_calls(rpc_message *out)
{
    out->is_batch = json_is_array(out->root);
    size_t size = out->is_batch ? json_array_size(out->root) : 1;
    out->count = size > RPC_MAX_CALLS ? 0 : size;
    out->calls = calloc(out->count ? out->count : 1, sizeof *out->calls);
    return out->calls != NULL;
}

bool rpc_parse(const char *line, size_t length, rpc_message *out)
{
    json_error_t problem;
    *out = (rpc_message){0};
    out->root = json_loadb(line, length, JSON_REJECT_DUPLICATES, &problem);
    if (!allocate_calls(out)) {
        rpc_message_destroy(out);
        return false;
    }
    if (!out->root) {
        snprintf(out->problem, sizeof out->problem, "it is not JSON: column %d: %.160s", problem.column,
                 problem.text);
        refuse_whole(out, RPC_PARSE_ERROR, out->problem);
    } else if (!out->is_batch) {
        read_object(out->root, &out->calls[0]);
    } else if (!out->count) {
        refuse_whole(out, RPC_INVALID_REQUEST,
                     json_array_size(out->root) ? "a batch has at most 1000 calls" : "the batch is empty");
    } else {
        for (size_t i = 0; i < out->count; i++)
            read_object(json_array_get(out->root, i), &out->calls[i]);
    }
    return true;
}

void rpc_message_destroy(rpc_message *message)
{
    json_decref(message->root);
    free(message->calls);
    *message = (rpc_message){0};
}

/* ---- writing ---- */

static int append(const char *bytes, size_t size, void *user)
{
    text_add_bytes(user, bytes, size);
    return 0;
}

void rpc_add_json(text *t, const json_t *value)
{
    if (!value ||
        json_dump_callback(value, append, t, JSON_COMPACT | JSON_ENCODE_ANY | JSON_REAL_PRECISION(9)) != 0)
        text_add(t, "null");
}

static void begin_response(text *t, const json_t *id)
{
    text_add(t, "{\"jsonrpc\":\"2.0\",\"id\":");
    rpc_add_json(t, id);
}

void rpc_add_result(text *t, const json_t *id, const char *result, size_t length)
{
    begin_response(t, id);
    text_add(t, ",\"result\":");
    text_add_bytes(t, result, length);
    text_add(t, "}");
}

void rpc_add_error(text *t, const json_t *id, int code, const char *message, const char *data)
{
    begin_response(t, id);
    text_addf(t, ",\"error\":{\"code\":%d,", code);
    t->needs_comma = false;
    text_json_string(t, "message", message);
    if (data)
        text_json_raw(t, "data", data);
    text_add(t, "}}");
}
