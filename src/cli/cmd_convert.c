/* cmd_convert.c - facet convert: models in another form, one after the other. */
#include "cli/commands.h"

#include "cli/convert_names.h"
#include "cli/convert_report.h"
#include "cli/failure.h"
#include "cli/input.h"
#include "cli/interrupt.h"
#include "cli/legacy_options.h"
#include "cli/limits.h"
#include "cli/output.h"
#include "cli/render_report.h"

#include <string.h>

/* All that a run shares. */
typedef struct convert_run {
    const command_line *line;
    convert_names names;
    limits limits;
    messages messages;
    facet_budget *budget;
    facet_allocator allocator;
    facet_scene_desc scene_desc; /* without log */
    json_t *models, *failures;   /* NULL: nobody asked for JSON */
    json_t *warnings;
    size_t warning_count, failure_count;
    uint32_t large_error_count; /* materials beyond --max-error */
    int exit_code;              /* of the last failure */
    bool is_interrupted;        /* by a signal, before all was done */
} convert_run;

/* ---- one model ---- */

/* Materials in the form that the output has, or that was asked for. */
static facet_result convert_materials(convert_run *run, facet_scene *scene, facet_error *error)
{
    const facet_log log = messages_log(&run->messages);
    const facet_legacy_desc *desc = &run->scene_desc.legacy;
    int asked = option_choice(run->line, OPT_MATERIALS, 0);
    if (format_is_legacy(run->names.format))
        return facet_scene_convert_materials(scene, FACET_MATERIAL_MODEL_OGL1, desc, &log, error);
    if (asked == 0)
        return FACET_OK;
    return facet_scene_convert_materials(scene,
                                         asked == 1 ? FACET_MATERIAL_MODEL_METALLIC_ROUGHNESS
                                                    : FACET_MATERIAL_MODEL_SPECULAR_GLOSSINESS,
                                         desc, &log, error);
}

static facet_result save(convert_run *run, const model_name *model, const facet_scene *scene,
                         const char *output, facet_error *error)
{
    const command_line *c = run->line;
    facet_scene_save_desc desc = {.allocator = run->allocator,
                                  .log = messages_log(&run->messages),
                                  .thread_count = run->limits.thread_count,
                                  .keeps_inputs = true,
                                  .has_flipped_texcoords = is_given(c, OPT_FLIP_TEXTURES),
                                  .omits_mtl_pbr = option_choice(c, OPT_MTL_PBR, 0) == 1,
                                  .mtl_shininess_scale =
                                      (float)option_number(c, OPT_MTL_SHININESS_SCALE, 0.0)};
    char report[CONVERT_NAME_SIZE];
    facet_result result = FACET_OK;
    if (run->names.report)
        result = convert_name(&run->names, model, true, report, error);
    if (result == FACET_OK && run->names.report && facet_scene_has_file(scene, report))
        result = fail(error, FACET_ERROR_ARGUMENT,
                      "%s: it is an input, too, and would be overwritten; name another report", report);
    bool is_stdout = strcmp(output, "-") == 0;
    desc.is_glb = is_stdout;
    if (result == FACET_OK)
        result = output_write_scene(scene, is_stdout ? "/dev/stdout" : output, desc, error);
    if (result == FACET_OK && run->names.report)
        result = convert_report_write(scene, run->names.is_html, report, error);
    return result;
}

/* Materials whose error on a screen is larger than --max-error. */
static uint32_t count_large_errors(const convert_run *run, const facet_scene *scene)
{
    uint32_t count = 0;
    double limit = option_number(run->line, OPT_MAX_ERROR, 0.0);
    if (!is_given(run->line, OPT_MAX_ERROR))
        return 0;
    for (uint32_t i = 0; i < facet_scene_get_conversion_count(scene); i++)
        count += facet_scene_get_conversion(scene, i).error_graded > limit;
    return count;
}

static void tell_model(convert_run *run, const char *model, const char *output, const facet_scene *scene,
                       double start)
{
    uint32_t large = count_large_errors(run, scene);
    if (strcmp(output, "-") == 0)
        output = "stdout";
    convert_report_print(&run->messages, output, scene);
    if (large)
        message_error("%s: %u material%s a larger error than --max-error %g", output, large,
                      large == 1 ? " has" : "s have", option_number(run->line, OPT_MAX_ERROR, 0.0));
    run->large_error_count += large;
    message_at(&run->messages, VERBOSITY_DETAILS, "%s: %.2f s", output, interrupt_clock() - start);
    if (run->models) {
        json_t *one = json_pack("{s:o, s:o, s:o, s:f}", "input", report_string_json(model), "output",
                                report_string_json(output), "materials", convert_report_json(scene),
                                "seconds", interrupt_clock() - start);
        json_array_append_new(run->models, one);
    }
}

static facet_result convert_model(convert_run *run, const model_name *model, facet_error *error)
{
    char output[CONVERT_NAME_SIZE];
    double start = interrupt_clock();
    facet_result result = convert_name(&run->names, model, false, output, error);
    if (result != FACET_OK)
        return result;
    if (run->names.keeps_existing && output_exists(output)) {
        message_at(&run->messages, VERBOSITY_NORMAL, "%s: kept; it was there already", output);
        return FACET_OK;
    }
    facet_scene *scene = NULL;
    facet_scene_desc desc = run->scene_desc;
    desc.log = messages_log(&run->messages);
    interrupt_begin_reading(input_name(model->path));
    result = input_load(model->path, &desc, &scene, error);
    if (result == FACET_OK)
        result = convert_materials(run, scene, error);
    interrupt_end();
    messages_flush(&run->messages);
    if (result == FACET_OK)
        result = interrupt_check(output, error);
    if (result == FACET_OK)
        result = save(run, model, scene, output, error);
    messages_flush(&run->messages);
    if (result == FACET_OK)
        tell_model(run, model->path, output, scene, start);
    facet_scene_destroy(scene);
    if (result != FACET_OK)
        failure_complete(
            error, strncmp(error->message, output, strlen(output)) == 0 ? output : input_name(model->path),
            run->limits.max_memory_bytes);
    return result;
}

/* ---- the run ---- */

static void report_failure(convert_run *run, const char *model, const facet_error *error)
{
    message_error("%s", error->message);
    run->failure_count++;
    run->exit_code = exit_code_of(error->result);
    if (run->failures)
        json_array_append_new(run->failures, report_error_json(error, input_name(model), run->exit_code));
}

/* Whether another model has the same output: neither is converted, and the others are. */
static facet_result check_clash(const convert_run *run, size_t i, facet_error *error)
{
    char name[CONVERT_NAME_SIZE];
    facet_result result = convert_name(&run->names, &run->names.models.models[i], false, name, error);
    return result == FACET_OK ? model_list_check_clash(&run->names.models, i, name, error) : result;
}

static int convert_all(convert_run *run)
{
    const model_list *models = &run->names.models;
    for (size_t i = 0; i < models->count; i++) {
        const model_name *model = &models->models[i];
        facet_error error = {0};
        facet_result result = check_clash(run, i, &error);
        if (result == FACET_OK)
            result = convert_model(run, model, &error);
        run->warning_count += report_end_model(&run->messages, run->warnings);
        if (result != FACET_OK)
            report_failure(run, model->path, &error);
        run->is_interrupted = interrupt_signal() && (result != FACET_OK || i + 1 < models->count);
        if (run->is_interrupted)
            return interrupt_exit_code();
    }
    if (run->failure_count)
        return models->count == 1 ? run->exit_code : EXIT_NEGATIVE;
    return run->large_error_count || (run->warning_count && is_given(run->line, OPT_STRICT)) ? EXIT_NEGATIVE
                                                                                             : EXIT_DONE;
}

static void print_json(const convert_run *run, double start, int exit_code)
{
    json_t *root = json_pack("{s:s, s:O, s:O, s:O, s:f, s:i}", "facet", facet_version(), "models",
                             run->models, "failures", run->failures, "warnings", run->warnings, "seconds",
                             interrupt_clock() - start, "exit_code", exit_code);
    report_print_json(root);
    json_decref(root);
}

static facet_result begin(convert_run *run, command_line *c, facet_error *error)
{
    facet_result result = convert_names_read(c, &run->names, error);
    if (result == FACET_OK)
        result = limits_read(c, &run->limits, error);
    if (result == FACET_OK)
        result = facet_budget_create(run->limits.max_memory_bytes, &run->budget, error);
    if (result != FACET_OK)
        return result;
    run->allocator = facet_budget_allocator(run->budget);
    run->scene_desc = (facet_scene_desc){.allocator = run->allocator,
                                         .thread_count = run->limits.thread_count,
                                         .root = option_text(c, OPT_ROOT, NULL),
                                         .max_texture_size = run->limits.max_texture_size};
    legacy_options_read(c, &run->scene_desc);
    run->scene_desc.legacy.keeps_materials = format_is_legacy(run->names.format);
    run->scene_desc.legacy.drops_sources =
        !format_is_legacy(run->names.format) && !is_given(c, OPT_KEEP_SOURCES);
    return FACET_OK;
}

int cmd_convert(command_line *c)
{
    double start = interrupt_clock();
    convert_run run = {.line = c, .messages = {.verbosity = messages_verbosity(c)}};
    facet_error error = {0};
    if (is_given(c, OPT_JSON)) {
        run.models = json_array();
        run.failures = json_array();
        run.warnings = json_array();
    }
    facet_result result = begin(&run, c, &error);
    int exit_code;
    if (result == FACET_OK) {
        interrupt_set_deadline(run.limits.time_limit_s);
        exit_code = convert_all(&run);
    } else {
        exit_code = exit_code_of(result);
        message_error("%s%s",
                      error.message[0] == '-' || strncmp(error.message, "convert:", 8) == 0 ? "facet: " : "",
                      error.message);
        if (run.failures)
            json_array_append_new(run.failures, report_error_json(&error, NULL, exit_code));
    }
    if (run.models)
        print_json(&run, start, exit_code);
    json_decref(run.models);
    json_decref(run.failures);
    json_decref(run.warnings);
    convert_names_destroy(&run.names);
    facet_budget_destroy(run.budget);
    return run.is_interrupted ? interrupt_exit() : exit_code;
}
