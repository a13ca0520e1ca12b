/* plot_api.c - the part of facet.h about plots. */
#include <string.h>

#include "base/result.h"
#include "legacy/convert.h"
#include "legacy/fit.h"
#include "plot/plot.h"

facet_plot_material facet_plot_material_default(void)
{
    return (facet_plot_material){
        .model = FACET_PLOT_PBR,
        .base_color = {1, 1, 1},
        .perceptual_roughness = 0.5f,
        .ior = 1.5f,
        .specular = 1.0f,
        .specular_color = {1, 1, 1},
        .iridescence_ior = 1.3f,
        .iridescence_thickness_nm = 400.0f,
        .diffuse = {0.8f, 0.8f, 0.8f},
        .ogl1_specular = {1, 1, 1},
        .shininess = 50.0f,
    };
}

facet_result facet_plot_encode(const facet_plot_desc *desc, facet_plot_format format, unsigned char **bytes,
                               size_t *size, facet_error *error)
{
    const facet_plot_desc defaults = {0};
    desc = desc ? desc : &defaults;
    *bytes = NULL;
    *size = 0;
    arena *memory = arena_create(&desc->allocator);
    if (!memory)
        return fail_memory(error, "plot", 0);
    chart drawing = {0};
    facet_result result = plot_create(desc, memory, &drawing, error);
    if (result == FACET_OK)
        result = format == FACET_PLOT_CSV
                     ? chart_write_csv(&drawing, &desc->allocator, bytes, size, error)
                     : chart_draw(&drawing, format, &desc->allocator, bytes, size, error);
    arena_destroy(memory);
    return result;
}
