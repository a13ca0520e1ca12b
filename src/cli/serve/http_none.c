/* http_none.c - http.h in builds without libmicrohttpd. */
#include "cli/serve/http.h"

facet_result http_create(server *s, const http_address *address, http **out, facet_error *error)
{
    (void)s;
    *out = NULL;
    return fail(error, FACET_ERROR_UNSUPPORTED, "--http: %s: this build of facet is without libmicrohttpd",
                address->name);
}

void http_prepare(http *h, poll_set *set)
{
    (void)h;
    (void)set;
}

void http_handle(http *h, const poll_set *set)
{
    (void)h;
    (void)set;
}

void http_stop(http *h)
{
    (void)h;
}

bool http_has_output(const http *h)
{
    (void)h;
    return false;
}

void http_destroy(http *h)
{
    (void)h;
}
