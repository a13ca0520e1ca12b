/* config.c - options from a JSON file (--config). */
#define _DEFAULT_SOURCE
#define _POSIX_C_SOURCE 200809L
#include "cli/shared/failure.h"
#include "cli/shared/interrupt.h"
#include "cli/shared/limits.h"
#include "cli/shared/command_line.h"
#include "cli/shared/suggest.h"

#include <errno.h>
#include <jansson.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>

/* Keeps text until config_destroy(); NULL: no memory. */
static const char *keep(config *storage, const char *text)
{
    char **grown = realloc(storage->texts, (storage->text_count + 1) * sizeof *grown);
    if (!grown)
        return NULL;
    storage->texts = grown;
    char *copy = strdup(text);
    if (copy)
        storage->texts[storage->text_count++] = copy;
    return copy;
}

void config_destroy(config *storage)
{
    for (size_t i = 0; i < storage->text_count; i++)
        free(storage->texts[i]);
    free(storage->texts);
    *storage = (config){0};
}

/* Appends a string or number to text in command line notation. False: another type, or too long. */
static bool append_scalar(const json_t *value, char *text, size_t size)
{
    size_t used = strlen(text);
    int n = -1;
    if (json_is_string(value))
        n = snprintf(text + used, size - used, "%s", json_string_value(value));
    else if (json_is_integer(value))
        n = snprintf(text + used, size - used, "%" JSON_INTEGER_FORMAT, json_integer_value(value));
    else if (json_is_real(value))
        n = snprintf(text + used, size - used, "%.17g", json_real_value(value));
    return n >= 0 && (size_t)n < size - used;
}

bool config_value_text(const json_t *value, char *text, size_t size)
{
    text[0] = 0;
    if (!json_is_array(value))
        return append_scalar(value, text, size);
    size_t i;
    json_t *element;
    json_array_foreach(value, i, element)
    {
        size_t used = strlen(text);
        if (i > 0 && used + 1 < size)
            memcpy(text + used, ",", 2);
        if (!append_scalar(element, text, size))
            return false;
    }
    return true;
}

long config_flag_count(const option *o, const json_t *value)
{
    if (json_is_boolean(value))
        return json_is_true(value);
    if (o->kind == OPTION_COUNT && json_is_integer(value) && json_integer_value(value) <= 9)
        return (long)json_integer_value(value);
    return -1;
}

static facet_result apply_value(command_line *c, const option *o, const char *name, const json_t *value,
                                config *storage, facet_error *error)
{
    char text[CONFIG_TEXT_SIZE];
    if (!config_value_text(value, text, sizeof text))
        return fail(error, FACET_ERROR_ARGUMENT, "%s: %s: it must be text, a number or an array of these",
                    c->config_name, name);
    const char *kept = keep(storage, text);
    if (!kept)
        return fail(error, FACET_ERROR_MEMORY, "%s: out of memory", c->config_name);
    return command_line_set(c, o, kept, SOURCE_CONFIG, error);
}

static facet_result apply_member(command_line *c, const char *name, const json_t *value, config *storage,
                                 facet_error *error)
{
    const char *path = c->config_name;
    const option *o = option_find(c->verb, name, strlen(name));
    if (!o) {
        o = option_find_attribute(c->verb, name, strlen(name));
        c->has_attributes = c->has_attributes || o;
    }
    if (!o) {
        facet_error suggestion;
        suggest_option(c->verb, name, strlen(name), &suggestion);
        return fail(error, FACET_ERROR_ARGUMENT, "%s: %.900s", path, suggestion.message);
    }
    if (o->id == OPT_CONFIG || o->id == OPT_HELP || o->id == OPT_HELP_ALL)
        return fail(error, FACET_ERROR_ARGUMENT, "%s: %s: it cannot be given in a file", path, name);
    if (is_given(c, o->id))
        return FACET_OK;
    if (!option_takes_value(o)) {
        long count = config_flag_count(o, value);
        if (count < 0)
            return fail(error, FACET_ERROR_ARGUMENT, "%s: %s: it must be true or false", path, name);
        facet_result result = FACET_OK;
        for (; count > 0 && result == FACET_OK; count--)
            result = command_line_set(c, o, NULL, SOURCE_CONFIG, error);
        return result;
    }
    size_t count = o->kind == OPTION_TEXTS && json_is_array(value) ? json_array_size(value) : 0;
    for (size_t i = 0; i < count; i++)
        TRY(apply_value(c, o, name, json_array_get(value, i), storage, error));
    return count ? FACET_OK : apply_value(c, o, name, value, storage, error);
}

/* The whole file in *text, for free(). */
static facet_result read_config(const char *path, char **text, size_t *size, facet_error *error)
{
    enum { MAX_BYTES = 1 << 20 };
    FILE *file = fopen(path, "re");
    if (!file)
        return fail(error, FACET_ERROR_READ, "%s: %s", path, strerror(errno));
    *text = malloc(MAX_BYTES + 1);
    *size = *text ? fread(*text, 1, MAX_BYTES + 1, file) : 0;
    facet_result result = FACET_OK;
    if (!*text)
        result = fail(error, FACET_ERROR_MEMORY, "%s: out of memory", path);
    else if (ferror(file))
        result = fail(error, FACET_ERROR_READ, "%s: %s", path, strerror(errno));
    else if (*size > MAX_BYTES)
        result = fail(error, FACET_ERROR_LIMIT, "%s: it is larger than 1 MiB; options were expected", path);
    fclose(file);
    if (result != FACET_OK) {
        free(*text);
        *text = NULL;
    }
    return result;
}

facet_result config_apply(command_line *c, config *storage, facet_error *error)
{
    const char *path = option_text(c, OPT_CONFIG, NULL);
    if (!path)
        return FACET_OK;
    char *text = NULL;
    size_t size = 0;
    facet_result read = limits_start_clock(c, error);
    if (read == FACET_OK) {
        interrupt_begin_reading(path);
        read = read_config(path, &text, &size, error);
        interrupt_end();
    }
    if (read != FACET_OK)
        return read;
    json_error_t problem;
    json_t *root = json_loadb(text, size, JSON_REJECT_DUPLICATES, &problem);
    free(text);
    if (!root)
        return fail(error, FACET_ERROR_ARGUMENT, "%s: line %d: %s", path, problem.line, problem.text);
    facet_result result = FACET_OK;
    c->config_name = path;
    if (!json_is_object(root))
        result = fail(error, FACET_ERROR_ARGUMENT, "%s: it must hold one JSON object", path);
    const char *name;
    json_t *value;
    json_object_foreach(root, name, value)
    {
        if (result == FACET_OK)
            result = apply_member(c, name, value, storage, error);
    }
    json_decref(root);
    return result;
}

typedef struct setting {
    option_id id;
    const char *text; /* NULL for flags */
} setting;

/* A three-quarter view with the shadow on the ground, with room for it. */
#define PRODUCT_VIEW                                                                                         \
    {OPT_ORBIT, "30,70,110%"},                                                                               \
    {                                                                                                        \
        OPT_GROUND, "shadow"                                                                                 \
    }

/* Settings for file managers: small, bounded, silent, and soon there: draft quality halves the rays, and edges keep the
 * samples of normal quality. */
static const setting thumbnail[] = {PRODUCT_VIEW,
                                    {OPT_SIZE, "256"},
                                    {OPT_QUALITY, "draft"},
                                    {OPT_SAMPLES, "4"},
                                    {OPT_BACKGROUND, "transparent"},
                                    {OPT_MAX_MEMORY, "1G"}};
/* Settings for shops and pages: large and smooth. */
static const setting product[] = {PRODUCT_VIEW, {OPT_SIZE, "1600"}, {OPT_QUALITY, "final"}};

/* Whether an option that is given makes one of a preset's impossible: other cameras, a ground below +Y. */
static bool is_excluded(const command_line *c, option_id id)
{
    static const option_id cameras[] = {OPT_EYE, OPT_CAMERA, OPT_CAMERA_MATRIX, OPT_VIEW_MATRIX};
    for (size_t i = 0; id == OPT_ORBIT && i < sizeof cameras / sizeof *cameras; i++)
        if (is_given(c, cameras[i]))
            return true;
    return id == OPT_GROUND && option_choice(c, OPT_UP, 0) == 1;
}

static facet_result apply_settings(command_line *c, const setting *settings, size_t count, facet_error *error)
{
    for (size_t i = 0; i < count; i++)
        if (!is_excluded(c, settings[i].id))
            TRY(command_line_set(c, option_find_id(c->verb, settings[i].id), settings[i].text, SOURCE_PRESET,
                                 error));
    return FACET_OK;
}

static facet_result apply_thumbnail(command_line *c, facet_error *error)
{
    /* 15 s for each model: file managers remember failures, and machines may be busy. A command
     * line lives as long as the process. */
    static char limit[32];
    snprintf(limit, sizeof limit, "%zus", 15 * (c->argument_count ? c->argument_count : 1));
    TRY(command_line_set(c, option_find_id(c->verb, OPT_TIME_LIMIT), limit, SOURCE_PRESET, error));
    if (!is_given(c, OPT_VERBOSE))
        TRY(command_line_set(c, option_find_id(c->verb, OPT_QUIET), NULL, SOURCE_PRESET, error));
    TRY(apply_settings(c, thumbnail, sizeof thumbnail / sizeof *thumbnail, error));
    /* concurrent thumbnailers must not occupy every core (f3d issue 300) */
    if (getpriority(PRIO_PROCESS, 0) > 0)
        return command_line_set(c, option_find_id(c->verb, OPT_THREADS), "1", SOURCE_PRESET, error);
    return FACET_OK;
}

facet_result preset_apply(command_line *c, facet_error *error)
{
    if (!is_given(c, OPT_PRESET))
        return FACET_OK;
    if (option_choice(c, OPT_PRESET, 0) == 0)
        return apply_thumbnail(c, error);
    return apply_settings(c, product, sizeof product / sizeof *product, error);
}
