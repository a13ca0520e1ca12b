/* batch_results.c - see batch_results.h. */
#define _GNU_SOURCE
#include "cli/batch/batch_results.h"

#include "cli/batch/batch_tag.h"
#include "cli/shared/failure.h"
#include "cli/shared/output.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* ---- writing ---- */

facet_result batch_lines_open(const char *path, batch_lines *out, facet_error *error)
{
    *out = (batch_lines){.fd = -1, .path = path};
    if (!path)
        return FACET_OK;
    TRY(output_check(path, error));
    TRY(output_make_folders(path, error));
    out->fd = open(path, O_RDWR | O_CREAT | O_APPEND | O_CLOEXEC, 0666);
    if (out->fd < 0)
        return fail(error, FACET_ERROR_WRITE, "%s: %s", path, strerror(errno));
    off_t size = lseek(out->fd, 0, SEEK_END);
    char last = '\n';
    if (size > 0 && pread(out->fd, &last, 1, size - 1) == 1 && last != '\n' && write(out->fd, "\n", 1) != 1)
        return fail(error, FACET_ERROR_WRITE, "%s: %s", path, strerror(errno));
    return FACET_OK;
}

void batch_lines_close(batch_lines *lines)
{
    if (lines->fd >= 0)
        close(lines->fd);
    lines->fd = -1;
}

facet_result batch_lines_add(batch_lines *lines, json_t *object, facet_error *error)
{
    if (lines->fd < 0) {
        json_decref(object);
        return FACET_OK;
    }
    char *text = object ? json_dumps(object, JSON_COMPACT | JSON_REAL_PRECISION(6)) : NULL;
    json_decref(object);
    if (!text)
        return fail_memory(error, lines->path, 0);
    size_t length = strlen(text);
    text[length] = '\n';
    ssize_t n;
    do
        n = write(lines->fd, text, length + 1);
    while (n < 0 && errno == EINTR);
    free(text);
    if (n == (ssize_t)length + 1)
        return FACET_OK;
    /* a disk that becomes full takes a part of the line and sets no errno */
    return fail(error, FACET_ERROR_WRITE, "%s: cannot be written: %s", lines->path,
                strerror(n < 0 ? errno : ENOSPC));
}

/* Adds text unless it is NULL. */
static void set_text(json_t *object, const char *key, const char *text)
{
    if (text)
        json_object_set_new(object, key, report_string_json(text));
}

static json_t *item_json(const batch_item *item, const char *status)
{
    json_t *line = json_object();
    set_text(line, "id", item->id);
    json_object_set_new(line, "item", json_integer((json_int_t)item->number));
    if (strcmp(item->verb->name, "render") != 0)
        set_text(line, "command", item->verb->name);
    set_text(line, "input", item->name);
    set_text(line, "output", item->output);
    set_text(line, "status", status);
    set_text(line, "hash", *item->hash ? item->hash : NULL);
    return line;
}

json_t *batch_result_json(const batch_item *item, const job_result *result, bool is_done)
{
    json_t *line = item_json(item, is_done ? "done" : "failed");
    json_object_set_new(line, "exit_code", json_integer(result->exit_code));
    if (result->signal)
        json_object_set_new(line, "signal", json_integer(result->signal));
    set_text(line, "message", result->message);
    json_object_set_new(line, "tries", json_integer((json_int_t)item->tries));
    json_object_set_new(line, "seconds", json_real(result->seconds));
    json_object_set_new(line, "cpu_seconds", json_real(result->cpu_seconds));
    json_object_set_new(line, "peak_memory_bytes", json_integer((json_int_t)result->peak_memory_bytes));
    json_t *warnings = json_object_get(result->report, "warnings");
    if (json_array_size(warnings))
        json_object_set(line, "warnings", warnings);
    if (!item->output && result->report) /* the report is the result */
        json_object_set(line, "report", result->report);
    return line;
}

json_t *batch_kept_json(const batch_item *item)
{
    json_t *line = item_json(item, "done");
    json_object_set_new(line, "exit_code", json_integer(EXIT_DONE));
    json_object_set_new(line, "kept", json_true());
    return line;
}

json_t *batch_failed_json(const batch_item *item, int exit_code, const char *message)
{
    json_t *line = json_copy(item->source);
    json_object_set_new(line, "exit_code", json_integer(exit_code));
    set_text(line, "message", message);
    return line;
}

/* ---- reading ---- */

enum { KNOWN_BITS = 3 };

/* Adds a line; false: no memory. */
static bool add_line(batch_history *history, json_t *messages, const char *text, size_t length)
{
    json_t *line = json_loadb(text, length, 0, NULL);
    const char *id = json_string_value(json_object_get(line, "id"));
    const char *hash = json_string_value(json_object_get(line, "hash"));
    const char *status = json_string_value(json_object_get(line, "status"));
    bool has_memory = true;
    if (id && status && messages) {
        json_t *message = strcmp(status, "failed") == 0 ? json_object_get(line, "message") : NULL;
        if (message)
            json_object_set(messages, id, message);
        else
            json_object_del(messages, id);
    }
    if (id && hash && status) {
        uint64_t known = strcmp(status, "done") == 0 ? KNOWN_DONE : KNOWN_FAILED;
        has_memory = batch_map_set(history, id, (batch_map_hash(hash) & ~(uint64_t)KNOWN_BITS) | known);
    }
    json_decref(line);
    return has_memory;
}

facet_result batch_history_read(batch_history *history, json_t *messages, const char *path,
                                facet_error *error)
{
    FILE *file = fopen(path, "re");
    if (!file)
        return errno == ENOENT ? FACET_OK : fail(error, FACET_ERROR_READ, "%s: %s", path, strerror(errno));
    char *line = NULL;
    size_t capacity = 0;
    bool has_memory = true;
    for (ssize_t n; has_memory && (n = getline(&line, &capacity, file)) > 0;)
        has_memory = add_line(history, messages, line, (size_t)n);
    bool is_read = !ferror(file);
    free(line);
    fclose(file);
    if (!has_memory)
        return fail_memory(error, path, 0);
    return is_read ? FACET_OK : fail(error, FACET_ERROR_READ, "%s: it cannot be read", path);
}

uint64_t batch_history_value(const batch_item *item, batch_known known)
{
    return (batch_map_hash(item->hash) & ~(uint64_t)KNOWN_BITS) | (uint64_t)known;
}

batch_known batch_history_find(const batch_history *history, const batch_item *item)
{
    const uint64_t *value = batch_map_find(history, item->id);
    bool is_same = value && ((*value ^ batch_map_hash(item->hash)) & ~(uint64_t)KNOWN_BITS) == 0;
    return is_same ? (batch_known)(*value & KNOWN_BITS) : KNOWN_NOT;
}

bool batch_is_done(const batch_history *history, const batch_item *item)
{
    char tag[BATCH_TAG_SIZE];
    if (item->has_metadata)
        return batch_tag_read(item->output, tag) && strcmp(tag, item->hash) == 0;
    return batch_history_find(history, item) == KNOWN_DONE &&
           (!item->output || item->writes_sequence || output_exists(item->output));
}
