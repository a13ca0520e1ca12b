/* http_answer.h - requests of HTTP as parameters, and answers as responses; nothing about connections. */
#ifndef CLI_SERVE_HTTP_ANSWER_H
#define CLI_SERVE_HTTP_ANSWER_H

#include "cli/serve/http_library.h"
#include "cli/serve/server.h"

/* What a path leads to. */
typedef struct http_page {
    const method *method; /* NULL: a page of the server itself */
    enum { HTTP_PAGE_METHOD, HTTP_PAGE_INDEX, HTTP_PAGE_HEALTH, HTTP_PAGE_METRICS, HTTP_PAGE_NONE } kind;
} http_page;

http_page http_page_find(const char *url);

/* The query as parameters; NULL, with the reason in *refusal. */
json_t *http_read_query(const http_library *l, struct MHD_Connection *c, const method *m, answer *refusal);
/* Whether a body of this type can be a model. */
bool http_type_is_model(const char *content_type /* NULL: not given */);

typedef struct http_response {
    struct MHD_Response *response;
    unsigned status;
} http_response;

/* The response of an answer; etag (NULL: none) is what the client has. is_get: it may be kept and asked for again. */
http_response http_answer(const http_library *l, const answer *a, const char *etag, bool is_get);
http_response http_text(const http_library *l, const char *media_type, const text *body, unsigned status);
http_response http_index(const http_library *l);

#endif
