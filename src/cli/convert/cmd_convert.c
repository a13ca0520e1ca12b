/* cmd_convert.c - facet convert: models in another form, one after the other. */
#include "cli/shared/commands.h"

#include "cli/convert/convert_names.h"
#include "cli/convert/convert_report.h"
#include "cli/shared/failure.h"
#include "cli/shared/input.h"
#include "cli/shared/interrupt.h"
#include "cli/shared/json_report.h"
#include "cli/shared/output.h"
#include "cli/shared/verb_run.h"

#include <string.h>

typedef struct convert_run {
    verb_run base;
    convert_names names;
    json_t *models; /* NULL without --json */
} convert_run;

/* ---- one model ---- */

/* Materials in the form that the output has, or that was asked for. */
static facet_result convert_materials(convert_run *run, facet_scene *scene, const facet_legacy_desc *desc,
                                      facet_error *error)
{
    const facet_log log = messages_log(&run->base.messages);
    int asked = option_choice(run->base.line, OPT_MATERIALS, 0);
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
    const command_line *c = run->base.line;
    facet_scene_save_desc desc = {.allocator = run->base.allocator,
                                  .log = messages_log(&run->base.messages),
                                  .thread_count = run->base.limits.thread_count,
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
    double limit = option_number(run->base.line, OPT_MAX_ERROR, 0.0);
    if (!is_given(run->base.line, OPT_MAX_ERROR))
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
    convert_report_print(&run->base.messages, output, scene);
    if (large)
        message_error("%s: %u material%s a larger error than --max-error %g", output, large,
                      large == 1 ? " has" : "s have", option_number(run->base.line, OPT_MAX_ERROR, 0.0));
    run->base.is_negative = run->base.is_negative || large;
    message_at(&run->base.messages, VERBOSITY_DETAILS, "%s: %.2f s", output, interrupt_clock() - start);
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
        message_at(&run->base.messages, VERBOSITY_NORMAL, "%s: kept; it was there already", output);
        return FACET_OK;
    }
    facet_scene *scene = NULL;
    facet_scene_desc desc = verb_run_scene_desc(&run->base);
    desc.legacy.keeps_materials = format_is_legacy(run->names.format);
    desc.legacy.drops_sources = !desc.legacy.keeps_materials && !is_given(run->base.line, OPT_KEEP_SOURCES);
    interrupt_begin_reading(input_name(model->path));
    result = input_load(model->path, &desc, &scene, error);
    if (result == FACET_OK)
        result = convert_materials(run, scene, &desc.legacy, error);
    interrupt_end();
    messages_flush(&run->base.messages);
    if (result == FACET_OK)
        result = interrupt_check(output, error);
    if (result == FACET_OK)
        result = save(run, model, scene, output, error);
    messages_flush(&run->base.messages);
    if (result == FACET_OK)
        tell_model(run, model->path, output, scene, start);
    facet_scene_destroy(scene);
    if (result != FACET_OK)
        failure_complete(
            error, strncmp(error->message, output, strlen(output)) == 0 ? output : input_name(model->path),
            run->base.limits.max_memory_bytes);
    return result;
}

/* ---- the run ---- */

/* Whether another model has the same output: neither is converted, and the others are. */
static facet_result check_clash(const convert_run *run, size_t i, facet_error *error)
{
    char name[CONVERT_NAME_SIZE];
    facet_result result = convert_name(&run->names, &run->names.models.models[i], false, name, error);
    return result == FACET_OK ? model_list_check_clash(&run->names.models, i, name, error) : result;
}

static facet_result convert_one(verb_run *base, size_t i, facet_error *error)
{
    convert_run *run = (convert_run *)base;
    TRY(check_clash(run, i, error));
    return convert_model(run, &run->names.models.models[i], error);
}

static facet_result read_line(verb_run *base, facet_error *error)
{
    TRY(convert_names_read(base->line, &((convert_run *)base)->names, error));
    return limits_read(base->line, &base->limits, error);
}

static facet_result convert(verb_run *base, facet_error *error)
{
    convert_run *run = (convert_run *)base;
    (void)error;
    run->models = is_given(base->line, OPT_JSON) ? json_array() : NULL;
    verb_run_models(base, &run->names.models, convert_one);
    return FACET_OK;
}

static void add_json(const verb_run *base, json_t *root)
{
    json_object_set(root, "models", ((const convert_run *)base)->models);
}

static void destroy(verb_run *base)
{
    convert_run *run = (convert_run *)base;
    json_decref(run->models);
    convert_names_destroy(&run->names);
}

int cmd_convert(command_line *c)
{
    static const verb_work work = {read_line, convert, add_json, destroy};
    convert_run run = {.models = NULL};
    return verb_run_all(&run.base, c, &work);
}
