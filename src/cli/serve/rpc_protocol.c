/* rpc_protocol.c - the methods of facet over JSON-RPC: render, inspect, convert, compare and bake, whose
 * result is the object of --json with the files that were made, and cancel and status. */
#include "cli/serve/session.h"

#include "cli/serve/rpc.h"

#include <string.h>

/* ---- results ---- */

static void add_file(text *out, const answer_file *file)
{
    text_json_begin_object(out, NULL);
    text_json_string(out, "name", file->name);
    text_json_string(out, "media_type", media_type_of(file->name));
    text_json_integer(out, "bytes", (int64_t)file->size);
    text_json_raw(out, "base64", "\"");
    text_add_base64(out, file->bytes, file->size);
    text_add(out, "\"");
    text_json_end_object(out);
}

static void finish(reply *r, const answer *a)
{
    if (a->kind != ANSWER_DONE) {
        reply_failure(r, a);
        return;
    }
    text out = {0};
    if (a->report)
        rpc_add_json(&out, a->report);
    else
        text_add(&out, "{}");
    if (a->file_count && out.data) {
        out.length--; /* the closing brace */
        out.needs_comma = out.length > 1;
        text_json_begin_array(&out, "outputs");
        for (size_t i = 0; i < a->file_count; i++)
            add_file(&out, &a->files[i]);
        text_json_end_array(&out);
        text_add(&out, "}");
    }
    if (out.has_failed)
        reply_error(r, RPC_INTERNAL, "out of memory", "{\"exit_code\":7}");
    else
        reply_result(r, out.data, out.length);
    text_destroy(&out);
}

/* ---- methods ---- */

static void call_cancel(reply *r, const json_t *params)
{
    const json_t *id = json_object_get(params, "id");
    if (!id) {
        reply_error(r, RPC_INVALID_PARAMS, "cancel: id is missing: of the request to cancel",
                    "{\"exit_code\":2}");
        return;
    }
    const char *result = reply_cancel(r, id) ? "{\"cancelled\":true}" : "{\"cancelled\":false}";
    reply_result(r, result, strlen(result));
}

static void call_status(reply *r)
{
    text out = {0};
    server_describe(reply_server(r), &out);
    if (out.has_failed || !out.data)
        reply_error(r, RPC_INTERNAL, "out of memory", NULL);
    else
        reply_result(r, out.data, out.length);
    text_destroy(&out);
}

static void call(reply *r, const char *name, const json_t *params)
{
    const method *m = method_find(name);
    if (m) {
        reply_submit(r, m, params);
    } else if (strcmp(name, "cancel") == 0) {
        call_cancel(r, params);
    } else if (strcmp(name, "status") == 0) {
        call_status(r);
    } else {
        answer unknown = {0};
        answer_fail(&unknown, ANSWER_NO_METHOD,
                    "there is no method \"%.100s\"; the methods are render, inspect, convert, compare, bake, "
                    "cancel and status",
                    name);
        reply_failure(r, &unknown);
    }
}

const protocol rpc_protocol = {TRANSPORT_RPC, call, finish};
