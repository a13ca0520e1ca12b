/* line_stream.c - see line_stream.h. Descriptors that this process did not open stay as they are: writing at most
 * PIPE_BUF bytes to a pipe that poll() calls writable does not block, and sockets take a flag. */
#define _GNU_SOURCE
#include "cli/serve/line_stream.h"

#include "cli/shared/interrupt.h"

#include <errno.h>
#include <limits.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <unistd.h>

enum { BLOCK = 65536 };

void line_stream_prepare(line_stream *s, poll_set *set, bool reads)
{
    bool has_output = line_stream_unsent(s) > 0;
    s->in_entry = s->out_entry = POLL_SET_NONE;
    if (s->in == s->out && s->in >= 0) {
        bool listens = reads && !s->has_ended;
        s->in_entry = s->out_entry =
            poll_set_add(set, s->in, (short)((listens ? POLLIN : 0) | (has_output ? POLLOUT : 0)));
        return;
    }
    if (s->in >= 0 && reads && !s->has_ended)
        s->in_entry = poll_set_add(set, s->in, POLLIN);
    if (s->out >= 0 && !s->is_broken)
        s->out_entry = poll_set_add(set, s->out, has_output ? POLLOUT : 0);
}

/* ---- reading ---- */

/* Makes room for a block at the end of the data; false: no memory. */
static bool make_room(line_stream *s)
{
    if (s->start > 0) {
        memmove(s->data, s->data + s->start, s->end - s->start);
        s->end -= s->start;
        s->searched -= s->start;
        s->start = 0;
    }
    if (s->capacity - s->end >= BLOCK)
        return true;
    size_t capacity = s->capacity ? 2 * s->capacity : 2 * BLOCK;
    char *grown = realloc(s->data, capacity);
    if (!grown)
        return false;
    s->data = grown;
    s->capacity = capacity;
    return true;
}

static void read_some(line_stream *s)
{
    for (int i = 0; i < 16; i++) { /* then others have their turn */
        if (s->end - s->start > s->max_line)
            return;
        if (!make_room(s)) {
            s->has_ended = true;
            return;
        }
        ssize_t n = recv(s->in, s->data + s->end, BLOCK, MSG_DONTWAIT);
        bool is_socket = n >= 0 || errno != ENOTSOCK;
        if (!is_socket)
            n = read(s->in, s->data + s->end, BLOCK);
        if (n == 0 || (n < 0 && errno != EAGAIN && errno != EINTR))
            s->has_ended = true;
        if (n <= 0)
            return;
        s->end += (size_t)n;
        if (!is_socket)
            return; /* the next read could block */
    }
}

/* Makes the buffer empty, and small after a large line, once all that came is taken. */
static void tidy(line_stream *s)
{
    enum { SMALL = 1 << 20 };
    if (s->start < s->end)
        return;
    s->start = s->end = s->searched = 0;
    if (s->capacity > SMALL) {
        free(s->data);
        s->data = NULL;
        s->capacity = 0;
    }
}

line_event line_stream_next(line_stream *s, const char **line, size_t *length)
{
    for (;;) {
        tidy(s);
        char *found = s->end > s->searched ? memchr(s->data + s->searched, '\n', s->end - s->searched) : NULL;
        size_t size = (found ? (size_t)(found - s->data) : s->end) - s->start;
        bool is_last = !found && s->has_ended && size > 0;
        s->searched = s->end;
        if (!found && !is_last && size <= s->max_line) {
            if (size && s->waits_in <= 0.0)
                s->waits_in = interrupt_clock();
            return LINE_NONE;
        }
        bool was_skipping = s->skips;
        *line = s->data + s->start;
        *length = size;
        s->skips = !found && !is_last;
        s->waits_in = 0.0;
        s->start = s->searched = s->start + size + (found ? 1 : 0);
        if (!was_skipping)
            return size <= s->max_line ? LINE_READY : LINE_TOO_LONG;
    }
}

/* ---- writing ---- */

void line_stream_send(line_stream *s, const char *line, size_t length)
{
    if (s->is_broken)
        return;
    if (!line_stream_unsent(s))
        s->waits_out = interrupt_clock();
    text_add_bytes(&s->pending, line, length);
    text_add(&s->pending, "\n");
    if (s->pending.has_failed)
        s->is_broken = true;
}

size_t line_stream_unsent(const line_stream *s)
{
    return s->is_broken ? 0 : s->pending.length - s->sent;
}

/* Moves what is left to the front once much has gone, so that an output that is never empty does not grow. */
static void forget_sent(line_stream *s)
{
    enum { MUCH = 1 << 20 };
    if (s->sent < MUCH || s->sent < s->pending.length / 2)
        return;
    s->pending.length -= s->sent;
    memmove(s->pending.data, s->pending.data + s->sent, s->pending.length + 1);
    s->sent = 0;
}

static void write_some(line_stream *s)
{
    for (int i = 0; i < 64 && s->sent < s->pending.length; i++) {
        const char *bytes = s->pending.data + s->sent;
        size_t left = s->pending.length - s->sent;
        ssize_t n = send(s->out, bytes, left, MSG_DONTWAIT | MSG_NOSIGNAL);
        bool is_socket = n >= 0 || errno != ENOTSOCK;
        if (!is_socket)
            n = write(s->out, bytes, left < PIPE_BUF ? left : PIPE_BUF);
        if (n < 0 && errno != EAGAIN && errno != EINTR)
            s->is_broken = true;
        if (n <= 0)
            return;
        s->sent += (size_t)n;
        s->waits_out = interrupt_clock();
        struct pollfd again = {.fd = s->out, .events = POLLOUT};
        if (!is_socket && (poll(&again, 1, 0) != 1 || !(again.revents & POLLOUT)))
            break; /* the next write would block */
    }
    if (s->sent < s->pending.length) {
        forget_sent(s);
    } else {
        text_destroy(&s->pending);
        s->sent = 0;
        s->waits_out = 0.0;
    }
}

void line_stream_handle(line_stream *s, const poll_set *set)
{
    short in = poll_set_events(set, s->in_entry), out = poll_set_events(set, s->out_entry);
    if ((in & (POLLIN | POLLHUP | POLLERR)) && !s->has_ended)
        read_some(s);
    if (out & POLLOUT)
        write_some(s);
    /* both directions of a socket are closed, or the reader of a pipe has gone */
    if (out & (POLLERR | POLLHUP | POLLNVAL))
        s->is_broken = true;
}

void line_stream_destroy(line_stream *s)
{
    free(s->data);
    text_destroy(&s->pending);
    s->data = NULL;
    s->start = s->end = s->capacity = s->searched = 0;
}
