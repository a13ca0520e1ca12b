/* plot_check.c - see plot_check.h. */
#include <math.h>
#include <stddef.h>

#include "base/result.h"
#include "plot/plot_build.h"
#include "plot/plot_check.h"

enum { MAX_PIXELS = 16384 };

/* Numbers of a material: their ranges as facet.h gives them. */
typedef struct parameter {
    const char *name;
    size_t offset;
    int count;
    float minimum, maximum;
    bool has_zero; /* 0 is allowed besides */
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

static facet_result check_numbers(const facet_plot_material *m, const parameter *list, uint32_t number,
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
        return check_numbers(m, pbr_parameters, number, error);
    case FACET_PLOT_MODEL_OGL1:
        return check_numbers(m, ogl1_parameters, number, error);
    case FACET_PLOT_MODEL_MERL:
        if (m->path && *m->path)
            return FACET_OK;
        return fail(error, FACET_ERROR_ARGUMENT,
                    "plot: material %u has no path; that of a measured BRDF expected", number);
    }
    return fail(error, FACET_ERROR_ARGUMENT, "plot: material %u is of model %d, which there is not", number,
                (int)m->model);
}

/* What a kind cannot make of a material. */
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

facet_result plot_check(const facet_plot_desc *desc, facet_error *error)
{
    if ((int)desc->kind < 0 || desc->kind > FACET_PLOT_KIND_ERROR)
        return fail(error, FACET_ERROR_ARGUMENT, "plot: there is no kind %d; 0 to %d expected",
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
