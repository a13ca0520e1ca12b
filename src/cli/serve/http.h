/* http.h - the server over HTTP: GET /render?model=a.glb&size=256, POST /render with the model as body, /inspect,
 * /convert, /compare, /bake, /health and /metrics. Builds without libmicrohttpd have http_none.c. */
#ifndef CLI_SERVE_HTTP_H
#define CLI_SERVE_HTTP_H

#include "cli/serve/http_listen.h"
#include "cli/serve/server.h"

typedef struct http http;

/* Serves at address, whose socket it takes. Fails with FACET_ERROR_SYSTEM, also where libmicrohttpd is not
 * installed, and FACET_ERROR_UNSUPPORTED in builds without it. */
facet_result http_create(server *s, const http_address *address, http **out, facet_error *error);
void http_prepare(http *h, poll_set *set);
void http_handle(http *h, const poll_set *set);
/* Accepts no further connections. */
void http_stop(http *h);
/* Whether answers are still on their way. */
bool http_has_output(const http *h);
void http_destroy(http *h); /* NULL is allowed; the server is idle or will not be used any more */

#endif
