/* unix_socket.h - a listening socket of the file system. */
#ifndef CLI_SERVE_UNIX_SOCKET_H
#define CLI_SERVE_UNIX_SOCKET_H

#include "base/result.h"

#include <stdint.h>

/* {-1} while there is none. */
typedef struct unix_socket {
    int fd;
    char path[108]; /* absolute, so that the current folder may change; as long as the system allows */
    uint64_t device, number;
} unix_socket;

/* Listens at path, which only this user may connect to (mode 0600). A socket that a dead server left there is
 * replaced. Fails with FACET_ERROR_WRITE: a server is there, or something else is, or the path is too long. */
facet_result unix_socket_open(unix_socket *s, const char *path, facet_error *error);
/* Stops listening, and removes the file unless it has been replaced. */
void unix_socket_close(unix_socket *s);

#endif
