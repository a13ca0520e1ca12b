/* http_answer.c - see http_answer.h. */
#include "cli/serve/http_answer.h"

#include "base/hash.h"
#include "cli/serve/rpc.h"

#include <stdio.h>
#include <string.h>
#include <strings.h>

http_page http_page_find(const char *url)
{
    static const struct {
        const char *path;
        http_page page;
    } pages[] = {{"", {NULL, HTTP_PAGE_INDEX}},
                 {"health", {NULL, HTTP_PAGE_HEALTH}},
                 {"metrics", {NULL, HTTP_PAGE_METRICS}}};
    const method *m = method_find(url + (url[0] == '/'));
    if (m)
        return (http_page){m, HTTP_PAGE_METHOD};
    for (size_t i = 0; i < sizeof pages / sizeof *pages; i++)
        if (strcmp(url + (url[0] == '/'), pages[i].path) == 0)
            return pages[i].page;
    return (http_page){NULL, HTTP_PAGE_NONE};
}

/* ---- the query ---- */

typedef struct query {
    const method *method;
    json_t *params;
    answer *refusal;
} query;

/* The value of a flag: "?denoise", "denoise=1", "denoise=true"; NULL: not given, wrong where *is_wrong is set. */
static json_t *flag_value(const char *value, bool *is_wrong)
{
    bool is_on = !value || !*value || strcmp(value, "1") == 0 || strcmp(value, "true") == 0;
    *is_wrong = !is_on && strcmp(value, "0") != 0 && strcmp(value, "false") != 0;
    return is_on ? json_true() : NULL;
}

static enum MHD_Result add_member(void *user, enum MHD_ValueKind kind, const char *name, const char *value)
{
    query *q = user;
    const option *o = option_find(q->method->verb, name, strlen(name));
    (void)kind;
    if (q->refusal->kind != ANSWER_DONE)
        return MHD_NO;
    if (json_object_get(q->params, name)) {
        answer_fail(q->refusal, ANSWER_USAGE, "%.100s: it is given twice", name);
    } else if (o && o->id == OPT_OUTPUT) {
        answer_fail(q->refusal, ANSWER_USAGE, "output: over HTTP the response holds the result");
    } else if (o && !option_takes_value(o)) {
        bool is_wrong;
        json_t *flag = flag_value(value, &is_wrong);
        if (is_wrong)
            answer_fail(q->refusal, ANSWER_USAGE, "%s: it is true or false", o->name);
        else if (flag)
            json_object_set_new(q->params, name, flag);
    } else {
        json_t *string = json_string(value ? value : "");
        if (!string || json_object_set_new(q->params, name, string) != 0)
            answer_fail(q->refusal, ANSWER_USAGE, "%.100s: it is not UTF-8", string ? name : "a parameter");
    }
    return q->refusal->kind == ANSWER_DONE ? MHD_YES : MHD_NO;
}

json_t *http_read_query(const http_library *l, struct MHD_Connection *c, const method *m, answer *refusal)
{
    query q = {m, json_object(), refusal};
    if (q.params)
        l->get_connection_values(c, MHD_GET_ARGUMENT_KIND, add_member, &q);
    else
        answer_fail(refusal, ANSWER_BUSY, "the server is out of memory; try again");
    if (refusal->kind == ANSWER_DONE)
        return q.params;
    json_decref(q.params);
    return NULL;
}

/* Types of forms and of what is certainly no model are refused; curl --data-binary says urlencoded. */
bool http_type_is_model(const char *content_type)
{
    static const char *const others[] = {"multipart/", "audio/", "video/", "text/html"};
    for (size_t i = 0; content_type && i < sizeof others / sizeof *others; i++)
        if (strncasecmp(content_type, others[i], strlen(others[i])) == 0)
            return false;
    return true;
}

/* ---- responses ---- */

static http_response respond(const http_library *l, const void *bytes, size_t size, const char *media_type,
                             unsigned status)
{
    http_response r = {l->create_response_from_buffer(size, (void *)(uintptr_t)bytes, MHD_RESPMEM_MUST_COPY),
                       status};
    if (r.response) {
        l->add_response_header(r.response, MHD_HTTP_HEADER_CONTENT_TYPE, media_type);
        l->add_response_header(r.response, "X-Content-Type-Options", "nosniff");
    }
    return r;
}

http_response http_text(const http_library *l, const char *media_type, const text *body, unsigned status)
{
    http_response r = respond(l, body->data ? body->data : "", body->length, media_type, status);
    if (r.response)
        l->add_response_header(r.response, MHD_HTTP_HEADER_CACHE_CONTROL, "no-store");
    return r;
}

static http_response fail_response(const http_library *l, const answer *a)
{
    text body = {0};
    const answer_code *code = &answer_codes[a->kind];
    text_json_begin_object(&body, NULL);
    text_json_begin_object(&body, "error");
    text_json_string(&body, "message", a->message);
    text_json_integer(&body, "status", code->http_status);
    text_json_integer(&body, "exit_code", a->exit_code);
    text_json_string(&body, "reason", code->word);
    text_json_end_object(&body);
    text_json_end_object(&body);
    text_add(&body, "\n");
    http_response r = http_text(l, "application/json", &body, (unsigned)code->http_status);
    text_destroy(&body);
    if (r.response && (a->kind == ANSWER_BUSY || a->kind == ANSWER_STOPPING))
        l->add_response_header(r.response, MHD_HTTP_HEADER_RETRY_AFTER, "1");
    return r;
}

/* The bytes that answer: the file, or the report. */
static http_response result_response(const http_library *l, const answer *a, const char *etag, bool is_get)
{
    text report = {0};
    const void *bytes = NULL;
    size_t size = 0;
    const char *type = "application/json";
    if (a->file_count) {
        bytes = a->files[0].bytes;
        size = a->files[0].size;
        type = media_type_of(a->files[0].name);
    } else {
        rpc_add_json(&report, a->report);
        text_add(&report, "\n");
        bytes = report.data;
        size = report.length;
    }
    char tag[64], took[64];
    snprintf(tag, sizeof tag, "\"%zx-%08x%08x\"", size, murmur3(bytes, size, 1), murmur3(bytes, size, 2));
    snprintf(took, sizeof took, "job;dur=%.1f", a->seconds * 1e3);
    bool is_same = is_get && a->file_count && etag && strstr(etag, tag);
    http_response r = respond(l, is_same ? "" : bytes, is_same ? 0 : size, type,
                              is_same ? MHD_HTTP_NOT_MODIFIED : MHD_HTTP_OK);
    text_destroy(&report);
    if (!r.response)
        return r;
    l->add_response_header(r.response, "Server-Timing", took);
    /* a model may change at any time: keep the image, but ask */
    l->add_response_header(r.response, MHD_HTTP_HEADER_CACHE_CONTROL, is_get ? "no-cache" : "no-store");
    if (is_get && a->file_count)
        l->add_response_header(r.response, MHD_HTTP_HEADER_ETAG, tag);
    return r;
}

http_response http_answer(const http_library *l, const answer *a, const char *etag, bool is_get)
{
    if (a->kind != ANSWER_DONE)
        return fail_response(l, a);
    if (a->file_count <= 1)
        return result_response(l, a, etag, is_get);
    answer many = {0};
    answer_fail(&many, ANSWER_USAGE,
                "the result is %zu files, and a response is one; JSON-RPC returns them all", a->file_count);
    return fail_response(l, &many);
}

http_response http_index(const http_library *l)
{
    text body = {0};
    text_addf(&body, "facet %s\n\n", facet_version());
    for (const method *m = methods; m->verb; m++) {
        text_addf(&body, "GET  /%s?%s=PATH%s&OPTION=VALUE..\n", m->verb->name, m->inputs[0],
                  m->inputs[1] ? "&b=PATH" : "");
        if (!m->inputs[1])
            text_addf(&body, "POST /%s?OPTION=VALUE..    with the %s as body\n", m->verb->name, m->inputs[0]);
    }
    text_add(
        &body,
        "GET  /health\nGET  /metrics\n\nOPTION: a long option of facet VERB, as in facet VERB --help-all.\n");
    http_response r = http_text(l, "text/plain; charset=utf-8", &body, MHD_HTTP_OK);
    text_destroy(&body);
    return r;
}
