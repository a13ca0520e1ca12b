/* plot_api.c - the part of facet.h about plots. */
#include <string.h>

#include "base/result.h"
#include "legacy/convert_surface.h"
#include "legacy/fit.h"
#include "plot/material.h"
#include "plot/plot.h"
#include "scene/legacy.h"

facet_plot_material facet_plot_material_default(void)
{
    return material_default();
}

/* What the fits leave out: layers above the base, and the roughness of the diffuse lobe. glTF takes the maximum of a thin film's thickness
 * where it has no texture. */
static void add_layers(const scene_material *from, facet_plot_material *to)
{
    to->clearcoat = from->clearcoat;
    to->clearcoat_roughness = from->clearcoat_roughness;
    memcpy(to->sheen_color, from->sheen_color, sizeof to->sheen_color);
    to->sheen_roughness = from->sheen_roughness;
    to->anisotropy = from->anisotropy;
    to->anisotropy_rotation_rad = from->anisotropy_rotation;
    to->iridescence = from->iridescence;
    to->iridescence_ior = from->iridescence_ior;
    to->iridescence_thickness_nm = from->iridescence_thickness_maximum;
    to->diffuse_roughness = from->diffuse_roughness;
}

facet_result facet_plot_material_from_scene(const facet_scene *scene, uint32_t index, facet_plot_model model,
                                            facet_plot_material *out, facet_error *error)
{
    *out = material_default();
    if (index >= scene->material_count)
        return fail(error, FACET_ERROR_ARGUMENT,
                    "%s: there is no material %u; the model has %u, counted from 0", scene->source, index,
                    scene->material_count);
    const scene_material *gltf = &scene->materials[index];
    if (model == FACET_PLOT_MODEL_PBR) {
        pbr_surface surface;
        legacy_surface_of_pbr(gltf, &surface);
        *out = material_from_pbr(&surface);
        add_layers(gltf, out);
    } else if (model == FACET_PLOT_MODEL_OGL1 && scene->legacy) {
        ogl1_surface surface;
        legacy_surface_of_ogl1(&scene->legacy->materials[index], scene->legacy->colors, &surface);
        *out = material_from_ogl1(&surface);
    } else if (model == FACET_PLOT_MODEL_OGL1)
        return fail(error, FACET_ERROR_ARGUMENT,
                    "%s: the model has no materials of OpenGL 1; they come with OBJ files or by a conversion",
                    scene->source);
    else
        return fail(error, FACET_ERROR_ARGUMENT,
                    "%s: a model has no measured materials; PBR or OpenGL 1 expected", scene->source);
    out->label = gltf->name[0] ? gltf->name : NULL;
    return FACET_OK;
}

facet_result facet_plot_encode(const facet_plot_desc *desc, facet_plot_format format, unsigned char **bytes,
                               size_t *size, facet_error *error)
{
    const facet_plot_desc defaults = {0};
    desc = desc ? desc : &defaults;
    *bytes = NULL;
    *size = 0;
    if ((int)format < 0 || format > FACET_PLOT_FORMAT_JSON)
        return fail(error, FACET_ERROR_ARGUMENT, "plot: there is no format %d; 0 to %d expected", (int)format,
                    (int)FACET_PLOT_FORMAT_JSON);
    arena *memory = arena_create(&desc->allocator);
    if (!memory)
        return fail_memory(error, "plot", 0);
    chart drawing = {0};
    facet_result result = plot_create(desc, memory, &drawing, error);
    if (result == FACET_OK)
        result = chart_draw(&drawing, format, &desc->allocator, bytes, size, error);
    arena_destroy(memory);
    return result;
}
