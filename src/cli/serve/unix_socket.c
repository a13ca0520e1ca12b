/* unix_socket.c - see unix_socket.h. */
#define _GNU_SOURCE
#include "cli/serve/unix_socket.h"

#include <errno.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

/* Whether a server answers at the address. */
static bool is_alive(const struct sockaddr_un *address)
{
    int fd = socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
    bool is_answered =
        fd >= 0 && (connect(fd, (const struct sockaddr *)address, sizeof *address) == 0 || errno == EAGAIN);
    if (fd >= 0)
        close(fd);
    return is_answered;
}

/* The absolute path, whose folder must exist. */
static facet_result place(const char *path, char absolute[108], facet_error *error)
{
    char folder[PATH_MAX];
    const char *slash = strrchr(path, '/');
    char *copy = slash ? strndup(path, slash == path ? 1 : (size_t)(slash - path)) : strdup(".");
    bool is_there = copy && realpath(copy, folder);
    free(copy);
    if (!is_there)
        return fail(error, FACET_ERROR_WRITE, "--socket: %s: %s", path, strerror(errno));
    int n = snprintf(absolute, 108, "%s%s%s", folder, folder[1] ? "/" : "", slash ? slash + 1 : path);
    if (n < 0 || n >= 108)
        return fail(error, FACET_ERROR_WRITE,
                    "--socket: %s: the path is longer than 107 bytes, the most for a socket", path);
    return FACET_OK;
}

/* Binds with mode 0600 from the start. */
static bool bind_privately(int fd, const struct sockaddr_un *address)
{
    mode_t before = umask(0177);
    bool is_bound = bind(fd, (const struct sockaddr *)address, sizeof *address) == 0;
    umask(before);
    return is_bound;
}

/* Binds, after removing the socket of a server that is dead. */
static facet_result bind_at(int fd, const char *path, facet_error *error)
{
    struct sockaddr_un address = {.sun_family = AF_UNIX};
    struct stat info;
    memcpy(address.sun_path, path, strlen(path) + 1);
    if (bind_privately(fd, &address))
        return FACET_OK;
    if (errno != EADDRINUSE)
        return fail(error, FACET_ERROR_WRITE, "--socket: %s: %s", path, strerror(errno));
    if (lstat(path, &info) == 0 && !S_ISSOCK(info.st_mode))
        return fail(error, FACET_ERROR_WRITE, "--socket: %s: a file that is no socket is there", path);
    if (is_alive(&address))
        return fail(error, FACET_ERROR_WRITE, "--socket: %s: a server is running there", path);
    if (unlink(path) != 0 || !bind_privately(fd, &address))
        return fail(error, FACET_ERROR_WRITE, "--socket: %s: %s", path, strerror(errno));
    return FACET_OK;
}

facet_result unix_socket_open(unix_socket *s, const char *path, facet_error *error)
{
    struct stat info;
    TRY(place(path, s->path, error));
    s->fd = socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
    facet_result result = s->fd < 0 ? fail(error, FACET_ERROR_WRITE, "--socket: %s", strerror(errno))
                                    : bind_at(s->fd, s->path, error);
    if (result == FACET_OK && listen(s->fd, 64) != 0)
        result = fail(error, FACET_ERROR_WRITE, "--socket: %s: %s", path, strerror(errno));
    if (result == FACET_OK && lstat(s->path, &info) == 0) {
        s->device = info.st_dev;
        s->number = info.st_ino;
    }
    if (result != FACET_OK && s->fd >= 0) {
        close(s->fd);
        s->fd = -1;
    }
    return result;
}

void unix_socket_close(unix_socket *s)
{
    struct stat info;
    if (s->fd < 0)
        return;
    close(s->fd);
    if (lstat(s->path, &info) == 0 && info.st_dev == s->device && info.st_ino == s->number)
        unlink(s->path);
    s->fd = -1;
}
