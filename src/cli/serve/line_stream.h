/* line_stream.h - lines to and from a client over two descriptors (or one), without blocking. */
#ifndef CLI_SERVE_LINE_STREAM_H
#define CLI_SERVE_LINE_STREAM_H

#include "base/text.h"
#include "cli/serve/poll_set.h"

/* {.in, .out, .max_line} initially. */
typedef struct line_stream {
    int in, out;     /* may be the same; -1: closed */
    size_t max_line; /* longer lines are skipped */
    char *data;      /* what has come and was not taken as a line */
    size_t start, end, capacity, searched;
    bool skips;     /* the rest of a line that is too long */
    bool has_ended; /* nothing more comes in */
    bool is_broken; /* nothing more goes out: the client has gone */
    text pending;   /* what is to go out, of which sent bytes have gone */
    size_t sent;
    double waits_in,
        waits_out; /* interrupt_clock() since when the rest of a line, or a reader, is awaited; 0: not */
    long in_entry, out_entry; /* of the poll_set */
} line_stream;

typedef enum line_event { LINE_NONE, LINE_READY, LINE_TOO_LONG } line_event;

/* Adds the descriptors to the set; reads: whether more input is wanted. */
void line_stream_prepare(line_stream *s, poll_set *set, bool reads);
/* Reads and writes by the events of the set. */
void line_stream_handle(line_stream *s, const poll_set *set);
/* The next line, without its end; it is valid until the next call. At the end of the input also a line without end. */
line_event line_stream_next(line_stream *s, const char **line, size_t *length);
/* Queues a line; its end is added. */
void line_stream_send(line_stream *s, const char *line, size_t length);
size_t line_stream_unsent(const line_stream *s);
void line_stream_destroy(line_stream *s); /* closes no descriptor */

#endif
