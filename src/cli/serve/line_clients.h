/* line_clients.h - clients that speak in lines: standard input and output, and those of a socket. */
#ifndef CLI_SERVE_LINE_CLIENTS_H
#define CLI_SERVE_LINE_CLIENTS_H

#include "cli/serve/session.h"
#include "cli/serve/unix_socket.h"

enum { LINE_CLIENTS_MAX = 64 };

typedef struct line_client {
    session *session;
    int fd; /* -1: standard input and output */
} line_client;

/* {.server, .listener = {-1}} initially. */
typedef struct line_clients {
    server *server;
    unix_socket listener;
    line_client clients[LINE_CLIENTS_MAX];
    unsigned count;
    bool has_stdio; /* the client of standard input is there */
    long listener_entry;
} line_clients;

/* Adds the client of standard input and output. FACET_ERROR_MEMORY. */
facet_result line_clients_add_stdio(line_clients *l, const protocol *p, facet_error *error);
void line_clients_prepare(line_clients *l, poll_set *set);
void line_clients_handle(line_clients *l, const poll_set *set);
/* Whether answers are still on their way. */
bool line_clients_have_output(const line_clients *l);
void line_clients_destroy(line_clients *l);

#endif
