/* http_library.h - libmicrohttpd, opened by --http: it brings a dozen libraries along, which other commands
 * would wait for. */
#ifndef CLI_SERVE_HTTP_LIBRARY_H
#define CLI_SERVE_HTTP_LIBRARY_H

#include "base/library.h"

#include <microhttpd.h>

#define HTTP_FUNCTIONS(F, out)                                                                               \
    F(out, MHD_start_daemon, start_daemon)                                                                   \
    F(out, MHD_stop_daemon, stop_daemon)                                                                     \
    F(out, MHD_quiesce_daemon, quiesce_daemon)                                                               \
    F(out, MHD_get_daemon_info, get_daemon_info)                                                             \
    F(out, MHD_get_timeout, get_timeout)                                                                     \
    F(out, MHD_run, run)                                                                                     \
    F(out, MHD_get_connection_info, get_connection_info)                                                     \
    F(out, MHD_get_connection_values, get_connection_values)                                                 \
    F(out, MHD_lookup_connection_value, lookup_connection_value)                                             \
    F(out, MHD_suspend_connection, suspend_connection)                                                       \
    F(out, MHD_resume_connection, resume_connection)                                                         \
    F(out, MHD_create_response_from_buffer, create_response_from_buffer)                                     \
    F(out, MHD_add_response_header, add_response_header)                                                     \
    F(out, MHD_queue_response, queue_response)                                                               \
    F(out, MHD_destroy_response, destroy_response)

/* Members have the library's names without "MHD_"; {0} is none. */
typedef struct http_library {
    void *handle;
    HTTP_FUNCTIONS(LIBRARY_MEMBER, )
} http_library;

/* FACET_ERROR_SYSTEM: it is not installed, or lacks a function. */
facet_result http_library_open(http_library *out, facet_error *error);
void http_library_close(http_library *l); /* {0} is allowed; leaves {0} */

#endif
