/* plot.c - from a desc to a chart: checks the desc, prepares the materials, calls the function of the
 * kind. See plot.h. */
#include "plot/plot.h"

#include <math.h>
#include <stddef.h>

#include "base/result.h"
#include "facet/facet.h"
#include "plot/merl.h"
#include "plot/plot_build.h"

/* ---- the desc, checked ---- */

enum { MAX_PIXELS = 16384 };

/* Ranges of the parameters of a material, as in facet/plot.h. */
typedef struct parameter {
    const char *name;
    size_t offset;
    int count;
    float minimum, maximum;
    bool has_zero; /* 0 is allowed as well */
} parameter;

#define AT(member) offsetof(facet_plot_material, member)
static const parameter pbr_parameters[] = {
    {"base_color", AT(base_color), 3, 0.0f, 1.0f, false},
    {"metallic", AT(metallic), 1, 0.0f, 1.0f, false},
    {"perceptual_roughness", AT(perceptual_roughness), 1, 0.0f, 1.0f, false},
    {"ior", AT(ior), 1, 1.0f, 1e3f, true},
    {"specular", AT(specular), 1, 0.0f, 1.0f, false},
    {"specular_color", AT(specular_color), 3, 0.0f, 1e6f, false},
    {"clearcoat", AT(clearcoat), 1, 0.0f, 1.0f, false},
    {"clearcoat_roughness", AT(clearcoat_roughness), 1, 0.0f, 1.0f, false},
    {"sheen_color", AT(sheen_color), 3, 0.0f, 1.0f, false},
    {"sheen_roughness", AT(sheen_roughness), 1, 0.0f, 1.0f, false},
    {"anisotropy", AT(anisotropy), 1, 0.0f, 1.0f, false},
    {"anisotropy_rotation_rad", AT(anisotropy_rotation_rad), 1, -1e3f, 1e3f, false},
    {"iridescence", AT(iridescence), 1, 0.0f, 1.0f, false},
    {"iridescence_ior", AT(iridescence_ior), 1, 1.0f, 1e3f, false},
    {"iridescence_thickness_nm", AT(iridescence_thickness_nm), 1, 0.0f, 1e6f, false},
    {0}};
static const parameter ogl1_parameters[] = {{"diffuse", AT(diffuse), 3, 0.0f, 1e3f, false},
                                            {"ogl1_specular", AT(ogl1_specular), 3, 0.0f, 1e3f, false},
                                            {"shininess", AT(shininess), 1, 0.0f, 1e6f, false},
                                            {0}};
#undef AT

static facet_result check_parameters(const facet_plot_material *m, const parameter *list, uint32_t number,
                                     facet_error *error)
{
    for (; list->name; list++)
        for (int i = 0; i < list->count; i++) {
            float x = *(const float *)((const char *)m + list->offset + (size_t)i * sizeof(float));
            bool is_zero = list->has_zero && !(x < 0.0f) && !(x > 0.0f) && !isnan(x);
            if (!is_zero && !(x >= list->minimum && x <= list->maximum))
                return fail(error, FACET_ERROR_ARGUMENT,
                            "plot: %s of material %u is %g; a number from %g to %g expected%s", list->name,
                            number, (double)x, (double)list->minimum, (double)list->maximum,
                            list->has_zero ? ", or 0" : "");
        }
    return FACET_OK;
}

static facet_result check_material(const facet_plot_material *m, uint32_t number, facet_error *error)
{
    switch (m->model) {
    case FACET_PLOT_MODEL_PBR:
        return check_parameters(m, pbr_parameters, number, error);
    case FACET_PLOT_MODEL_OGL1:
        return check_parameters(m, ogl1_parameters, number, error);
    case FACET_PLOT_MODEL_MERL:
        if (m->path && *m->path)
            return FACET_OK;
        return fail(error, FACET_ERROR_ARGUMENT,
                    "plot: material %u has no path; that of a measured BRDF expected", number);
    }
    return fail(error, FACET_ERROR_ARGUMENT, "plot: material %u: model %d is not a facet_plot_model", number,
                (int)m->model);
}

/* Materials that a kind does not support. */
static facet_result check_kind(facet_plot_kind kind, const facet_plot_material *m, uint32_t number,
                               facet_error *error)
{
    static const char *const names[] = {"PBR", "OpenGL 1", "measured"};
    bool is_pbr = m->model == FACET_PLOT_MODEL_PBR;
    const char *expected = NULL;
    if (kind == FACET_PLOT_KIND_TERMS && !is_pbr)
        expected = "terms are those of PBR materials";
    else if ((kind == FACET_PLOT_KIND_ERROR || kind == FACET_PLOT_KIND_FURNACE) &&
             m->model == FACET_PLOT_MODEL_MERL)
        expected = "one whose roughness can be varied expected";
    else if (kind == FACET_PLOT_KIND_DFG || kind == FACET_PLOT_KIND_TONE)
        expected = "this kind of plot shows no materials";
    if (!expected)
        return FACET_OK;
    return fail(error, FACET_ERROR_ARGUMENT, "plot: material %u is %s; %s", number, names[m->model],
                expected);
}

/* FACET_ERROR_ARGUMENT names the count, angle, size or material parameter that is out of range. */
static facet_result check_desc(const facet_plot_desc *desc, facet_error *error)
{
    if ((int)desc->kind < 0 || desc->kind > FACET_PLOT_KIND_ERROR)
        return fail(error, FACET_ERROR_ARGUMENT, "plot: kind %d is not a facet_plot_kind; 0 to %d expected",
                    (int)desc->kind, (int)FACET_PLOT_KIND_ERROR);
    if (desc->material_count > FACET_PLOT_MAX_MATERIALS)
        return fail(error, FACET_ERROR_ARGUMENT, "plot: %u materials; at most %d expected",
                    desc->material_count, FACET_PLOT_MAX_MATERIALS);
    if (desc->angle_count > FACET_PLOT_MAX_ANGLES)
        return fail(error, FACET_ERROR_ARGUMENT, "plot: %u angles of the view; at most %d expected",
                    desc->angle_count, FACET_PLOT_MAX_ANGLES);
    if (desc->width > MAX_PIXELS || desc->height > MAX_PIXELS)
        return fail(error, FACET_ERROR_ARGUMENT, "plot: %u x %u pixels; at most %d x %d expected",
                    desc->width, desc->height, MAX_PIXELS, MAX_PIXELS);
    for (uint32_t i = 0; i < desc->angle_count; i++) {
        double degrees = (double)desc->angles_rad[i] / PLOT_DEGREE;
        if (!(degrees >= 0.0 && degrees < 90.0))
            return fail(error, FACET_ERROR_ARGUMENT,
                        "plot: angle %u of the view is %.6g degrees; at least 0 and less than 90 expected",
                        i + 1, degrees);
    }
    for (uint32_t i = 0; i < desc->material_count; i++) {
        facet_result result = check_material(&desc->materials[i], i + 1, error);
        if (result == FACET_OK)
            result = check_kind(desc->kind, &desc->materials[i], i + 1, error);
        if (result != FACET_OK)
            return result;
    }
    return FACET_OK;
}

/* ---- what a kind shows by default ---- */

typedef struct plot_kind {
    facet_result (*make)(plot *p);
    bool shows_reflectance; /* of materials: has default materials, and fits */
    uint32_t angle_count;
    float degrees[3];
} plot_kind;

static const plot_kind kinds[] = {
    [FACET_PLOT_KIND_LEGACY] = {plot_make_legacy, false, 3, {0.0f, 30.0f, 60.0f}},
    [FACET_PLOT_KIND_BRDF] = {plot_make_slices, true, 2, {30.0f, 60.0f}},
    [FACET_PLOT_KIND_SLICE] = {plot_make_slices, true, 1, {30.0f}},
    [FACET_PLOT_KIND_HEMISPHERE] = {plot_make_hemisphere, true, 1, {45.0f}},
    [FACET_PLOT_KIND_LOBE] = {plot_make_hemisphere, true, 1, {45.0f}},
    [FACET_PLOT_KIND_TERMS] = {plot_make_terms, false, 1, {45.0f}},
    [FACET_PLOT_KIND_ALBEDO] = {plot_make_albedo, true, 1, {0.0f}},
    [FACET_PLOT_KIND_FURNACE] = {plot_make_furnace, false, 2, {30.0f, 75.0f}},
    [FACET_PLOT_KIND_DFG] = {plot_make_dfg, false, 1, {0.0f}},
    [FACET_PLOT_KIND_TONE] = {plot_make_tone, false, 1, {0.0f}},
    [FACET_PLOT_KIND_FRESNEL] = {plot_make_fresnel, false, 1, {0.0f}},
    [FACET_PLOT_KIND_ERROR] = {plot_make_error, false, 1, {0.0f}},
};

enum { DEFAULT_MATERIALS = 6 };

/* Gold and plastic, smooth to rough. */
static void default_materials(facet_plot_material out[DEFAULT_MATERIALS])
{
    static const struct {
        const char *label;
        float metallic, roughness;
    } list[DEFAULT_MATERIALS] = {
        {"gold, roughness 0.35", 1.0f, 0.35f},  {"gold, roughness 0.5", 1.0f, 0.5f},
        {"gold, roughness 0.7", 1.0f, 0.7f},    {"plastic, roughness 0.35", 0.0f, 0.35f},
        {"plastic, roughness 0.5", 0.0f, 0.5f}, {"plastic, roughness 0.7", 0.0f, 0.7f}};
    static const float colors[2][3] = {{0.05f, 0.2f, 0.6f}, {1.0f, 0.766f, 0.336f}};
    for (int i = 0; i < DEFAULT_MATERIALS; i++) {
        out[i] = material_default();
        out[i].label = list[i].label;
        out[i].metallic = list[i].metallic;
        out[i].perceptual_roughness = list[i].roughness;
        for (int c = 0; c < 3; c++)
            out[i].base_color[c] = colors[list[i].metallic > 0.0f][c];
    }
}

/* ---- subjects ---- */

static facet_result open_material(plot *p, const facet_plot_material *from, merl **file, material *out)
{
    const facet_plot_desc *desc = p->desc;
    *out = (material){
        .parameters = *from, .energy = plot_energy(desc), .has_separable_smith = desc->has_separable_smith};
    out->label = from->label ? arena_strdup(p->memory, from->label)
                             : material_describe(from, &desc->allocator, p->memory);
    if (!out->label)
        return fail_memory(p->error, "plot", 0);
    if (from->model != FACET_PLOT_MODEL_MERL)
        return FACET_OK;
    facet_result result = merl_open(from->path, &desc->allocator, file, p->error);
    out->measured = *file;
    return result;
}

/* The materials, each followed by its fit if fits are requested. */
static facet_result open_subjects(plot *p, const plot_kind *kind, merl *files[FACET_PLOT_MAX_MATERIALS])
{
    facet_plot_material defaults[DEFAULT_MATERIALS];
    const facet_plot_material *list = p->desc->materials;
    uint32_t count = p->desc->material_count;
    if (count == 0 && kind->shows_reflectance) {
        default_materials(defaults);
        list = defaults;
        count = DEFAULT_MATERIALS;
    }
    plot_subject *subjects = plot_alloc(p, 2 * FACET_PLOT_MAX_MATERIALS, sizeof *subjects);
    if (!subjects)
        return fail_memory(p->error, "plot", 0);
    p->subjects = subjects;
    p->has_channels = count == 1;
    p->material_count = count;
    for (uint32_t i = 0; i < count; i++) {
        plot_subject *subject = &subjects[p->subject_count++];
        *subject = (plot_subject){.number = i};
        TRY(open_material(p, &list[i], &files[i], &subject->material));
        if (!p->desc->has_fit || !kind->shows_reflectance)
            continue;
        facet_plot_model to =
            list[i].model == FACET_PLOT_MODEL_PBR ? FACET_PLOT_MODEL_OGL1 : FACET_PLOT_MODEL_PBR;
        plot_conversion conversion;
        TRY(plot_convert(p, &subject->material, to, true, &conversion));
        plot_report_fit(p, i, &subject->material, &conversion);
        subjects[p->subject_count++] =
            (plot_subject){.material = conversion.material, .number = i, .is_fit = true};
    }
    p->has_cosine = p->desc->has_cosine;
    for (uint32_t i = 0; i < p->subject_count; i++)
        p->has_cosine = p->has_cosine || subjects[i].material.parameters.model == FACET_PLOT_MODEL_OGL1;
    return FACET_OK;
}

facet_result plot_create(const facet_plot_desc *desc, arena *memory, chart *out, facet_error *error)
{
    *out = (chart){0};
    facet_result result = check_desc(desc, error);
    if (result != FACET_OK)
        return result;
    const plot_kind *kind = &kinds[desc->kind];
    for (uint32_t i = 0; desc->fits && i < FACET_PLOT_MAX_MATERIALS; i++)
        desc->fits[i] = (facet_plot_fit){.is_found = false};
    merl *files[FACET_PLOT_MAX_MATERIALS] = {NULL};
    float angles[3];
    for (uint32_t i = 0; i < kind->angle_count; i++)
        angles[i] = kind->degrees[i] * (float)PLOT_DEGREE;
    plot p = {.desc = desc,
              .memory = memory,
              .out = out,
              .error = error,
              .angle_count = desc->angle_count ? desc->angle_count : kind->angle_count,
              .angles = desc->angle_count ? desc->angles_rad : angles,
              .has_default_materials = desc->material_count == 0,
              .has_default_angles = desc->angle_count == 0};
    result = open_subjects(&p, kind, files);
    if (result == FACET_OK)
        result = kind->make(&p);
    fit_metric_destroy(p.metric);
    for (uint32_t i = 0; i < FACET_PLOT_MAX_MATERIALS; i++)
        merl_close(files[i]);
    return result;
}
