/* batch_source.c - see batch_source.h. */
#define _GNU_SOURCE
#include "cli/batch/batch_source.h"

#include "cli/shared/failure.h"
#include "cli/shared/input.h"
#include "cli/shared/manifest_line.h"

#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum { MAX_LINE_BYTES = 1 << 20, BUFFER_BYTES = MAX_LINE_BYTES + 65536 };

struct batch_source {
    const batch_plan *plan;
    const model_list *models; /* NULL: none */
    size_t next_model;
    uint64_t next_number; /* of an item */
    uint64_t count;

    int fd; /* of the manifest; -1: none */
    bool may_block, is_at_end;
    bool is_long; /* the line at begin has lost its first bytes, since it is too long */
    char *buffer; /* BUFFER_BYTES; [begin, end) is not used yet */
    size_t begin, end;
    uint64_t line_number;
};

/* ---- opening ---- */

/* The number of lines of a regular file that are not blank. */
static uint64_t count_lines(int fd, char *block, size_t size)
{
    uint64_t count = 0;
    bool has_text = false;
    off_t at = 0;
    for (ssize_t n; (n = pread(fd, block, size, at)) > 0; at += n)
        for (ssize_t i = 0; i < n; i++) {
            if (block[i] == '\n') {
                count += has_text;
                has_text = false;
            } else if (!manifest_is_space(block[i])) {
                has_text = true;
            }
        }
    return count + has_text;
}

static facet_result open_manifest(batch_source *s, const char *path, facet_error *error)
{
    struct stat info;
    s->fd = strcmp(path, "-") == 0 ? fcntl(STDIN_FILENO, F_DUPFD_CLOEXEC, 3)
                                   : open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK);
    if (s->fd < 0 || fstat(s->fd, &info) != 0)
        return fail(error, FACET_ERROR_READ, "%s: %s", input_name(path), strerror(errno));
    if (S_ISDIR(info.st_mode))
        return fail(error, FACET_ERROR_READ, "%s: it is a folder; a file of JSON lines was expected", path);
    s->may_block = !S_ISREG(info.st_mode);
    s->buffer = malloc(BUFFER_BYTES);
    if (!s->buffer)
        return fail_memory(error, "a manifest", BUFFER_BYTES);
    if (s->may_block)
        s->count = UINT64_MAX;
    else
        s->count += count_lines(s->fd, s->buffer, BUFFER_BYTES);
    return FACET_OK;
}

facet_result batch_source_open(const batch_plan *plan, const model_list *models, batch_source **source,
                               facet_error *error)
{
    batch_source *s = *source = calloc(1, sizeof *s);
    if (!s)
        return fail_memory(error, "items", sizeof *s);
    *s = (batch_source){.plan = plan, .models = models, .count = models ? models->count : 0, .fd = -1};
    facet_result result = plan->manifest ? open_manifest(s, plan->manifest, error) : FACET_OK;
    if (result == FACET_OK)
        return FACET_OK;
    batch_source_close(s);
    *source = NULL;
    return result;
}

void batch_source_close(batch_source *source)
{
    if (!source)
        return;
    if (source->fd >= 0)
        close(source->fd);
    free(source->buffer);
    free(source);
}

int batch_source_descriptor(const batch_source *source)
{
    return source->fd;
}

uint64_t batch_source_count(const batch_source *source)
{
    return source->count == UINT64_MAX ? UINT64_MAX : shard_size(source->plan->shard, source->count);
}

/* ---- lines ---- */

/* Reads more of the manifest. */
static batch_next fill(batch_source *s, facet_error *error)
{
    const char *name = input_name(s->plan->manifest);
    if (s->end - s->begin > MAX_LINE_BYTES) {
        s->is_long = true;
        s->begin = s->end;
    }
    memmove(s->buffer, s->buffer + s->begin, s->end - s->begin);
    s->end -= s->begin;
    s->begin = 0;
    struct pollfd ready = {.fd = s->fd, .events = POLLIN};
    if (s->may_block && poll(&ready, 1, 0) <= 0)
        return NEXT_LATER;
    ssize_t n = read(s->fd, s->buffer + s->end, BUFFER_BYTES - s->end);
    if (n < 0 && (errno == EINTR || errno == EAGAIN))
        return NEXT_LATER;
    if (n < 0) {
        fail(error, FACET_ERROR_READ, "%s: %s", name, strerror(errno));
        return NEXT_FAILED;
    }
    s->is_at_end = n == 0;
    s->end += (size_t)n;
    return NEXT_ITEM;
}

/* The next line that is not blank; it is valid until the next call. *line NULL: it is too long. */
static batch_next next_line(batch_source *s, const char **line, size_t *length, facet_error *error)
{
    for (;;) {
        const char *begin = s->buffer + s->begin;
        size_t size = s->end - s->begin;
        const char *stop = memchr(begin, '\n', size);
        if (!stop && !s->is_at_end) {
            batch_next state = fill(s, error);
            if (state != NEXT_ITEM)
                return state;
            continue;
        }
        if (!size && !s->is_long)
            return NEXT_END;
        *length = stop ? (size_t)(stop - begin) : size;
        *line = s->is_long || *length > MAX_LINE_BYTES ? NULL : begin;
        s->begin += *length + (stop ? 1 : 0);
        s->line_number++;
        s->is_long = false;
        if (!*line || !manifest_is_blank(*line, *length))
            return NEXT_ITEM;
    }
}

/* ---- items ---- */

/* An item of the manifest; of another shard *item is NULL. */
static batch_next next_of_manifest(batch_source *s, batch_item **item, facet_error *error)
{
    const char *line;
    size_t length;
    batch_next state = next_line(s, &line, &length, error);
    if (state != NEXT_ITEM)
        return state;
    uint64_t number = s->next_number++;
    if (!shard_has(s->plan->shard, number))
        return NEXT_ITEM;
    char place[512];
    snprintf(place, sizeof place, "%.400s: line %llu", input_name(s->plan->manifest),
             (unsigned long long)s->line_number);
    *item = batch_item_from_line(s->plan, line, length, place, number);
    if (*item)
        return NEXT_ITEM;
    fail_memory(error, place, 0);
    return NEXT_FAILED;
}

batch_next batch_source_next(batch_source *s, batch_item **item, facet_error *error)
{
    *item = NULL;
    while (s->models && s->next_model < s->models->count) {
        const model_name *model = &s->models->models[s->next_model++];
        uint64_t number = s->next_number++;
        if (!shard_has(s->plan->shard, number))
            continue;
        *item = batch_item_from_model(s->plan, model, number);
        if (*item)
            return NEXT_ITEM;
        fail_memory(error, model->path, 0);
        return NEXT_FAILED;
    }
    if (s->fd < 0)
        return NEXT_END;
    batch_next state = NEXT_ITEM;
    while (state == NEXT_ITEM && !*item)
        state = next_of_manifest(s, item, error);
    return state;
}
