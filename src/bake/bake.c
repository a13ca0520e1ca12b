/* bake.c - cube maps of an environment for a lobe: which levels, and what makes them. */
#include "bake/bake.h"

#include "base/result.h"

float bake_roughness(facet_roughness_mapping mapping, uint32_t level, uint32_t level_count)
{
    float x = level_count > 1 ? (float)level / (float)(level_count - 1) : 0.0f;
    return mapping == FACET_MAPPING_FILAMENT ? 1.0f - sqrtf(1.0f - x) : x;
}

facet_result facet_cube_bake(facet_environment *environment, const facet_bake_desc *desc, facet_cube **out,
                             facet_error *error)
{
    (void)environment, (void)desc;
    *out = NULL;
    return fail(error, FACET_ERROR_UNSUPPORTED, "bake: not there yet");
}

void facet_cube_destroy(facet_cube *c)
{
    (void)c;
}

uint32_t facet_cube_get_level_count(const facet_cube *c)
{
    return c->level_count;
}

uint32_t facet_cube_get_size(const facet_cube *c, uint32_t level)
{
    return c->levels[level].size;
}

float facet_cube_get_roughness(const facet_cube *c, uint32_t level)
{
    return c->roughness[level];
}

facet_image_view facet_cube_get_face(const facet_cube *c, uint32_t level, uint32_t face)
{
    uint32_t size = c->levels[level].size;
    return (facet_image_view){.name = "",
                              .width = size,
                              .height = size,
                              .channel_count = 4,
                              .pixels = (const float *)cube_texel(&c->levels[level], face, 0, 0),
                              .row_stride_bytes = ((size_t)size + 2) * sizeof(rgbx)};
}

facet_bake_stats facet_cube_get_stats(const facet_cube *c)
{
    return c->stats;
}
