/* caustic_map.c - see caustic_map.h. The widest layer fades to the mean, 1; each other one to the next. */
#include "ocean/caustic_map.h"

#include <math.h>

#include "base/memory.h"
#include "base/result.h"
#include "shade/shade.h"

facet_result caustic_map_create(const facet_allocator *allocator, caustic_map *map, facet_error *error)
{
    *map = (caustic_map){.is_there = false};
    size_t texels = 0;
    for (uint32_t m = 0; m < CAUSTIC_MIPS; m++)
        texels += (size_t)(CAUSTIC_SIZE >> m) * (CAUSTIC_SIZE >> m);
    for (uint32_t l = 0; l < CAUSTIC_LAYERS; l++) {
        float *mip = mem_alloc(allocator, texels, sizeof *mip);
        if (!mip)
            return fail_memory(error, "a map of sunlight on the bed", texels * sizeof *mip);
        for (uint32_t m = 0; m < CAUSTIC_MIPS; m++) {
            map->layers[l].mips[m] = mip;
            mip += (size_t)(CAUSTIC_SIZE >> m) * (CAUSTIC_SIZE >> m);
        }
    }
    return FACET_OK;
}

void caustic_map_destroy(caustic_map *map)
{
    for (uint32_t l = 0; l < CAUSTIC_LAYERS; l++)
        mem_free(map->layers[l].mips[0]);
    *map = (caustic_map){.is_there = false};
}

void caustic_layer_reduce(caustic_layer *layer)
{
    for (uint32_t m = 1; m < CAUSTIC_MIPS; m++) {
        size_t edge = CAUSTIC_SIZE >> m;
        for (size_t z = 0; z < edge; z++)
            for (size_t x = 0; x < edge; x++) {
                const float *from = layer->mips[m - 1] + 4 * z * edge + 2 * x;
                layer->mips[m][z * edge + x] =
                    0.25f * (from[0] + from[1] + from[2 * edge] + from[2 * edge + 1]);
            }
    }
}

/* Interpolated between texel centers; place in [-1, 1]^2. */
static float read_mip(const caustic_layer *layer, uint32_t mip, vec2 place)
{
    int edge = CAUSTIC_SIZE >> mip;
    float u = (0.5f + 0.5f * place[0]) * (float)edge - 0.5f,
          v = (0.5f + 0.5f * place[1]) * (float)edge - 0.5f;
    int x = (int)floorf(u), z = (int)floorf(v), last = edge - 1;
    float fx = u - (float)x, fz = v - (float)z;
    const float *texels = layer->mips[mip];
    int x0 = x < 0 ? 0 : x, x1 = x + 1 > last ? last : x + 1, z0 = z < 0 ? 0 : z,
        z1 = z + 1 > last ? last : z + 1;
    float near = mix(texels[z0 * edge + x0], texels[z0 * edge + x1], fx);
    return mix(near, mix(texels[z1 * edge + x0], texels[z1 * edge + x1], fx), fz);
}

static float read_layer(const caustic_layer *layer, vec2 place, float footprint_m)
{
    float lod = caustic_lod(footprint_m / layer->texel_m);
    if (lod >= CAUSTIC_MIPS - 1)
        return layer->mips[CAUSTIC_MIPS - 1][0];
    uint32_t mip = (uint32_t)lod;
    float share = lod - (float)mip, here = read_mip(layer, mip, place);
    return share > 0.0f ? mix(here, read_mip(layer, mip + 1, place), share) : here;
}

float caustic_map_within(const caustic_map *map, double X, double Z, float footprint_m, float *beyond)
{
    float sum = 0.0f, open = 1.0f;
    for (uint32_t l = 0; map->is_there && l < CAUSTIC_LAYERS && open > 0.0f; l++) {
        const caustic_layer *layer = &map->layers[l];
        float x = (float)(X - layer->middle[0]), z = (float)(Z - layer->middle[1]);
        float per_m = 2.0f / (layer->texel_m * CAUSTIC_SIZE);
        vec2 place = vec2(per_m * (x * map->axis[0] + z * map->axis[1]),
                          per_m * (z * map->axis[0] - x * map->axis[1]));
        float cover = open * caustic_cover(place);
        if (cover > 0.0f)
            sum += cover * read_layer(layer, place, footprint_m);
        open -= cover;
    }
    *beyond = open;
    return sum;
}

float caustic_map_at(const caustic_map *map, double X, double Z, float footprint_m)
{
    float open, sum = caustic_map_within(map, X, Z, footprint_m, &open);
    return sum + open;
}
