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

/* No dielectric reflects more than diamond, whose F0 is this. */
static const float MAX_DIELECTRIC_F0 = 0.17f;

/* A surface whose F0 is free (ior 0), as fits are: a metal where the interface returns more than any dielectric's, and most of
 * what is returned. Linear luminance of Rec.709. */
static void describe_free_F0(const facet_plot_material *p, text *t)
{
    static const double weights[3] = {0.2126, 0.7152, 0.0722};
    double reflected = 0.0, diffuse = 0.0;
    float F0[3];
    for (int c = 0; c < 3; c++) {
        float scaled = p->specular * p->specular_color[c];
        F0[c] = scaled < 1.0f ? scaled : 1.0f;
        reflected += weights[c] * (double)F0[c];
        diffuse += weights[c] * (double)p->base_color[c];
    }
    bool is_metal = reflected > (double)MAX_DIELECTRIC_F0 && reflected > 2.0 * diffuse;
    add_color(t, is_metal ? "metal " : "dielectric ", is_metal ? F0 : p->base_color);
    add_color(t, is_metal ? ", diffuse " : ", F0 ", is_metal ? p->base_color : F0);
}

static void describe_pbr(const facet_plot_material *p, text *t)
{
    bool is_metal = p->metallic >= 0.5f;
    if (p->metallic <= 0.0f && p->ior <= 0.0f) {
        describe_free_F0(p, t);
    } else {
        add_color(t, is_metal ? "metal " : "dielectric ", p->base_color);
        if (p->metallic > 0.0f && p->metallic < 1.0f)
            add_number(t, ", metallic ", p->metallic);
        if (p->metallic < 1.0f && (p->ior < 1.5f || p->ior > 1.5f))
            add_number(t, ", ior ", p->ior);
        if (p->metallic < 1.0f && p->specular < 1.0f)
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
    if (p->model == FACET_PLOT_MODEL_PBR)
        describe_pbr(p, &t);
    else if (p->model == FACET_PLOT_MODEL_OGL1) {
        add_color(&t, "OpenGL 1, diffuse ", p->diffuse);
        add_color(&t, ", specular ", p->ogl1_specular);
        add_number(&t, ", shininess ", p->shininess);
    } else
        text_add(&t, path_base_name(p->path));
    const char *label = t.has_failed ? NULL : arena_strdup(memory, t.data);
    text_destroy(&t);
    return label;
}
