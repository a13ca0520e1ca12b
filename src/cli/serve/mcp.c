/* mcp.c - the Model Context Protocol over standard input and output (modelcontextprotocol.io), as a server
 * with tools: what an agent gets of a render is the image itself. */
#include "cli/serve/session.h"

#include "cli/serve/mcp_tools.h"
#include "cli/serve/rpc.h"

#include <stdlib.h>
#include <string.h>

/* Versions of the protocol that this server speaks, the latest first. */
static const char *const versions[] = {"2025-06-18", "2025-03-26", "2024-11-05"};

static void send_text(reply *r, text *out)
{
    if (out->has_failed || !out->data)
        reply_error(r, RPC_INTERNAL, "out of memory", NULL);
    else
        reply_result(r, out->data, out->length);
    text_destroy(out);
}

static void initialize(reply *r, const json_t *params)
{
    const char *wanted = json_string_value(json_object_get(params, "protocolVersion"));
    const char *version = versions[0];
    for (size_t i = 0; wanted && i < sizeof versions / sizeof *versions; i++)
        if (strcmp(wanted, versions[i]) == 0)
            version = versions[i];
    text out = {0};
    text_json_begin_object(&out, NULL);
    text_json_string(&out, "protocolVersion", version);
    text_json_raw(&out, "capabilities", "{\"tools\":{}}");
    text_json_begin_object(&out, "serverInfo");
    text_json_string(&out, "name", "facet");
    text_json_string(&out, "title", "facet, a renderer of 3D models");
    text_json_string(&out, "version", facet_version());
    text_json_end_object(&out);
    text_json_string(
        &out, "instructions",
        "Paths are relative to the folder that the server was started for, and cannot leave it. Look at a "
        "model with render (a PNG image) and inspect (JSON); the tool options lists further arguments.");
    text_json_end_object(&out);
    send_text(r, &out);
}

/* ---- results of tools ---- */

static void begin_result(text *out)
{
    text_json_begin_object(out, NULL);
    text_json_begin_array(out, "content");
}

static void end_result(text *out, bool is_error)
{
    text_json_end_array(out);
    text_json_bool(out, "isError", is_error);
    text_json_end_object(out);
}

static void add_text(text *out, const char *sentence)
{
    text_json_begin_object(out, NULL);
    text_json_string(out, "type", "text");
    text_json_string(out, "text", sentence);
    text_json_end_object(out);
}

static void add_image(text *out, const answer_file *file)
{
    text_json_begin_object(out, NULL);
    text_json_string(out, "type", "image");
    text_json_raw(out, "data", "\"");
    text_add_base64(out, file->bytes, file->size);
    text_add(out, "\"");
    text_json_string(out, "mimeType", media_type_of(file->name));
    text_json_end_object(out);
}

/* A failure that the agent can read and correct, which is a result and no error of the protocol. */
static void fail_tool(reply *r, const char *sentence)
{
    text out = {0};
    begin_result(&out);
    add_text(&out, sentence);
    end_result(&out, true);
    send_text(r, &out);
}

static void finish(reply *r, const answer *a)
{
    if (a->kind == ANSWER_CANCELLED) { /* by notifications/cancelled, which wants no answer */
        reply_discard(r);
        return;
    }
    if (a->kind != ANSWER_DONE) {
        fail_tool(r, a->message);
        return;
    }
    text out = {0}, report = {0};
    begin_result(&out);
    for (size_t i = 0; i < a->file_count; i++)
        if (strncmp(media_type_of(a->files[i].name), "image/", 6) == 0)
            add_image(&out, &a->files[i]);
    rpc_add_json(&report, a->report);
    add_text(&out, report.data);
    end_result(&out, false);
    text_destroy(&report);
    send_text(r, &out);
}

/* ---- calls of tools ---- */

/* Sets a default of an argument that is not there. */
static void set_default(json_t *arguments, const char *name, json_t *value)
{
    if (json_object_get(arguments, name))
        json_decref(value);
    else
        json_object_set_new(arguments, name, value);
}

/* What is wrong with the arguments of a tool; NULL: nothing that a request would not find. */
static const char *find_problem(const mcp_tool *tool, const json_t *arguments)
{
    const char *format = json_string_value(json_object_get(arguments, "format"));
    bool has_output = json_object_get(arguments, "output") != NULL;
    if (tool->method->verb == &convert_verb && !has_output)
        return "output: it is missing: the file to write";
    if (tool->method->verb == &render_verb && !has_output && format && strcmp(format, "png") != 0 &&
        strcmp(format, "jpg") != 0 && strcmp(format, "webp") != 0)
        return "format: without output the image is png, jpg or webp";
    return NULL;
}

static void call_method(reply *r, const mcp_tool *tool, const json_t *given)
{
    json_t *arguments = given ? json_copy((json_t *)(uintptr_t)given) : json_object();
    const char *problem = find_problem(tool, arguments);
    if (problem) {
        fail_tool(r, problem);
    } else {
        bool has_output = json_object_get(arguments, "output") != NULL;
        if (tool->method->verb == &render_verb && !has_output)
            set_default(arguments, "size", json_string(MCP_IMAGE_SIZE));
        if (tool->method->verb == &compare_verb && !has_output) {
            set_default(arguments, "format", json_string("png"));
            set_default(arguments, "heat-map", json_true());
        }
        reply_submit(r, tool->method, arguments);
    }
    json_decref(arguments);
}

static void call_options(reply *r, const json_t *arguments)
{
    const char *name = json_string_value(json_object_get(arguments, "tool"));
    text list = {0}, out = {0};
    if (!name || !mcp_tool_options(name, &list)) {
        text_destroy(&list);
        fail_tool(r, "tool: it must be render, inspect, compare or convert");
        return;
    }
    begin_result(&out);
    add_text(&out, list.data);
    end_result(&out, false);
    text_destroy(&list);
    send_text(r, &out);
}

static void call_tool(reply *r, const json_t *params)
{
    const char *name = json_string_value(json_object_get(params, "name"));
    const json_t *arguments = json_object_get(params, "arguments");
    const mcp_tool *tool = name ? mcp_tool_find(name) : NULL;
    if (!tool)
        reply_error(r, RPC_INVALID_PARAMS,
                    name ? "there is no such tool" : "name: the name of a tool is missing", NULL);
    else if (arguments && !json_is_object(arguments))
        reply_error(r, RPC_INVALID_PARAMS, "arguments: they must be an object", NULL);
    else if (!tool->method)
        call_options(r, arguments);
    else
        call_method(r, tool, arguments);
}

static void call(reply *r, const char *name, const json_t *params)
{
    if (strcmp(name, "initialize") == 0) {
        initialize(r, params);
    } else if (strcmp(name, "ping") == 0) {
        reply_result(r, "{}", 2);
    } else if (strcmp(name, "tools/list") == 0) {
        text out = {0};
        mcp_tools_list(&out);
        send_text(r, &out);
    } else if (strcmp(name, "tools/call") == 0) {
        call_tool(r, params);
    } else if (!reply_is_wanted(r)) {
        const json_t *id = json_object_get(params, "requestId");
        if (strcmp(name, "notifications/cancelled") == 0 && id)
            reply_cancel(r, id);
        reply_discard(r);
    } else {
        reply_error(r, RPC_NO_METHOD, "this server has tools/list, tools/call and ping", NULL);
    }
}

const protocol mcp_protocol = {TRANSPORT_MCP, call, finish};
