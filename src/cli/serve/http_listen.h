/* http_listen.h - the address of --http. */
#ifndef CLI_SERVE_HTTP_LISTEN_H
#define CLI_SERVE_HTTP_LISTEN_H

#include "base/result.h"

typedef struct http_address {
    int fd;           /* listens, without blocking */
    char name[128];   /* "127.0.0.1:8080" as it was bound */
    bool is_loopback; /* only this machine reaches it */
} http_address;

/* Listens at "ADDR:PORT", "[ADDR]:PORT", ":PORT" or "PORT"; without an address at 127.0.0.1. Port 0 is any free one.
 * Fails with FACET_ERROR_ARGUMENT, and FACET_ERROR_SYSTEM where it cannot listen there. */
facet_result http_listen(const char *where, http_address *out, facet_error *error);

/* Whether Host, with or without a port, names this machine. Programs on other hosts reach a loopback server only
 * through a browser that was told that their name has its address. */
bool http_host_is_local(const char *host);
/* The same of the URL of a web page, or its origin. */
bool http_page_is_local(const char *url);

#endif
