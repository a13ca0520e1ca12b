/* request_result.c - the job of a request, and what came of it. */
#define _POSIX_C_SOURCE 200809L
#include "cli/serve/request.h"

#include "base/text.h"

#include "cli/shared/failure.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Seconds beyond --time-limit, in which a job ends by itself with its own sentence. */
static const double grace_s = 2.0;

job_request request_job(request *r, const request_limits *limits, uint32_t thread_count)
{
    if (!r->has_threads)
        job_words_addf(&r->words, "--threads=%u", thread_count);
    r->has_threads = true;
    return (job_request){.words = (const char *const *)r->words.words,
                         .name = r->name[0] ? r->name : r->method->verb->name,
                         .input = r->input,
                         .input_size = r->input_size,
                         .max_output_bytes = r->output[0] ? REQUEST_MAX_OUTPUT_BYTES : 0,
                         .time_limit_s = limits->time_limit_s + grace_s,
                         .max_memory_bytes = limits->max_memory_bytes};
}

/* ---- names of temporary files ---- */

/* The text with all occurrences of from replaced, for free(); NULL: there are none, or no memory. */
static char *replace_all(const char *source, const char *from, const char *to)
{
    text t = {0};
    size_t length = strlen(from);
    const char *found = length ? strstr(source, from) : NULL;
    if (!found)
        return NULL;
    for (; found; found = strstr(source, from)) {
        text_add_bytes(&t, source, (size_t)(found - source));
        text_add(&t, to);
        source = found + length;
    }
    text_add(&t, source);
    char *copy = t.data && !t.has_failed ? strdup(t.data) : NULL;
    text_destroy(&t);
    return copy;
}

/* Temporary names, and what they are called in answers. */
typedef struct renaming {
    const char *from, *to;
} renaming;
enum { RENAMING_COUNT = 4 };

static void rename_in_text(char *sentence, size_t size, const renaming *names)
{
    for (int i = 0; i < RENAMING_COUNT; i++) {
        char *changed = replace_all(sentence, names[i].from, names[i].to);
        if (changed)
            snprintf(sentence, size, "%.*s", (int)size - 1, changed);
        free(changed);
    }
}

static json_t *renamed(json_t *value, const renaming *names);

static void rename_members(json_t *object, const renaming *names)
{
    const char *key;
    json_t *value;
    json_object_foreach(object, key, value)
    {
        json_t *changed = renamed(value, names);
        if (changed)
            json_object_set_new(object, key, changed);
    }
}

/* The text with its names renamed; NULL: unchanged. Objects and arrays change in place. */
static json_t *renamed(json_t *value, const renaming *names)
{
    if (json_is_object(value))
        rename_members(value, names);
    for (size_t i = 0; i < json_array_size(value); i++) {
        json_t *changed = renamed(json_array_get(value, i), names);
        if (changed)
            json_array_set_new(value, i, changed);
    }
    if (!json_is_string(value))
        return NULL;
    char *copy = strdup(json_string_value(value));
    bool is_changed = false;
    for (int i = 0; i < RENAMING_COUNT && copy; i++) {
        char *changed = replace_all(copy, names[i].from, names[i].to);
        if (changed) {
            free(copy);
            copy = changed;
            is_changed = true;
        }
    }
    json_t *string = is_changed && copy ? report_string_json(copy) : NULL;
    free(copy);
    return string;
}

/* ---- the answer ---- */

/* Adds the bytes that came through the job's output. */
static bool add_output(request *r, job_result *result, answer *out)
{
    if (!r->output[0] || !result->output_size)
        return true;
    out->files = calloc(1, sizeof *out->files);
    char *name = strdup(r->output);
    if (!out->files || !name) {
        free(name);
        return answer_fail(out, ANSWER_TOO_LARGE, "out of memory");
    }
    out->files[out->file_count++] = (answer_file){name, result->output, result->output_size};
    result->output = NULL;
    return true;
}

/* The kind of a job that did not end by itself with an exit code. */
static answer_kind kind_of_end(const job_result *result)
{
    switch (result->end) {
    case JOB_TIMED_OUT:
        return ANSWER_TIMED_OUT;
    case JOB_CANCELLED:
        return ANSWER_CANCELLED;
    case JOB_OVERFLOWED:
        return ANSWER_TOO_LARGE;
    case JOB_KILLED:
        return ANSWER_BUG;
    case JOB_EXITED:
        break;
    }
    bool timed_out = result->message && strstr(result->message, "--time-limit");
    if (result->exit_code <= EXIT_NEGATIVE && !result->report) /* every verb of a request prints one */
        return ANSWER_BUG;
    return answer_kind_of(result->exit_code, timed_out);
}

void request_finish(request *r, job_result *result, answer *out)
{
    char in[FOLDER_PATH_SIZE + 8] = "", made[FOLDER_PATH_SIZE + 8] = "";
    if (r->folder.path[0]) {
        snprintf(in, sizeof in, "%s/in/", r->folder.path);
        snprintf(made, sizeof made, "%s/out/", r->folder.path);
    }
    const renaming names[RENAMING_COUNT] = {
        {in, ""}, {made, ""}, {JOB_OUTPUT, r->output}, {r->input ? "stdin" : "", r->method->inputs[0]}};
    answer_kind kind = kind_of_end(result);
    out->seconds = result->seconds;
    out->report = result->report;
    result->report = NULL;
    json_decref(renamed(out->report, names));
    if (kind != ANSWER_DONE) {
        answer_fail(out, kind, "%s", result->message ? result->message : "it failed without a message");
        if (result->exit_code > EXIT_NEGATIVE)
            out->exit_code = result->exit_code;
        rename_in_text(out->message, sizeof out->message, names);
        return;
    }
    out->exit_code = result->exit_code;
    facet_error error;
    if (add_output(r, result, out) && r->folder.path[0] &&
        folder_collect(&r->folder, REQUEST_MAX_OUTPUT_BYTES, out, &error) != FACET_OK)
        answer_fail(out, ANSWER_TOO_LARGE, "%s", error.message);
}
