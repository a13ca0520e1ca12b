/* cmd_inspect.c - facet inspect: what is in a model. */
#include "cli/commands.h"

#include "cli/failure.h"
#include "cli/input.h"
#include "cli/inspect_text.h"
#include "cli/interrupt.h"
#include "cli/legacy_options.h"
#include "cli/limits.h"
#include "cli/messages.h"
#include "cli/model_list.h"
#include "cli/render_report.h"

#include <stdio.h>
#include <string.h>

/* What all models share. */
typedef struct inspect_run {
    const command_line *line; /* its arguments are all models */
    limits limits;
    messages messages;
    facet_allocator allocator;
    size_t warning_count, failure_count;
} inspect_run;

/* Prints the description text of a scene that was loaded. */
static facet_result print_description(const inspect_run *run, const char *model, const char *text,
                                      facet_error *error)
{
    if (is_given(run->line, OPT_JSON)) {
        puts(text);
        return FACET_OK;
    }
    json_error_t problem;
    json_t *root = json_loads(text, JSON_ALLOW_NUL, &problem);
    if (!root)
        return fail(error, FACET_ERROR_BUG, "%s: its description is not valid JSON: %s", input_name(model),
                    problem.text);
    inspect_print_text(stdout, input_name(model), root, is_given(run->line, OPT_VERBOSE));
    json_decref(root);
    return FACET_OK;
}

static facet_result inspect_model(inspect_run *run, const char *model, facet_error *error)
{
    facet_scene_desc desc = {.allocator = run->allocator,
                             .log = messages_log(&run->messages),
                             .thread_count = run->limits.thread_count,
                             .root = option_text(run->line, OPT_ROOT, NULL),
                             .max_texture_size = run->limits.max_texture_size};
    legacy_options_read(run->line, &desc);
    facet_scene *scene = NULL;
    char *text = NULL;
    facet_result result = input_load(model, &desc, &scene, error);
    if (result == FACET_OK)
        result = facet_scene_describe_json(scene, &text, error);
    if (result == FACET_OK)
        result = print_description(run, model, text, error);
    facet_text_destroy(text);
    facet_scene_destroy(scene);
    return result;
}

/* Inspects all models; the exit code. The description lists the warnings, so they are not printed here. */
static int inspect_all(inspect_run *run)
{
    const command_line *c = run->line;
    int exit_code = EXIT_DONE;
    for (size_t i = 0; i < c->argument_count; i++) {
        facet_error error = {0};
        if (i > 0 && !is_given(c, OPT_JSON))
            putchar('\n');
        interrupt_begin_reading(input_name(c->arguments[i]));
        facet_result result = inspect_model(run, c->arguments[i], &error);
        interrupt_end();
        if (result != FACET_OK) {
            fflush(stdout);
            failure_complete(&error, input_name(c->arguments[i]), run->limits.max_memory_bytes);
            message_error("%s", error.message);
            run->failure_count++;
            exit_code = exit_code_of(result);
            if (is_given(c, OPT_JSON))
                report_print_failure_json(&error, exit_code);
        }
        run->warning_count += run->messages.warning_count;
        messages_clear(&run->messages);
    }
    if (run->failure_count)
        return c->argument_count == 1 ? exit_code : EXIT_NEGATIVE;
    return run->warning_count && is_given(c, OPT_STRICT) ? EXIT_NEGATIVE : EXIT_DONE;
}

int cmd_inspect(command_line *c)
{
    inspect_run run = {
        .line = c, .messages = {.verbosity = is_given(c, OPT_QUIET) ? VERBOSITY_QUIET : VERBOSITY_NORMAL}};
    facet_error error = {0};
    facet_budget *budget = NULL;
    model_list models = {0};
    facet_result result = FACET_OK;
    if (c->argument_count == 0 && !is_given(c, OPT_FILES_FROM))
        result = fail(&error, FACET_ERROR_ARGUMENT, "inspect: which model? facet inspect helmet.glb");
    if (result == FACET_OK)
        result = limits_read(c, &run.limits, &error);
    if (result == FACET_OK)
        interrupt_set_deadline(run.limits.time_limit_s);
    if (result == FACET_OK)
        result = model_list_create(c, c->argument_count, &models, &error);
    if (result == FACET_OK)
        result = facet_budget_create(run.limits.max_memory_bytes, &budget, &error);
    if (result != FACET_OK) {
        bool is_ours = error.message[0] == '-' || strncmp(error.message, "inspect:", 8) == 0;
        message_error("%s%s", is_ours ? "facet: " : "", error.message);
        if (is_given(c, OPT_JSON))
            report_print_failure_json(&error, exit_code_of(result));
        model_list_destroy(&models);
        facet_budget_destroy(budget);
        return exit_code_of(result);
    }
    run.allocator = facet_budget_allocator(budget);
    int exit_code = inspect_all(&run);
    model_list_destroy(&models);
    facet_budget_destroy(budget);
    return exit_code;
}
