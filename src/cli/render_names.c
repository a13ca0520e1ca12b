/* render_names.c - what the pictures of facet render are called. */
#include "cli/render_names.h"

#include "cli/failure.h"
#include "cli/input.h"
#include "cli/output.h"
#include "cli/output_name.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static bool find_stem(const char *model, char *stem, size_t size)
{
    const char *path = !model ? "facet" : strcmp(model, "-") == 0 ? "stdin" : model;
    return output_name_stem(path, stem, size);
}

facet_result render_checkpoint_name(const render_options *o, const char *model, uint32_t number, char *name,
                                    size_t size, facet_error *error)
{
    char stem[1024];
    *name = 0;
    if (!o->checkpoint ||
        (find_stem(model, stem, sizeof stem) && output_name_expand(o->checkpoint, stem, number, name, size)))
        return FACET_OK;
    return fail_with(error, FACET_ERROR_ARGUMENT, "--checkpoint: the name for %s is too long",
                     input_name(model));
}

facet_result render_name(const render_options *o, const char *model, uint32_t number, char *name, size_t size,
                         facet_error *error)
{
    if (o->is_stdout) {
        memcpy(name, "-", 2);
        return FACET_OK;
    }
    char stem[1024], pattern[64];
    const char *used = o->output;
    bool fits = find_stem(model, stem, sizeof stem);
    if (!used) {
        snprintf(pattern, sizeof pattern, o->is_sequence && !o->video ? "{stem}_####.%s" : "{stem}.%s",
                 o->video == VIDEO_Y4M ? "y4m" : render_extension(o->save.format));
        used = pattern;
    }
    if (fits)
        fits = output_name_expand(used, stem, number, name, size);
    if (!fits)
        return fail_with(error, FACET_ERROR_ARGUMENT, "--output: the name for %s is too long",
                         input_name(model));
    return FACET_OK;
}

static int compare_names(const void *a, const void *b)
{
    return strcmp(*(char *const *)a, *(char *const *)b);
}

bool render_name_is_input(const command_line *c, const render_options *o, const char *model, const char *name)
{
    const char *config_path = option_text(c, OPT_CONFIG, NULL);
    if (o->is_stdout || o->keeps_existing || !output_exists(name))
        return false;
    return (model && strcmp(model, "-") != 0 && input_is_same_file(model, name)) ||
           environment_input_is_file(&o->environment, name) ||
           (config_path && input_is_same_file(name, config_path));
}

/* A checkpoint takes the place of nothing but an earlier one; that it is one is found when it is read. */
static facet_result check_checkpoint(const command_line *c, const render_options *o, const char *model,
                                     const char *picture, facet_error *error)
{
    char name[RENDER_NAME_SIZE];
    facet_result result = render_checkpoint_name(o, model, 1, name, sizeof name, error);
    if (result != FACET_OK || !o->checkpoint)
        return result;
    result = output_check(name, error);
    if (result == FACET_OK && output_exists(name) &&
        (render_name_is_input(c, o, model, name) ||
         (output_exists(picture) && input_is_same_file(name, picture))))
        result =
            fail_with(error, FACET_ERROR_ARGUMENT,
                      "--checkpoint: %s is an input or the picture, too, and would be overwritten", name);
    return result;
}

facet_result render_names_check(const command_line *c, const render_options *o, facet_error *error)
{
    size_t count = c->argument_count ? c->argument_count : 1, done = 0;
    char **names = calloc(count, sizeof *names);
    facet_result result = names ? FACET_OK : fail_with(error, FACET_ERROR_MEMORY, "out of memory: names");
    for (size_t i = 0; i < count && result == FACET_OK; i++) {
        const char *model = c->argument_count ? c->arguments[i] : NULL;
        char name[RENDER_NAME_SIZE];
        result = render_name(o, model, 1, name, sizeof name, error);
        if (result == FACET_OK)
            result = output_check(name, error);
        if (result == FACET_OK && render_name_is_input(c, o, model, name))
            result = fail_with(
                error, FACET_ERROR_ARGUMENT,
                "%s: it is an input, too, and would be overwritten; name another output with -o", name);
        if (result == FACET_OK)
            result = check_checkpoint(c, o, model, name, error);
        if (result == FACET_OK) {
            names[i] = malloc(strlen(name) + 1);
            if (names[i])
                memcpy(names[i], name, strlen(name) + 1);
            else
                result = fail_with(error, FACET_ERROR_MEMORY, "out of memory: names");
            done += names[i] != NULL;
        }
    }
    if (result == FACET_OK && !o->is_stdout) {
        qsort(names, count, sizeof *names, compare_names);
        for (size_t i = 1; i < count && result == FACET_OK; i++)
            if (strcmp(names[i - 1], names[i]) == 0)
                result = fail_with(error, FACET_ERROR_ARGUMENT,
                                   "--output: two models would both be written to %s", names[i]);
    }
    for (size_t i = 0; i < done; i++)
        free(names[i]);
    free(names);
    return result;
}
