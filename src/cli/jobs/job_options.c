/* job_options.c - see job_options.h. */
#define _GNU_SOURCE
#include "cli/jobs/job_options.h"

#include "cli/shared/command_line.h"
#include "cli/shared/failure.h"
#include "cli/shared/suggest.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Takes word, from malloc(). */
static void take(job_words *w, char *word)
{
    if (word && w->count + 1 >= w->capacity) {
        size_t capacity = w->capacity ? 2 * w->capacity : 32;
        char **grown = realloc(w->words, capacity * sizeof *grown);
        if (grown) {
            w->words = grown;
            w->capacity = capacity;
        }
    }
    if (!word || w->count + 1 >= w->capacity) {
        free(word);
        w->has_failed = true;
        return;
    }
    w->words[w->count++] = word;
    w->words[w->count] = NULL;
}

void job_words_add(job_words *w, const char *word)
{
    take(w, strdup(word));
}

void job_words_addf(job_words *w, const char *format, ...)
{
    char *word = NULL;
    va_list arguments;
    va_start(arguments, format);
    if (vasprintf(&word, format, arguments) < 0)
        word = NULL;
    va_end(arguments);
    take(w, word);
}

void job_words_add_all(job_words *w, const char *const *words)
{
    for (size_t i = 0; words && words[i]; i++)
        job_words_add(w, words[i]);
}

void job_words_destroy(job_words *w)
{
    for (size_t i = 0; i < w->count; i++)
        free(w->words[i]);
    free(w->words);
    *w = (job_words){0};
}

/* ---- options of an object ---- */

static facet_result add_value(job_words *w, const char *name, const json_t *value, const char *place,
                              facet_error *error)
{
    char text[CONFIG_TEXT_SIZE];
    if (!config_value_text(value, text, sizeof text))
        return fail(error, FACET_ERROR_ARGUMENT, "%s: %s: it must be text, a number or an array of these",
                    place, name);
    job_words_addf(w, "--%s=%s", name, text);
    return FACET_OK;
}

static facet_result add_member(job_words *w, const verb *v, const char *name, const json_t *value,
                               const char *place, facet_error *error)
{
    const option *o = option_find(v, name, strlen(name));
    if (!o)
        o = option_find_attribute(v, name, strlen(name));
    if (!o) {
        facet_error suggestion;
        suggest_option(v, name, strlen(name), &suggestion);
        return fail(error, FACET_ERROR_ARGUMENT, "%s: %.900s", place, suggestion.message);
    }
    if (option_is_among(o->id, OPTION_IDS(OPT_CONFIG, OPT_HELP, OPT_HELP_ALL, OPT_JSON)))
        return fail(error, FACET_ERROR_ARGUMENT, "%s: %s: it cannot be an option of a single item", place,
                    name);
    if (!option_takes_value(o)) {
        long count = config_flag_count(o, value);
        if (count < 0)
            return fail(error, FACET_ERROR_ARGUMENT, "%s: %s: it must be true or false", place, name);
        for (; count > 0; count--)
            job_words_addf(w, "--%s", name);
        return FACET_OK;
    }
    size_t count = o->kind == OPTION_TEXTS && json_is_array(value) ? json_array_size(value) : 0;
    for (size_t i = 0; i < count; i++)
        TRY(add_value(w, name, json_array_get(value, i), place, error));
    return count ? FACET_OK : add_value(w, name, value, place, error);
}

static bool is_among(const char *name, const char *const *list)
{
    for (; list && *list; list++)
        if (strcmp(name, *list) == 0)
            return true;
    return false;
}

facet_result job_options_add(job_words *w, const verb *v, const json_t *object, const char *const *skipped,
                             const char *place, facet_error *error)
{
    const char *name;
    json_t *value;
    json_object_foreach((json_t *)(uintptr_t)object, name, value)
    {
        if (!is_among(name, skipped))
            TRY(add_member(w, v, name, value, place, error));
    }
    return FACET_OK;
}

facet_result job_words_check(const job_words *w, facet_error *error)
{
    command_line line = {.verb = NULL};
    if (w->has_failed)
        return fail_memory(error, "the words of a job", 0);
    const verb *v = verb_find(w->words[0]);
    if (!v)
        return fail(error, FACET_ERROR_ARGUMENT, "there is no command \"%.60s\"", w->words[0]);
    facet_result result = command_line_parse(v, (int)w->count - 1, w->words + 1, &line, error);
    command_line_destroy(&line);
    return result;
}
