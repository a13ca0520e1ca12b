/* line_clients.c - see line_clients.h. */
#define _GNU_SOURCE
#include "cli/serve/line_clients.h"

#include <string.h>
#include <sys/socket.h>
#include <unistd.h>

facet_result line_clients_add_stdio(line_clients *l, const protocol *p, facet_error *error)
{
    session *made = session_create(l->server, p, STDIN_FILENO, STDOUT_FILENO, false);
    if (!made)
        return fail_memory(error, "a client", 0);
    l->clients[l->count++] = (line_client){made, -1};
    l->has_stdio = true;
    return FACET_OK;
}

static void accept_one(line_clients *l)
{
    static const char refusal[] =
        "{\"jsonrpc\":\"2.0\",\"id\":null,\"error\":{\"code\":-32075,\"message\":\"the server "
        "has too many clients; try again\",\"data\":{\"exit_code\":75}}}\n";
    int fd = accept4(l->listener.fd, NULL, NULL, SOCK_CLOEXEC | SOCK_NONBLOCK);
    if (fd < 0)
        return;
    session *made =
        l->count < LINE_CLIENTS_MAX ? session_create(l->server, &rpc_protocol, fd, fd, true) : NULL;
    if (made) {
        l->clients[l->count++] = (line_client){made, fd};
        return;
    }
    if (send(fd, refusal, sizeof refusal - 1, MSG_DONTWAIT | MSG_NOSIGNAL) >= 0)
        server_metrics(l->server)->refused_clients++;
    close(fd);
}

void line_clients_prepare(line_clients *l, poll_set *set)
{
    l->listener_entry = l->listener.fd >= 0 ? poll_set_add(set, l->listener.fd, POLLIN) : POLL_SET_NONE;
    for (unsigned i = 0; i < l->count; i++)
        session_prepare(l->clients[i].session, set);
}

static void remove_client(line_clients *l, unsigned i)
{
    session_destroy(l->clients[i].session);
    if (l->clients[i].fd >= 0)
        close(l->clients[i].fd);
    else
        l->has_stdio = false;
    l->clients[i] = l->clients[--l->count];
}

void line_clients_handle(line_clients *l, const poll_set *set)
{
    for (unsigned i = 0; i < l->count;)
        if (session_handle(l->clients[i].session, set))
            i++;
        else
            remove_client(l, i);
    if (poll_set_events(set, l->listener_entry) & POLLIN)
        accept_one(l);
}

bool line_clients_have_output(const line_clients *l)
{
    for (unsigned i = 0; i < l->count; i++)
        if (session_has_output(l->clients[i].session))
            return true;
    return false;
}

void line_clients_destroy(line_clients *l)
{
    while (l->count)
        remove_client(l, l->count - 1);
    unix_socket_close(&l->listener);
}
