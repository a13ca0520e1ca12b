/* json_messages.c - errors, warnings and notes of the JSON readers, each with its place; see
 * json_reader.h. */
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "base/result.h"
#include "io/json_reader.h"

enum { PLACE_SIZE = 256, MAX_REMARKS = 256, KEY_SIZE = 32 };

/* Appends the path of a place, "meshes[3].primitives[0]"; a path that is too long is cut off. */
static void append_place(char *text, const json_place *at)
{
    if (!at)
        return;
    append_place(text, at->parent); /* recursion as deep as the chain of places */
    size_t length = strlen(text);
    if (at->key)
        snprintf(text + length, PLACE_SIZE - length, "%s%s", length ? "." : "", at->key);
    else if (at->parent)
        snprintf(text + length, PLACE_SIZE - length, "[%zu]", at->index);
}

static void format_message(char *out, size_t size, const io_reader *r, const json_place *at, const char *key,
                           const char *format, va_list arguments)
{
    char place[PLACE_SIZE] = "";
    append_place(place, at);
    size_t length = strlen(place);
    if (key)
        snprintf(place + length, PLACE_SIZE - length, "%s%s", length ? "." : "", key);
    char what[768];
    vsnprintf(what, sizeof what, format, arguments);
    snprintf(out, size, "%s: %s%s%s", r->scene->source, place, place[0] ? ": " : "", what);
}

bool io_is_ok(const io_reader *r)
{
    return r->result == FACET_OK;
}

bool io_fail(io_reader *r, const json_place *at, const char *key, facet_result result, const char *format,
             ...)
{
    if (r->result != FACET_OK)
        return false;
    char message[1024];
    va_list arguments;
    va_start(arguments, format);
    format_message(message, sizeof message, r, at, key, format, arguments);
    va_end(arguments);
    r->result = fail(r->error, result, "%s", message);
    return false;
}

bool io_fail_memory(io_reader *r, const char *what, size_t size)
{
    if (r->result == FACET_OK)
        r->result = fail_memory(r->error, what, size);
    return false;
}

/* ---- remarks ---- */

/* A kind of warning or note. */
typedef struct remark {
    const char *format; /* format string of the call, a literal, which identifies the kind */
    char key[KEY_SIZE];
    bool is_note;
    size_t count;
    const char *text; /* the first one */
} remark;

struct io_remarks {
    size_t count;
    remark all[MAX_REMARKS];
};

static void pass_on(io_reader *r, bool is_note, const char *message)
{
    (is_note ? scene_note : scene_warn)(r->scene, r->log, "%s", message);
}

/* Counts a remark. False: it is the first of its kind and cannot be stored. */
static bool count_remark(io_reader *r, bool is_note, const char *key, const char *format, const char *message)
{
    struct io_remarks *list = r->remarks;
    if (!list)
        return false;
    for (size_t i = 0; i < list->count; i++)
        if (strcmp(list->all[i].format, format) == 0 && strncmp(list->all[i].key, key, KEY_SIZE - 1) == 0) {
            list->all[i].count++;
            return true;
        }
    remark first = {.format = format,
                    .is_note = is_note,
                    .count = 1,
                    .text = list->count < MAX_REMARKS ? arena_strdup(r->scene->arena, message) : NULL};
    if (!first.text)
        return false;
    snprintf(first.key, sizeof first.key, "%s", key);
    list->all[list->count++] = first;
    return true;
}

void io_begin_remarks(io_reader *r)
{
    r->remarks = mem_zalloc(r->allocator, 1, sizeof *r->remarks);
}

void io_end_remarks(io_reader *r)
{
    for (size_t i = 0; r->remarks && i < r->remarks->count; i++) {
        const remark *of = &r->remarks->all[i];
        char message[1088];
        if (of->count == 1)
            snprintf(message, sizeof message, "%s", of->text);
        else
            snprintf(message, sizeof message, "%s (%zu times in all)", of->text, of->count);
        pass_on(r, of->is_note, message);
    }
    mem_free(r->remarks);
    r->remarks = NULL;
}

static void add_remark(io_reader *r, bool is_note, bool is_counted, const json_place *at, const char *key,
                       const char *format, va_list arguments)
{
    char message[1024];
    format_message(message, sizeof message, r, at, key, format, arguments);
    if (!is_counted || !count_remark(r, is_note, key ? key : "", format, message))
        pass_on(r, is_note, message);
}

void io_warn(io_reader *r, const json_place *at, const char *key, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    add_remark(r, false, true, at, key, format, arguments);
    va_end(arguments);
}

void io_note(io_reader *r, const json_place *at, const char *key, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    add_remark(r, true, true, at, key, format, arguments);
    va_end(arguments);
}

void io_warn_each(io_reader *r, const json_place *at, const char *key, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    add_remark(r, false, false, at, key, format, arguments);
    va_end(arguments);
}

void io_note_each(io_reader *r, const json_place *at, const char *key, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    add_remark(r, true, false, at, key, format, arguments);
    va_end(arguments);
}

/* ---- parts that an image may do without ---- */

static bool is_of_the_part(const io_reader *r)
{
    return r->result != FACET_OK && r->result != FACET_ERROR_MEMORY && r->result != FACET_ERROR_LIMIT &&
           r->error;
}

bool io_leave_out(io_reader *r, const char *consequence)
{
    char message[1088];
    if (!is_of_the_part(r))
        return false;
    r->result = FACET_OK;
    snprintf(message, sizeof message, "%s; %s", r->error->message, consequence);
    if (!count_remark(r, false, "", consequence, message))
        pass_on(r, false, message);
    return true;
}

bool io_defer(io_reader *r, io_problem *problem)
{
    if (!is_of_the_part(r))
        return false;
    problem->result = r->result;
    r->result = FACET_OK;
    problem->message = arena_strdup(r->scene->arena, r->error->message);
    if (!problem->message)
        io_fail_memory(r, "message", strlen(r->error->message));
    return true;
}

bool io_fail_deferred(io_reader *r, io_problem *problem)
{
    problem->is_reported = true;
    if (r->result == FACET_OK)
        r->result = fail(r->error, problem->result, "%s", problem->message);
    return false;
}

void io_warn_deferred(io_reader *r, io_problem *problem)
{
    static const char consequence[] = "nothing that is drawn uses it";
    char message[1088];
    if (!problem->message || problem->is_reported)
        return;
    problem->is_reported = true;
    snprintf(message, sizeof message, "%s; %s", problem->message, consequence);
    if (!count_remark(r, false, "", consequence, message))
        pass_on(r, false, message);
}
