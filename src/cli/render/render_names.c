/* render_names.c - what the pictures of facet render are called. */
#include "cli/render/render_names.h"

#include "cli/shared/failure.h"
#include "cli/shared/input.h"
#include "cli/shared/output.h"
#include "cli/shared/output_name.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

facet_result render_checkpoint_name(const render_options *o, const model_name *model, uint32_t number,
                                    char *name, size_t size, facet_error *error)
{
    *name = 0;
    if (!o->checkpoint || output_name_expand(o->checkpoint, model, &number, name, size))
        return FACET_OK;
    return fail(error, FACET_ERROR_ARGUMENT, "--checkpoint: the name for %s is too long",
                input_name(model->path));
}

facet_result render_name(const render_options *o, const model_name *model, uint32_t number, char *name,
                         size_t size, facet_error *error)
{
    if (o->is_stdout) {
        memcpy(name, "-", 2);
        return FACET_OK;
    }
    char pattern[64];
    const char *used = o->output;
    if (!used) {
        snprintf(pattern, sizeof pattern, o->is_sequence && !o->video ? "{stem}_####.%s" : "{stem}.%s",
                 o->video == VIDEO_Y4M ? "y4m" : render_extension(o->save.format));
        used = pattern;
    }
    if (!output_name_expand(used, model, &number, name, size))
        return fail(error, FACET_ERROR_ARGUMENT, "--output: the name for %s is too long",
                    input_name(model->path));
    return FACET_OK;
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
static facet_result check_checkpoint(const command_line *c, const render_options *o, const model_name *model,
                                     const char *picture, facet_error *error)
{
    char name[RENDER_NAME_SIZE];
    facet_result result = render_checkpoint_name(o, model, 1, name, sizeof name, error);
    if (result != FACET_OK || !o->checkpoint)
        return result;
    result = output_check(name, error);
    if (result == FACET_OK && output_exists(name) &&
        (render_name_is_input(c, o, model->path, name) ||
         (output_exists(picture) && input_is_same_file(name, picture))))
        result = fail(error, FACET_ERROR_ARGUMENT,
                      "--checkpoint: %s is an input or the picture, too, and would be overwritten", name);
    return result;
}

/* The first picture of a model, or, of a clash, nothing more than its name. */
static facet_result check_model(const command_line *c, const render_options *o, const model_name *model,
                                output_claim *claim, facet_error *error)
{
    char name[RENDER_NAME_SIZE];
    facet_result result = render_name(o, model, 1, name, sizeof name, error);
    if (result == FACET_OK)
        result = output_check(name, error);
    if (result == FACET_OK && render_name_is_input(c, o, model->path, name))
        result = fail(error, FACET_ERROR_ARGUMENT,
                      "%s: it is an input, too, and would be overwritten; name another output with -o", name);
    if (result == FACET_OK)
        result = check_checkpoint(c, o, model, name, error);
    if (result == FACET_OK && !(claim->identity = output_identity(name)))
        result = fail(error, FACET_ERROR_MEMORY, "out of memory: names");
    return result;
}

facet_result render_names_check(const command_line *c, const render_options *o, model_list *models,
                                facet_error *error)
{
    size_t count = models->count;
    output_claim *claims = calloc(count, sizeof *claims);
    facet_result result = claims ? FACET_OK : fail(error, FACET_ERROR_MEMORY, "out of memory: names");
    for (size_t i = 0; i < count && result == FACET_OK; i++) {
        claims[i].model = i;
        result = check_model(c, o, &models->models[i], &claims[i], error);
    }
    if (result == FACET_OK && !o->is_stdout)
        model_list_find_clashes(models, claims, count);
    for (size_t i = 0; claims && i < count; i++)
        free(claims[i].identity);
    free(claims);
    return result;
}
