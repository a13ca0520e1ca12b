/* cmd_convert.c - facet convert: a model in another form. */
#include "cli/commands.h"

#include "cli/failure.h"
#include "cli/input.h"
#include "cli/interrupt.h"
#include "cli/limits.h"
#include "cli/messages.h"
#include "cli/model_files.h"
#include "cli/output.h"
#include "cli/render_report.h"

#include <stdio.h>
#include <string.h>
#include <strings.h>

/* IN OUT, or IN with --output. */
static facet_result find_names(const command_line *c, const char **in, const char **out, facet_error *error)
{
    *out = option_text(c, OPT_OUTPUT, NULL);
    size_t wanted = *out ? 1 : 2;
    if (c->argument_count != wanted)
        return fail_with(error, FACET_ERROR_ARGUMENT,
                         "convert: one model and the name of the new one were expected, as in facet convert "
                         "old.gltf new.glb");
    *in = c->arguments[0];
    *out = *out ? *out : c->arguments[1];
    const char *dot = strrchr(*out, '.');
    if (!dot || (strcasecmp(dot, ".glb") != 0 && strcasecmp(dot, ".gltf") != 0))
        return fail_with(error, FACET_ERROR_ARGUMENT, "convert: \"%s\" does not end in .glb or .gltf", *out);
    if (output_exists(*out) && strcmp(*in, "-") != 0 &&
        (input_is_same_file(*in, *out) || model_has_file(*in, *out)))
        return fail_with(error, FACET_ERROR_ARGUMENT,
                         "%s: it is an input, too, and would be overwritten; name another output", *out);
    char lost[4096];
    if (strcasecmp(dot, ".gltf") == 0 && strcmp(*in, "-") != 0 &&
        model_loses_file(*in, *out, lost, sizeof lost))
        return fail_with(error, FACET_ERROR_ARGUMENT,
                         "%s: %s, which belongs to %s, would be overwritten; name another output", *out, lost,
                         *in);
    return output_check(*out, error);
}

typedef struct convert_run {
    const command_line *line;
    limits limits;
    messages messages;
    facet_allocator allocator;
    const char *in, *out;
    double start;
} convert_run;

static facet_result convert(convert_run *run, facet_error *error)
{
    const facet_scene_desc desc = {.allocator = run->allocator,
                                   .log = messages_log(&run->messages),
                                   .thread_count = run->limits.thread_count,
                                   .root = option_text(run->line, OPT_ROOT, NULL),
                                   .max_texture_size = run->limits.max_texture_size};
    const facet_scene_save_desc save = {.allocator = run->allocator,
                                        .log = messages_log(&run->messages),
                                        .thread_count = run->limits.thread_count};
    facet_scene *scene = NULL;
    interrupt_begin_reading(input_name(run->in));
    facet_result result = input_load(run->in, &desc, &scene, error);
    interrupt_set_safe(NULL);
    messages_flush(&run->messages);
    if (result == FACET_OK && interrupt_signal())
        result = fail_with(error, FACET_ERROR_CANCELLED, "%s: interrupted", run->out);
    if (result == FACET_OK)
        result = facet_scene_save(scene, run->out, &save, error);
    messages_flush(&run->messages);
    facet_scene_destroy(scene);
    return result;
}

static void print_json(const convert_run *run, facet_result result, const facet_error *error, int exit_code)
{
    json_t *failures = json_array();
    if (result != FACET_OK)
        json_array_append_new(failures, report_error_json(error, run->in, exit_code));
    json_t *root = json_pack("{s:s, s:o, s:o, s:o, s:o, s:f, s:i}", "facet", facet_version(), "input",
                             report_string_json(run->in), "output",
                             report_string_json(result == FACET_OK ? run->out : NULL), "failures", failures,
                             "warnings", report_warnings_json(&run->messages), "seconds",
                             interrupt_clock() - run->start, "exit_code", exit_code);
    report_print_json(root);
    json_decref(root);
}

int cmd_convert(command_line *c)
{
    convert_run run = {.line = c,
                       .messages = {.verbosity = is_given(c, OPT_QUIET)     ? VERBOSITY_QUIET
                                                 : is_given(c, OPT_VERBOSE) ? VERBOSITY_DETAILS
                                                                            : VERBOSITY_NORMAL},
                       .start = interrupt_clock()};
    facet_error error = {0};
    facet_budget *budget = NULL;
    interrupt_install();
    facet_result result = find_names(c, &run.in, &run.out, &error);
    if (result == FACET_OK && is_given(c, OPT_NO_CLOBBER) && output_exists(run.out)) {
        message_at(&run.messages, VERBOSITY_NORMAL, "%s: kept; it was there already", run.out);
        return EXIT_DONE;
    }
    if (result == FACET_OK)
        result = limits_read(c, &run.limits, &error);
    if (result == FACET_OK)
        result = facet_budget_create(run.limits.max_memory_bytes, &budget, &error);
    if (result == FACET_OK) {
        interrupt_set_deadline(run.limits.time_limit_s);
        run.allocator = facet_budget_allocator(budget);
        result = convert(&run, &error);
    }
    int exit_code = result != FACET_OK                                      ? exit_code_of(result)
                    : run.messages.warning_count && is_given(c, OPT_STRICT) ? EXIT_NEGATIVE
                                                                            : EXIT_DONE;
    if (result != FACET_OK && run.in)
        failure_complete(&error,
                         strncmp(error.message, run.out, strlen(run.out)) == 0 ? run.out : input_name(run.in),
                         run.limits.max_memory_bytes);
    if (result != FACET_OK)
        message_error("%s%s", strncmp(error.message, "convert:", 8) == 0 ? "facet: " : "", error.message);
    else
        message_at(&run.messages, VERBOSITY_DETAILS, "%s: %.2f s", run.out, interrupt_clock() - run.start);
    if (is_given(c, OPT_JSON))
        print_json(&run, result, &error, exit_code);
    messages_clear(&run.messages);
    facet_budget_destroy(budget);
    if (result == FACET_ERROR_CANCELLED)
        return interrupt_exit();
    return exit_code;
}
