/* http_listen.c - see http_listen.h. */
#define _GNU_SOURCE
#include "cli/serve/http_listen.h"

#include <arpa/inet.h>
#include <errno.h>
#include <netdb.h>
#include <netinet/in.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/socket.h>
#include <unistd.h>

/* Divides "ADDR:PORT"; false: it is none. */
static bool divide(const char *where, char address[128], char port[16])
{
    const char *colon = strrchr(where, ':');
    const char *number = colon ? colon + 1 : where;
    size_t length = colon ? (size_t)(colon - where) : 0;
    char *end;
    unsigned long value = strtoul(number, &end, 10);
    if (number[0] < '0' || number[0] > '9' || *end || value > 65535 || length > 100)
        return false;
    if (length && where[0] == '[') {
        if (where[length - 1] != ']')
            return false;
        where++;
        length -= 2;
    } else if (memchr(where, ':', length)) {
        return false; /* IPv6 without brackets */
    }
    snprintf(address, 128, "%.*s", length ? (int)length : 9, length ? where : "127.0.0.1");
    snprintf(port, 16, "%lu", value);
    return true;
}

static bool is_loopback(const struct sockaddr *address)
{
    if (address->sa_family == AF_INET) {
        struct sockaddr_in four;
        memcpy(&four, address, sizeof four);
        return ntohl(four.sin_addr.s_addr) >> 24 == 127;
    }
    struct sockaddr_in6 six;
    memcpy(&six, address, sizeof six);
    return IN6_IS_ADDR_LOOPBACK(&six.sin6_addr);
}

/* Notes the address that was bound. */
static void name_address(http_address *out)
{
    struct sockaddr_storage bound;
    socklen_t size = sizeof bound;
    char address[100] = "", port[16] = "";
    if (getsockname(out->fd, (struct sockaddr *)&bound, &size) != 0)
        return;
    getnameinfo((struct sockaddr *)&bound, size, address, sizeof address, port, sizeof port,
                NI_NUMERICHOST | NI_NUMERICSERV);
    snprintf(out->name, sizeof out->name, strchr(address, ':') ? "[%s]:%s" : "%s:%s", address, port);
    out->is_loopback = is_loopback((struct sockaddr *)&bound);
}

static int listen_at(const struct addrinfo *info)
{
    const int yes = 1;
    int fd = socket(info->ai_family, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
    if (fd >= 0)
        setsockopt(fd, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
    if (fd >= 0 && (bind(fd, info->ai_addr, info->ai_addrlen) != 0 || listen(fd, 256) != 0)) {
        int code = errno;
        close(fd);
        errno = code;
        fd = -1;
    }
    return fd;
}

facet_result http_listen(const char *where, http_address *out, facet_error *error)
{
    char address[128], port[16];
    struct addrinfo hints = {.ai_socktype = SOCK_STREAM, .ai_flags = AI_NUMERICSERV}, *info = NULL;
    out->fd = -1;
    if (!divide(where, address, port))
        return fail(error, FACET_ERROR_ARGUMENT,
                    "--http: \"%s\" is not an address and port such as 127.0.0.1:8080 or 8080", where);
    int code = getaddrinfo(address, port, &hints, &info);
    if (code != 0)
        return fail(error, FACET_ERROR_ARGUMENT, "--http: %s: %s", where, gai_strerror(code));
    out->fd = listen_at(info);
    code = errno;
    freeaddrinfo(info);
    if (out->fd < 0)
        return fail(error, FACET_ERROR_SYSTEM, "--http: %s: %s", where, strerror(code));
    name_address(out);
    return FACET_OK;
}

bool http_host_is_local(const char *host)
{
    char name[64];
    struct in_addr address;
    size_t length = strcspn(host, ":");
    if (host[0] == '[')
        length = strchr(host, ']') ? strcspn(host, "]") + 1 : sizeof name;
    if (length >= sizeof name || (host[length] && host[length] != ':'))
        return false;
    snprintf(name, sizeof name, "%.*s", (int)length, host);
    return strcasecmp(name, "localhost") == 0 || strcmp(name, "[::1]") == 0 ||
           (inet_pton(AF_INET, name, &address) == 1 && ntohl(address.s_addr) >> 24 == 127);
}

bool http_page_is_local(const char *url)
{
    char host[64];
    const char *begin = strstr(url, "://");
    size_t length = begin ? strcspn(begin + 3, "/?#") : sizeof host;
    if (length >= sizeof host)
        return false; /* no URL, or "null" of a page without an origin */
    snprintf(host, sizeof host, "%.*s", (int)length, begin + 3);
    return http_host_is_local(host);
}
