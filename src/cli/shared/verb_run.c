/* verb_run.c - see verb_run.h. */
#include "cli/shared/verb_run.h"

#include "cli/shared/failure.h"
#include "cli/shared/input.h"
#include "cli/shared/interrupt.h"
#include "cli/shared/limits.h"
#include "cli/shared/command_line.h"

#include <stdio.h>
#include <string.h>

/* ---- failures ---- */

/* Prints the sentence, after "facet: " if its subject is an option or the verb instead of a file. */
static void print_error(const verb_run *run, const facet_error *error)
{
    const char *name = run->line->verb->name;
    size_t length = strlen(name);
    bool is_of_words = error->message[0] == '-' ||
                       (strncmp(error->message, name, length) == 0 && error->message[length] == ':');
    message_error("%s%s", is_of_words ? "facet: " : "", error->message);
}

/* The exit code; after a signal that of the signal. */
static int code_of(const facet_error *error)
{
    return error->result == FACET_ERROR_CANCELLED ? interrupt_exit_code() : exit_code_of(error->result);
}

/* Records a failure; model NULL: none. */
static void add_failure(verb_run *run, const facet_error *error, const char *model)
{
    run->failure_count++;
    run->failure_code = code_of(error);
    if (run->failures)
        json_array_append_new(run->failures, report_error_json(error, model, run->failure_code));
}

static json_t *warnings_json(const messages *m)
{
    json_t *list = json_array();
    for (size_t i = 0; i < m->warning_count; i++) {
        json_array_append_new(list, json_pack("{s:o, s:I}", "text", report_string_json(m->warnings[i].text),
                                              "count", (json_int_t)m->warnings[i].count));
    }
    return list;
}

/* Prints, records and clears the warnings. */
static void end_messages(verb_run *run)
{
    messages_flush(&run->messages);
    run->warning_count += run->messages.warning_count;
    if (run->warnings) {
        json_t *list = warnings_json(&run->messages);
        json_array_extend(run->warnings, list);
        json_decref(list);
    }
    messages_clear(&run->messages);
}

/* ---- several models ---- */

static void fail_model(verb_run *run, const char *name, const facet_error *error)
{
    messages_flush(&run->messages);
    fflush(stdout);
    message_error("%s", error->message);
    add_failure(run, error, name);
    if (is_given(run->line, OPT_JSON) && !run->work->add_json)
        report_print_failure_json(error, run->failure_code);
}

void verb_run_models(verb_run *run, const model_list *models,
                     facet_result (*each)(verb_run *run, size_t index, facet_error *error))
{
    bool is_stdout = strcmp(option_text(run->line, OPT_OUTPUT, ""), "-") == 0;
    run->input_count = models->count;
    for (size_t i = 0; i < models->count && !run->is_interrupted; i++) {
        facet_error error = {0};
        facet_result result = each(run, i, &error);
        if (result != FACET_OK)
            fail_model(run, input_name(models->models[i].path), &error);
        end_messages(run);
        if (interrupt_signal() && (result != FACET_OK || i + 1 < models->count))
            run->is_interrupted = true;
        if (result == FACET_ERROR_WRITE && is_stdout)
            break;
    }
}

/* ---- one run ---- */

facet_environment_desc verb_run_environment_desc(verb_run *run, const char *cache_folder)
{
    return (facet_environment_desc){.allocator = run->allocator,
                                    .log = messages_log(&run->messages),
                                    .thread_count = run->limits.thread_count,
                                    .cache_folder = cache_folder};
}

facet_scene_desc verb_run_scene_desc(verb_run *run)
{
    const command_line *c = run->line;
    facet_scene_desc desc = {.allocator = run->allocator,
                             .log = messages_log(&run->messages),
                             .thread_count = run->limits.thread_count,
                             .root = option_text(c, OPT_ROOT, NULL),
                             .max_texture_size = run->limits.max_texture_size};
    facet_legacy_desc *l = &desc.legacy; /* choices are in the order of the enumerations */
    l->method = (facet_legacy_method)option_choice(c, OPT_METHOD, FACET_LEGACY_METHOD_CLOSED);
    l->profile = (facet_legacy_profile)option_choice(c, OPT_PROFILE, FACET_LEGACY_PROFILE_SPECULAR_IOR);
    l->target = (facet_legacy_target)option_choice(c, OPT_FIT_TARGET, FACET_LEGACY_TARGET_AUTO);
    if (is_given(c, OPT_MTL_COLORS)) /* otherwise as the file says */
        l->colors =
            option_choice(c, OPT_MTL_COLORS, 0) ? FACET_LEGACY_COLORS_LINEAR : FACET_LEGACY_COLORS_SRGB;
    l->dialect = (facet_mtl_dialect)option_choice(c, OPT_DIALECT, FACET_MTL_DIALECT_AUTO);
    l->illum = (facet_mtl_illum)option_choice(c, OPT_ILLUM, FACET_MTL_ILLUM_AUTO);
    l->ambient = (facet_legacy_ambient)option_choice(c, OPT_AMBIENT, FACET_LEGACY_AMBIENT_DROP);
    l->keeps_hue = is_given(c, OPT_KEEP_HUE);
    l->has_glass = is_given(c, OPT_GLASS);
    l->has_mirrors = is_given(c, OPT_MIRRORS);
    l->keeps_light = option_choice(c, OPT_LIGHT_SCALE, 0) == 1;
    l->bakes_occlusion = is_given(c, OPT_BAKE_OCCLUSION);
    l->ignores_source = is_given(c, OPT_REFIT);
    desc.obj_normals = (facet_obj_normals)option_choice(c, OPT_NORMALS, FACET_OBJ_NORMALS_AUTO);
    desc.has_flipped_texcoords = is_given(c, OPT_FLIP_TEXTURES);
    desc.parameters = option_text(c, OPT_PARAMETERS, NULL);
    return desc;
}

static facet_result begin(verb_run *run, config *storage, facet_error *error)
{
    command_line *c = run->line;
    TRY(config_apply(c, storage, error));
    TRY(run->work->read(run, error));
    TRY(facet_budget_create(run->limits.max_memory_bytes, &run->budget, error));
    run->allocator = facet_budget_allocator(run->budget);
    run->messages.verbosity = messages_verbosity(c);
    run->progress = progress_choose(option_choice(c, OPT_PROGRESS, 0), is_given(c, OPT_QUIET));
    interrupt_set_deadline(run->limits.time_limit_s);
    return FACET_OK;
}

static int exit_code_of_run(const verb_run *run)
{
    if (run->is_interrupted)
        return interrupt_exit_code();
    if (run->failure_count) /* of some models, or of the only one */
        return run->input_count > 1 && !run->has_failed ? EXIT_NEGATIVE : run->failure_code;
    bool is_strict = is_given(run->line, OPT_STRICT);
    return run->is_negative || (run->warning_count && is_strict) ? EXIT_NEGATIVE : EXIT_DONE;
}

static void print_json(const verb_run *run, int exit_code)
{
    json_t *root = json_pack("{s:s}", "facet", facet_version());
    run->work->add_json(run, root);
    json_t *rest = json_pack("{s:O, s:O, s:f, s:I, s:I, s:i}", "failures", run->failures, "warnings",
                             run->warnings, "seconds", interrupt_clock() - run->start_s, "peak_memory_bytes",
                             (json_int_t)memory_peak(), "peak_data_bytes",
                             (json_int_t)facet_budget_peak_bytes(run->budget), "exit_code", exit_code);
    json_object_update(root, rest);
    json_decref(rest);
    report_print_json(root);
    json_decref(root);
}

/* Reports a failure that ends the command. Returns the exit code. */
static int end_failed(verb_run *run, const facet_error *error)
{
    int exit_code = code_of(error);
    print_error(run, error);
    if (is_given(run->line, OPT_JSON))
        report_print_failure_json(error, exit_code);
    return exit_code;
}

static int work(verb_run *run, facet_error *error)
{
    facet_result result = run->work->work(run, error);
    interrupt_end();
    end_messages(run);
    if (result == FACET_ERROR_ARGUMENT) /* a wrong command line: nothing was done */
        return end_failed(run, error);
    if (result != FACET_OK) {
        run->has_failed = true;
        run->is_interrupted = result == FACET_ERROR_CANCELLED;
        print_error(run, error);
        add_failure(run, error, NULL);
    }
    int exit_code = exit_code_of_run(run);
    if (is_given(run->line, OPT_JSON) && run->work->add_json)
        print_json(run, exit_code);
    return exit_code;
}

int verb_run_all(verb_run *run, command_line *c, const verb_work *parts)
{
    config storage = {0};
    facet_error error = {0};
    run->line = c;
    run->work = parts;
    run->start_s = interrupt_clock();
    if (is_given(c, OPT_JSON)) {
        run->failures = json_array();
        run->warnings = json_array();
    }
    int exit_code = begin(run, &storage, &error) == FACET_OK ? work(run, &error) : end_failed(run, &error);
    parts->destroy(run);
    json_decref(run->failures);
    json_decref(run->warnings);
    messages_clear(&run->messages);
    facet_budget_destroy(run->budget);
    config_destroy(&storage);
    return run->is_interrupted ? interrupt_exit() : exit_code;
}
