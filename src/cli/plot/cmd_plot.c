/* cmd_plot.c - facet plot: reflectance as curves, lobes and tables. */
#include "cli/shared/options.h"

#include "cli/plot/plot_material.h"
#include "cli/shared/failure.h"
#include "cli/shared/input.h"
#include "cli/shared/interrupt.h"
#include "cli/shared/output.h"
#include "cli/shared/suggest.h"
#include "cli/shared/value.h"
#include "cli/shared/verb_run.h"

#include <stdio.h>
#include <string.h>
#include <strings.h>

const verb plot_verb = {
    .name = "plot",
    .summary = "plot reflectance as curves, lobes and tables",
    .arguments = "KIND [MATERIAL...]",
    .max_arguments = FACET_PLOT_MAX_MATERIALS + 1,
    .file_types = "glb gltf obj json binary",
    .output_types = "svg pdf png csv json",
    .words = OPTION_WORDS("legacy", "brdf", "slice", "hemisphere", "lobe", "terms", "albedo", "furnace",
                          "dfg", "tone", "fresnel", "error"),
    .description =
        "KIND is one of these:\n\n"
        "legacy: PBR and OpenGL 1 over the light's angle, with the best fit and the difference\n\n"
        "brdf: lobes in the plane of incidence, as polar slices; slice: the same as curves over the "
        "light's angle\n\n"
        "hemisphere: all light directions in false color; lobe: the same as a surface in space\n\n"
        "terms: D, V and F over their cosines; dfg: the DFG tables of the split sum\n\n"
        "albedo: directional albedo over the view's angle; furnace: albedo under uniform light, over "
        "roughness\n\n"
        "tone: tone mapping operators; fresnel: water, glass, metals, exact and by Schlick's "
        "approximation\n\n"
        "error: how close PBR and OpenGL 1 come to each other, over roughness\n\n"
        "A MATERIAL is a list of parameters (roughness=0.3,metallic=1,color=gold; or "
        "ogl1,diffuse=#808080,specular=white,shininess=50), the name of a model alone or before them "
        "(ggx, pbr; blinn-phong, phong, ogl1: OpenGL 1's highlight, which is Blinn's), a model file, "
        "optionally with #NAME of one of its materials, or a measured BRDF in MERL's format "
        "(.binary). Several are plotted together.\n\n"
        "Parameters are color, metallic, roughness, ior, specular, specular-color, clearcoat, "
        "clearcoat-roughness, sheen-color, sheen-roughness, anisotropy, anisotropy-rotation "
        "(degrees), iridescence, iridescence-ior, iridescence-thickness (nm), diffuse-roughness; after ogl1, "
        "diffuse, "
        "specular, shininess. A color is #rrggbb or a CSS name, one linear number for a grey, or "
        "three as r/g/b; the others are glTF's, mostly from 0 to 1.",
    .examples =
        (const example[]){
            {"facet plot legacy -o vignette.svg",
             "the plots of \"Shininess in OpenGL 1 versus glTF PBR\", with fit and difference"},
            {"facet plot brdf --roughness 0.1,0.3,0.6 --angle 45 -o ggx.svg", "three lobes"},
            {"facet plot slice helmet.glb#Leather roughness=0.5 -o slice.pdf",
             "a material of a model and another one"},
            {"facet plot slice gold-paint.binary --fit -o gold.png", "a measured BRDF and its fit"},
            {"facet plot legacy ogl1,diffuse=gray,shininess=20 --fit -o fit.svg",
             "an OpenGL 1 material and its PBR fit"},
            {"facet plot tone -o tone.csv", "as numbers"},
            {NULL, NULL}},
    .basics = OPTION_IDS(OPT_OUTPUT, OPT_FORMAT, OPT_ROUGHNESS, OPT_METALLIC, OPT_BASE_COLOR, OPT_ANGLE,
                         OPT_FIT, OPT_LOG, OPT_ENERGY, OPT_SIZE, OPT_TITLE, OPT_DARK, OPT_JSON),
    .groups = (const option_group *const[]){OPTION_GROUP("Plot", OPT_OUTPUT, OPT_NO_CLOBBER, OPT_FORMAT,
                                                         OPT_SIZE, OPT_TITLE, OPT_DARK, OPT_LOG),
                                            OPTION_GROUP("Materials and views", OPT_ROUGHNESS, OPT_METALLIC,
                                                         OPT_BASE_COLOR, OPT_ANGLE, OPT_FIT, OPT_SCALE,
                                                         OPT_COSINE, OPT_ENERGY, OPT_SMITH, OPT_HEAVISIDE),
                                            &limits_group, &messages_group, NULL},
};

/* In the order of facet_plot_kind, as the words of the verb. */
static const char *const kind_names[] = {"legacy", "brdf",    "slice", "hemisphere", "lobe",    "terms",
                                         "albedo", "furnace", "dfg",   "tone",       "fresnel", "error"};
enum { KIND_COUNT = sizeof kind_names / sizeof *kind_names };
static const char *const format_names[] = {"svg", "pdf", "png", "csv", "json"}; /* of facet_plot_format */

typedef struct plot_run {
    verb_run base;
    facet_plot_desc desc;
    plot_materials materials;
    float angles[FACET_PLOT_MAX_ANGLES];
    facet_plot_fit fits[FACET_PLOT_MAX_MATERIALS];
    facet_plot_format format;
    char output[64]; /* the default name */
    const char *path;
    bool is_written;
} plot_run;

/* ---- options ---- */

static facet_result read_kind(plot_run *run, facet_error *error)
{
    const command_line *c = run->base.line;
    if (c->argument_count)
        for (int i = 0; i < KIND_COUNT; i++)
            if (strcmp(c->arguments[0], kind_names[i]) == 0) {
                run->desc.kind = (facet_plot_kind)i;
                return FACET_OK;
            }
    char names[256] = "";
    for (int i = 0; i < KIND_COUNT; i++)
        snprintf(names + strlen(names), sizeof names - strlen(names), "%s%s", i ? ", " : "", kind_names[i]);
    if (c->argument_count && plot_material_is_parameters(c->arguments[0]))
        return fail(
            error, FACET_ERROR_ARGUMENT,
            "plot: \"%.200s\" is a material; the kind of plot comes first, as in facet plot brdf %.200s",
            c->arguments[0], c->arguments[0]);
    return c->argument_count
               ? fail(error, FACET_ERROR_ARGUMENT, "plot: there is no plot \"%.60s\"; the plots are %s",
                      c->arguments[0], names)
               : fail(error, FACET_ERROR_ARGUMENT, "plot: which plot? One of %s", names);
}

static facet_result read_output(plot_run *run, facet_error *error)
{
    const command_line *c = run->base.line;
    int format = option_choice(c, OPT_FORMAT, -1);
    run->path = option_text(c, OPT_OUTPUT, NULL);
    if (!run->path) {
        snprintf(run->output, sizeof run->output, "%s.%s", kind_names[run->desc.kind],
                 format_names[format < 0 ? FACET_PLOT_FORMAT_SVG : format]);
        run->path = run->output;
    }
    const char *dot = strrchr(run->path, '.');
    for (int i = 0; format < 0 && dot && i <= FACET_PLOT_FORMAT_JSON; i++)
        if (strcasecmp(dot + 1, format_names[i]) == 0)
            format = i;
    if (format < 0)
        return strcmp(run->path, "-") == 0 ? fail(error, FACET_ERROR_ARGUMENT,
                                                  "--output: standard output needs --format svg, pdf, png, "
                                                  "csv or json")
                                           : fail(error, FACET_ERROR_ARGUMENT,
                                                  "--output: \"%s\" does not end in .svg, .pdf, .png, .csv "
                                                  "or .json; say which with --format",
                                                  run->path);
    run->format = (facet_plot_format)format;
    return output_check(run->path, error);
}

static facet_result read_angles(plot_run *run, facet_error *error)
{
    const char *at = option_text(run->base.line, OPT_ANGLE, NULL);
    run->desc.angles_rad = run->angles;
    for (; at && *at; at += *at == ',') {
        double degrees;
        if (run->desc.angle_count == FACET_PLOT_MAX_ANGLES || !scan_number(&at, &degrees) || degrees < 0.0 ||
            degrees >= 90.0 || (*at && *at != ','))
            return option_fail(run->base.line, OPT_ANGLE,
                               "a list of at most 8 angles from 0 to below 90, as 0,30,60", error);
        run->angles[run->desc.angle_count++] = (float)(degrees * 0.017453292519943295);
    }
    return FACET_OK;
}

static facet_result read_materials(plot_run *run, facet_error *error)
{
    const command_line *c = run->base.line;
    const facet_scene_desc desc = verb_run_scene_desc(&run->base);
    facet_result result = FACET_OK;
    for (size_t i = 1; i < c->argument_count && result == FACET_OK; i++)
        result = plot_materials_add(&run->materials, c->arguments[i], &desc, error);
    if (result == FACET_OK)
        result = plot_materials_add_options(&run->materials, c, error);
    run->desc.materials = run->materials.items;
    run->desc.material_count = run->materials.count;
    return result;
}

static facet_result read_desc(plot_run *run, facet_error *error)
{
    const command_line *c = run->base.line;
    facet_plot_desc *d = &run->desc;
    d->thread_count = run->base.limits.thread_count;
    d->has_heaviside_ramp = option_choice(c, OPT_HEAVISIDE, 0) == 1;
    d->has_separable_smith = option_choice(c, OPT_SMITH, d->kind == FACET_PLOT_KIND_LEGACY) == 1;
    d->has_fit = is_given(c, OPT_FIT);
    d->fits = run->fits;
    d->has_shared_scale = option_choice(c, OPT_SCALE, 0) == 1;
    d->is_logarithmic = is_given(c, OPT_LOG);
    d->has_cosine = is_given(c, OPT_COSINE);
    d->energy = (facet_energy)option_choice(c, OPT_ENERGY, FACET_ENERGY_CONSERVING);
    if (is_given(c, OPT_ENERGY) && d->energy != FACET_ENERGY_GLTF &&
        (d->has_fit || d->kind == FACET_PLOT_KIND_LEGACY))
        return option_fail(c, OPT_ENERGY, "gltf, whose formulas fits and plot legacy have", error);
    d->title = option_text(c, OPT_TITLE, NULL);
    d->is_dark = is_given(c, OPT_DARK);
    const char *size = option_text(c, OPT_SIZE, NULL);
    if (size && !value_size(size, &d->width, &d->height))
        return option_fail(c, OPT_SIZE, "a size: 960x640 or 512", error);
    facet_result result = read_angles(run, error);
    return result == FACET_OK ? read_materials(run, error) : result;
}

/* ---- the run ---- */

/* Whether the plot would overwrite one of its inputs. */
static bool is_an_input(const plot_run *run)
{
    const plot_materials *m = &run->materials;
    for (uint32_t i = 0; i < m->scene_count; i++)
        if (facet_scene_has_file(m->scenes[i], run->path))
            return true;
    for (uint32_t i = 0; i < m->count; i++)
        if (m->items[i].path && input_is_same_file(m->items[i].path, run->path))
            return true;
    return false;
}

enum { MATERIAL_TEXT = 512 };

/* Prints the fits: model, error, and the parameters as a MATERIAL. */
static void print_fits(const plot_run *run)
{
    for (int i = 0; i < FACET_PLOT_MAX_MATERIALS; i++) {
        const facet_plot_fit *fit = &run->fits[i];
        char text[MATERIAL_TEXT], error[96];
        if (!fit->is_found)
            continue;
        plot_material_write(&fit->fitted, text, sizeof text);
        if (fit->is_of_measured)
            snprintf(error, sizeof error, "RMS of log(1 + f cos) %.3f", (double)fit->log_rms);
        else
            snprintf(error, sizeof error, "E %.3f, E_display %.3f, E_drawn %.3f", (double)fit->E,
                     (double)fit->E_display, (double)fit->E_drawn);
        message_at(&run->base.messages, VERBOSITY_NORMAL, "%s: fit: %s (%s): %s", fit->name, fit->description,
                   error, text);
    }
}

static json_t *fits_json(const plot_run *run)
{
    json_t *list = json_array();
    for (int i = 0; i < FACET_PLOT_MAX_MATERIALS; i++) {
        const facet_plot_fit *fit = &run->fits[i];
        char text[MATERIAL_TEXT];
        if (!fit->is_found)
            continue;
        plot_material_write(&fit->fitted, text, sizeof text);
        json_t *one =
            json_pack("{s:i, s:o, s:o, s:s, s:s}", "material", i, "name", report_string_json(fit->name),
                      "fit", report_string_json(fit->description), "model",
                      fit->fitted.model == FACET_PLOT_MODEL_OGL1 ? "ogl1" : "pbr", "parameters", text);
        if (fit->is_of_measured) {
            json_object_set_new(one, "log_rms", json_real((double)fit->log_rms));
        } else {
            json_object_set_new(one, "E", json_real((double)fit->E));
            json_object_set_new(one, "E_display", json_real((double)fit->E_display));
            json_object_set_new(one, "E_drawn", json_real((double)fit->E_drawn));
        }
        json_array_append_new(list, one);
    }
    return list;
}

static facet_result plot(plot_run *run, facet_error *error)
{
    if (strcmp(run->path, "-") != 0 && is_an_input(run))
        return fail(error, FACET_ERROR_ARGUMENT,
                    "%s: this input would be overwritten; name another output with -o", run->path);
    unsigned char *bytes = NULL;
    size_t size = 0;
    facet_result result = facet_plot_encode(&run->desc, run->format, &bytes, &size, error);
    if (result == FACET_OK && interrupt_signal())
        result = fail(error, FACET_ERROR_CANCELLED, "%s: interrupted", run->path);
    if (result == FACET_OK)
        result = output_write_bytes(bytes, size, run->path, error);
    run->is_written = result == FACET_OK;
    if (result == FACET_OK)
        message_at(&run->base.messages,
                   is_given(run->base.line, OPT_OUTPUT) ? VERBOSITY_DETAILS : VERBOSITY_NORMAL,
                   "%s: %zu bytes", run->path, size);
    if (result == FACET_OK)
        print_fits(run);
    facet_bytes_destroy(bytes);
    return result;
}

static void add_json(const verb_run *base, json_t *root)
{
    const plot_run *run = (const plot_run *)base;
    json_object_set_new(root, "kind", json_string(kind_names[run->desc.kind]));
    json_object_set_new(root, "output", report_string_json(run->is_written ? run->path : NULL));
    json_object_set_new(root, "fits", fits_json(run));
}

static facet_result read_line(verb_run *base, facet_error *error)
{
    plot_run *run = (plot_run *)base;
    TRY(read_kind(run, error));
    TRY(read_output(run, error));
    return limits_read(base->line, &base->limits, error);
}

static facet_result read_and_plot(plot_run *run, facet_error *error)
{
    const command_line *c = run->base.line;
    interrupt_begin("facet", "plotting", false);
    TRY(read_desc(run, error));
    run->is_written = is_given(c, OPT_NO_CLOBBER) && output_exists(run->path);
    if (!run->is_written)
        return plot(run, error);
    message_at(&run->base.messages, VERBOSITY_NORMAL, "%s: kept, since it exists", run->path);
    return FACET_OK;
}

static facet_result work(verb_run *base, facet_error *error)
{
    plot_run *run = (plot_run *)base;
    run->desc.allocator = base->allocator;
    facet_result result = read_and_plot(run, error);
    if (result != FACET_OK)
        failure_complete(error, "plot", base->limits.max_memory_bytes);
    return result;
}

static void destroy(verb_run *base)
{
    plot_materials_destroy(&((plot_run *)base)->materials);
}

int cmd_plot(command_line *c)
{
    static const verb_work parts = {read_line, work, add_json, destroy};
    plot_run run = {.path = NULL};
    return verb_run_all(&run.base, c, &parts);
}
