/* material_label.c - a name for a material that has none, of the parameters that matter. See material.h. */
#include "base/file.h"
#include "base/text.h"
#include "plot/material.h"

static bool is_gray(const float c[3])
{
    return !(c[0] < c[1]) && !(c[0] > c[1]) && !(c[1] < c[2]) && !(c[1] > c[2]);
}

/* " name 0.3" or " name (0.8, 0.1, 0.1)", as short as the numbers allow. */
static void add_number(text *t, const char *before, float value)
{
    text_addf(t, "%s%.3g", before, (double)value);
}
static void add_color(text *t, const char *before, const float c[3])
{
    if (is_gray(c))
        add_number(t, before, c[0]);
    else
        text_addf(t, "%s(%.3g, %.3g, %.3g)", before, (double)c[0], (double)c[1], (double)c[2]);
}

static void describe_pbr(const facet_plot_material *p, text *t)
{
    if (p->metallic >= 1.0f)
        add_color(t, "metal ", p->base_color);
    else {
        add_color(t, "dielectric ", p->base_color);
        if (p->metallic > 0.0f)
            add_number(t, ", metallic ", p->metallic);
        if (p->ior < 1.5f || p->ior > 1.5f)
            add_number(t, ", ior ", p->ior);
        if (p->specular < 1.0f)
            add_number(t, ", specular ", p->specular);
    }
    add_number(t, ", roughness ", p->perceptual_roughness);
    if (p->clearcoat > 0.0f)
        add_number(t, ", clearcoat ", p->clearcoat);
    if (p->sheen_color[0] > 0.0f || p->sheen_color[1] > 0.0f || p->sheen_color[2] > 0.0f)
        add_number(t, ", sheen of roughness ", p->sheen_roughness);
    if (p->anisotropy > 0.0f)
        add_number(t, ", anisotropy ", p->anisotropy);
    if (p->iridescence > 0.0f)
        text_addf(t, ", film of %.4g nm", (double)p->iridescence_thickness_nm);
}

const char *material_describe(const facet_plot_material *p, const facet_allocator *allocator, arena *memory)
{
    text t = {.allocator = *allocator};
    if (p->model == FACET_PLOT_PBR)
        describe_pbr(p, &t);
    else if (p->model == FACET_PLOT_OGL1) {
        add_color(&t, "OpenGL 1, diffuse ", p->diffuse);
        add_color(&t, ", specular ", p->ogl1_specular);
        add_number(&t, ", shininess ", p->shininess);
    } else
        text_add(&t, path_base_name(p->path));
    const char *label = t.has_failed ? NULL : arena_strdup(memory, t.data);
    text_destroy(&t);
    return label;
}
