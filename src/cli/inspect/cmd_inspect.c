/* cmd_inspect.c - facet inspect: the contents of models. */
#include "cli/shared/options.h"

#include "cli/inspect/inspect_text.h"
#include "cli/shared/failure.h"
#include "cli/shared/input.h"
#include "cli/shared/interrupt.h"
#include "cli/shared/verb_run.h"

#include <stdio.h>
#include <string.h>

const verb inspect_verb = {
    .name = "inspect",
    .summary = "print what is in a model",
    .arguments = "MODEL|FOLDER...",
    .max_arguments = SIZE_MAX,
    .file_types = "glb gltf obj stl ply json",
    .output_types = "txt",
    .output_hint = ">",
    .description =
        "Reads each MODEL (.glb, .gltf, .obj with its .mtl, .stl, .ply, .json of rgl's parameters; - "
        "is standard input) and prints counts, bounds, materials, textures, images, cameras, lights, "
        "the extensions and how facet supports them, and the warnings of reading. With -v lists are "
        "printed in full.\n\n"
        "The exit code is 0 if the model can be read, also with warnings (--strict: 1).",
    .examples =
        (const example[]){{"facet inspect helmet.glb", "as text"},
                          {"facet inspect helmet.glb --json | jq .materials", "as JSON"},
                          {"facet inspect --strict models/", "check all models in a folder and below it"},
                          {NULL, NULL}},
    .basics = OPTION_IDS(OPT_JSON, OPT_VERBOSE, OPT_STRICT, OPT_FILES_FROM, OPT_ROOT, OPT_TIME_LIMIT,
                         OPT_MAX_MEMORY),
    .groups =
        (const option_group *const[]){&files_group, &legacy_group, &limits_group, &messages_group, NULL},
};

typedef struct inspect_run {
    verb_run base;
    model_list models;
} inspect_run;

/* Prints the description of a loaded scene, JSON text. */
static facet_result print_description(const inspect_run *run, const char *model, const char *text,
                                      facet_error *error)
{
    if (is_given(run->base.line, OPT_JSON)) {
        puts(text);
        return FACET_OK;
    }
    json_error_t problem;
    json_t *root = json_loads(text, JSON_ALLOW_NUL, &problem);
    if (!root)
        return fail(error, FACET_ERROR_BUG, "%s: its description is not valid JSON: %s", input_name(model),
                    problem.text);
    inspect_print_text(stdout, input_name(model), root, is_given(run->base.line, OPT_VERBOSE));
    json_decref(root);
    return FACET_OK;
}

static facet_result inspect_model(inspect_run *run, const char *model, facet_error *error)
{
    const facet_scene_desc desc = verb_run_scene_desc(&run->base);
    facet_scene *scene = NULL;
    char *text = NULL;
    interrupt_begin_reading(input_name(model));
    facet_result result = input_load(model, &desc, &scene, error);
    if (result == FACET_OK)
        result = facet_scene_describe_json(scene, &text, error);
    if (result == FACET_OK)
        result = print_description(run, model, text, error);
    interrupt_end();
    facet_text_destroy(text);
    facet_scene_destroy(scene);
    return result;
}

static facet_result inspect_one(verb_run *base, size_t i, facet_error *error)
{
    inspect_run *run = (inspect_run *)base;
    const char *model = run->models.models[i].path;
    if (i > 0 && !is_given(base->line, OPT_JSON))
        putchar('\n');
    facet_result result = inspect_model(run, model, error);
    if (result != FACET_OK)
        failure_complete(error, input_name(model), base->limits.max_memory_bytes);
    return result;
}

static facet_result read_line(verb_run *base, facet_error *error)
{
    command_line *c = base->line;
    if (c->argument_count == 0 && !is_given(c, OPT_FILES_FROM))
        return fail(error, FACET_ERROR_ARGUMENT, "inspect: which model? facet inspect helmet.glb");
    TRY(limits_read(c, &base->limits, error));
    return model_list_create(c, c->argument_count, &((inspect_run *)base)->models, error);
}

static facet_result inspect(verb_run *base, facet_error *error)
{
    (void)error;
    base->messages.verbosity = VERBOSITY_QUIET; /* the description lists the warnings */
    verb_run_models(base, &((inspect_run *)base)->models, inspect_one);
    return FACET_OK;
}

static void destroy(verb_run *base)
{
    model_list_destroy(&((inspect_run *)base)->models);
}

int cmd_inspect(command_line *c)
{
    static const verb_work work = {read_line, inspect, NULL, destroy}; /* it prints an object per model */
    inspect_run run = {.models = {.count = 0}};
    return verb_run_all(&run.base, c, &work);
}
