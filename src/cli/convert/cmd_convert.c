/* cmd_convert.c - facet convert: converts models, in order. */
#include "cli/shared/options.h"

#include "cli/convert/convert_names.h"
#include "cli/shared/failure.h"
#include "cli/shared/input.h"
#include "cli/shared/interrupt.h"
#include "cli/shared/output.h"
#include "cli/shared/verb_run.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---- reports ---- */

/* Totals of the last conversion of a scene. */
typedef struct conversion_totals {
    uint32_t count, grades[FACET_CONVERSION_GRADE_BAD + 1];
    uint32_t measured; /* materials with an error */
    double mean_error, mean_display, mean_drawn;
    facet_conversion worst; /* by the graded error */
} conversion_totals;

static const char *const grade_names[] = {"good", "fair", "poor", "bad"};

static conversion_totals conversion_sum(const facet_scene *scene)
{
    conversion_totals t = {.count = facet_scene_get_conversion_count(scene)};
    for (uint32_t i = 0; i < t.count; i++) {
        facet_conversion one = facet_scene_get_conversion(scene, i);
        if (isnan(one.error_graded))
            continue;
        t.grades[one.grade]++;
        t.mean_error += one.error;
        t.mean_display += one.error_display;
        t.mean_drawn += one.error_drawn;
        if (t.measured == 0 || one.error_graded > t.worst.error_graded)
            t.worst = one;
        t.measured++;
    }
    if (t.measured) {
        t.mean_error /= t.measured;
        t.mean_display /= t.measured;
        t.mean_drawn /= t.measured;
    }
    return t;
}

/* ---- for people ---- */

static int compare_errors(const void *a, const void *b)
{
    const facet_conversion *x = a, *y = b;
    double p = isnan(x->error_graded) ? -1.0 : x->error_graded;
    double q = isnan(y->error_graded) ? -1.0 : y->error_graded;
    return p > q ? -1 : p < q ? 1 : strcmp(x->name, y->name);
}

static void print_material(const messages *m, verbosity least, const char *model, const facet_conversion *one)
{
    const char *const graded[] = {one->is_graded_as_drawn ? "" : " (graded)",
                                  one->is_graded_as_drawn ? " (graded)" : ""};
    char drawn[64] = "";
    if (isnan(one->error)) {
        message_at(m, least, "%s: material \"%s\": %s", model, one->name, one->method);
        return;
    }
    if (!isnan(one->error_drawn) && one->grade_drawn != one->grade)
        snprintf(drawn, sizeof drawn, ", as drawn %.3f (%s)", one->error_drawn,
                 grade_names[one->grade_drawn]);
    else if (!isnan(one->error_drawn))
        snprintf(drawn, sizeof drawn, ", as drawn %.3f%s", one->error_drawn, graded[1]);
    message_at(m, least, "%s: material \"%s\": %s, E %.3f, on a screen %.3f%s%s (%s, %s)", model, one->name,
               grade_names[one->grade], one->error, one->error_display, graded[0], drawn, one->method,
               one->profile);
}

static void print_materials(const messages *m, const char *model, const facet_scene *scene, uint32_t count)
{
    enum { MAX_LINES = 8 }; /* without -v */
    facet_conversion *all = malloc(count * sizeof *all);
    if (!all)
        return;
    for (uint32_t i = 0; i < count; i++)
        all[i] = facet_scene_get_conversion(scene, i);
    qsort(all, count, sizeof *all, compare_errors);
    for (uint32_t i = 0; i < count; i++) {
        bool is_news = i < MAX_LINES && !isnan(all[i].error) && all[i].grade >= FACET_CONVERSION_GRADE_POOR;
        print_material(m, is_news ? VERBOSITY_NORMAL : VERBOSITY_DETAILS, model, &all[i]);
    }
    free(all);
}

static void convert_report_print(const messages *m, const char *model, const facet_scene *scene)
{
    conversion_totals t = conversion_sum(scene);
    if (t.count == 0)
        return;
    print_materials(m, model, scene, t.count);
    if (t.measured == 0)
        return;
    char grades[128] = "";
    for (int i = 0; i <= FACET_CONVERSION_GRADE_BAD; i++)
        if (t.grades[i]) {
            size_t used = strlen(grades);
            snprintf(grades + used, sizeof grades - used, "%s%u %s", used ? ", " : "", t.grades[i],
                     grade_names[i]);
        }
    char worst[256] = "";
    if (t.worst.error_graded > 0.005)
        snprintf(worst, sizeof worst, "; worst \"%.200s\" with %.3f", t.worst.name, t.worst.error_graded);
    char drawn[64] = "";
    bool is_drawn = t.worst.is_graded_as_drawn;
    if (!isnan(t.mean_drawn))
        snprintf(drawn, sizeof drawn, ", as OpenGL 1 programs draw %.3f%s", t.mean_drawn,
                 is_drawn ? " (graded)" : "");
    message_at(m, VERBOSITY_NORMAL,
               "%s: %u material%s converted: %s; mean error E %.3f, on a screen %.3f%s%s%s", model, t.count,
               t.count == 1 ? "" : "s", grades, t.mean_error, t.mean_display, is_drawn ? "" : " (graded)",
               drawn, worst);
}

/* ---- for programs ---- */

static json_t *convert_report_json(const facet_scene *scene)
{
    conversion_totals t = conversion_sum(scene);
    if (t.count == 0)
        return json_null();
    json_t *root = json_object();
    json_object_set_new(root, "count", json_integer(t.count));
    for (int i = 0; i <= FACET_CONVERSION_GRADE_BAD; i++)
        json_object_set_new(root, grade_names[i], json_integer(t.grades[i]));
    json_object_set_new(root, "mean_E", t.measured ? json_real(t.mean_error) : json_null());
    json_object_set_new(root, "worst", t.measured ? report_string_json(t.worst.name) : json_null());
    json_object_set_new(root, "worst_E", t.measured ? json_real(t.worst.error) : json_null());
    json_object_set_new(root, "worst_E_display", t.measured ? json_real(t.worst.error_display) : json_null());
    bool has_drawn = t.measured && !isnan(t.mean_drawn);
    json_object_set_new(root, "mean_E_drawn", has_drawn ? json_real(t.mean_drawn) : json_null());
    json_object_set_new(root, "worst_E_drawn", has_drawn ? json_real(t.worst.error_drawn) : json_null());
    return root;
}

static facet_result convert_report_write(const facet_scene *scene, bool is_html, const char *path,
                                         facet_error *error)
{
    char *text = NULL;
    facet_result result = facet_scene_report_conversion(
        scene, is_html ? FACET_REPORT_FORMAT_HTML : FACET_REPORT_FORMAT_JSON, &text, error);
    if (result == FACET_OK)
        result = output_write_bytes(text, strlen(text), path, error);
    facet_text_destroy(text);
    return result;
}

const verb convert_verb = {
    .name = "convert",
    .summary = "convert a model: glTF, OBJ, rgl's parameters",
    .arguments = "MODEL NEW",
    .max_arguments = SIZE_MAX,
    .file_types = "glb gltf obj stl ply json",
    .output_types = "glb gltf obj json usdz",
    .description =
        "Reads MODEL (.glb, .gltf, .obj with its .mtl, .stl, .ply, .json of rgl's parameters; - is "
        "standard input) and writes it as NEW (.glb, .gltf, .obj, .json, .usdz).\n\n"
        "From glTF to glTF everything is kept: meshes, materials with all extensions, textures as "
        "they are, animations, cameras, lights, variants, metadata. Compressed data (Draco, meshopt, "
        "quantization) is written uncompressed.\n\n"
        "Materials of OpenGL 1 (MTL, rgl: ambient, diffuse, specular, shininess) are converted to "
        "physically based ones and back, and the error is reported: E is the relative error of "
        "radiance over views and lights (legacy.md of facet help documents).\n\n"
        "The output appears whole or not at all; the files beside it are written first.",
    .examples = (const example[]){{"facet convert scene.gltf scene.glb", "many files into one"},
                                  {"facet convert scene.glb scene.gltf", "to look at the JSON"},
                                  {"facet convert packed.glb plain.glb", "for a program without Draco"},
                                  {"facet convert old.obj new.glb --report report.html",
                                   "OpenGL 1 materials to PBR, with a report"},
                                  {"facet convert old.obj new.glb --method fit --profile core",
                                   "for viewers without material extensions"},
                                  {"facet convert models/ -o 'new/{dir}/{stem}.glb' --max-error 0.3",
                                   "all in a folder and below it"},
                                  {"facet convert new.glb old.obj", "and back"},
                                  {"facet convert scene.glb scene.json", "parameters for R's rgl"},
                                  {"facet convert specgloss.glb new.glb --materials metallic-roughness",
                                   "for viewers without KHR_materials_pbrSpecularGlossiness"},
                                  {NULL, NULL}},
    .basics = OPTION_IDS(OPT_OUTPUT, OPT_MATERIALS, OPT_METHOD, OPT_PROFILE, OPT_GLASS, OPT_MIRRORS,
                         OPT_FLIP_TEXTURES, OPT_REPORT, OPT_MAX_ERROR, OPT_FILES_FROM, OPT_NO_CLOBBER,
                         OPT_JSON, OPT_STRICT),
    .groups =
        (const option_group *const[]){
            OPTION_GROUP("Output", OPT_OUTPUT, OPT_NO_CLOBBER, OPT_TO, OPT_MATERIALS, OPT_KEEP_SOURCES),
            &legacy_group,
            OPTION_GROUP("To OBJ and rgl", OPT_MTL_PBR, OPT_MTL_SHININESS_SCALE, OPT_BAKE_OCCLUSION,
                         OPT_REFIT),
            OPTION_GROUP("Report", OPT_REPORT, OPT_MAX_ERROR), &files_group, &limits_group, &messages_group,
            NULL},
};

typedef struct convert_run {
    verb_run base;
    convert_names names;
    json_t *models; /* NULL without --json */
} convert_run;

/* ---- one model ---- */

/* Converts the materials to those of the output format, or of --materials. */
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
        result = fail(error, FACET_ERROR_ARGUMENT, "%s: this input would be overwritten; name another report",
                      report);
    bool is_stdout = strcmp(output, "-") == 0;
    desc.is_glb = is_stdout;
    if (result == FACET_OK)
        result = output_write_scene(scene, is_stdout ? "/dev/stdout" : output, desc, error);
    if (result == FACET_OK && run->names.report)
        result = convert_report_write(scene, run->names.is_html, report, error);
    return result;
}

/* Number of materials with a graded error above --max-error. */
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

static void report_model(convert_run *run, const char *model, const char *output, const facet_scene *scene,
                         double start)
{
    uint32_t large = count_large_errors(run, scene);
    if (strcmp(output, "-") == 0)
        output = "stdout";
    convert_report_print(&run->base.messages, output, scene);
    if (large)
        message_error("%s: %u material%s an error above --max-error %g", output, large,
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
        message_at(&run->base.messages, VERBOSITY_NORMAL, "%s: kept, since it exists", output);
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
        report_model(run, model->path, output, scene, start);
    facet_scene_destroy(scene);
    if (result != FACET_OK)
        failure_complete(
            error, strncmp(error->message, output, strlen(output)) == 0 ? output : input_name(model->path),
            run->base.limits.max_memory_bytes);
    return result;
}

/* ---- the run ---- */

/* Fails if another model has the same output: neither is converted. */
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
