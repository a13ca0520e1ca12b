/* morph.c - see morph.h. glTF 2.0, section 3.7.2.2: attributes plus the weighted sum of the targets' changes. */
#include "scene/morph.h"

#include <string.h>

#include "base/simd.h"

enum { BLOCK = 512 /* vertices whose sums stay in the first cache */ };

static uint32_t used_targets(const scene_primitive *primitive, uint32_t weight_count)
{
    return primitive->target_count < weight_count ? primitive->target_count : weight_count;
}

morph_use morph_get_use(const scene_primitive *primitive, const float *weights, uint32_t weight_count)
{
    morph_use use = {false, false, false};
    for (uint32_t i = 0; i < used_targets(primitive, weight_count); i++) {
        const scene_morph_target *target = &primitive->targets[i];
        if (weights[i] == 0.0f)
            continue;
        use.positions |= target->positions != NULL;
        use.normals |= target->normals && primitive->normals;
        use.tangents |= target->tangents && primitive->tangents;
    }
    return use;
}

DISPATCH_AVX2 static void add_scaled(float *restrict out, const float *restrict change, float weight,
                                     size_t count)
{
    for (size_t i = 0; i < count; i++)
        out[i] += weight * change[i];
}

/* Tangents have a fourth number, their changes do not. */
static void add_scaled_tangents(float *restrict out, const float *restrict change, float weight, size_t count)
{
    for (size_t i = 0; i < count; i++)
        for (size_t k = 0; k < 3; k++)
            out[4 * i + k] += weight * change[3 * i + k];
}

static void morph_block(const scene_primitive *primitive, const float *weights, uint32_t target_count,
                        size_t first, size_t count, const vertex_arrays *out)
{
    if (out->positions)
        memcpy(out->positions + 3 * first, primitive->positions + 3 * first, 3 * count * sizeof(float));
    if (out->normals)
        memcpy(out->normals + 3 * first, primitive->normals + 3 * first, 3 * count * sizeof(float));
    if (out->tangents)
        memcpy(out->tangents + 4 * first, primitive->tangents + 4 * first, 4 * count * sizeof(float));
    for (uint32_t i = 0; i < target_count; i++) {
        const scene_morph_target *target = &primitive->targets[i];
        if (weights[i] == 0.0f)
            continue;
        if (out->positions && target->positions)
            add_scaled(out->positions + 3 * first, target->positions + 3 * first, weights[i], 3 * count);
        if (out->normals && target->normals)
            add_scaled(out->normals + 3 * first, target->normals + 3 * first, weights[i], 3 * count);
        if (out->tangents && target->tangents)
            add_scaled_tangents(out->tangents + 4 * first, target->tangents + 3 * first, weights[i], count);
    }
}

void morph_vertices(const scene_primitive *primitive, const float *weights, uint32_t weight_count,
                    size_t begin, size_t end, const vertex_arrays *out)
{
    uint32_t target_count = used_targets(primitive, weight_count);
    for (size_t first = begin; first < end; first += BLOCK)
        morph_block(primitive, weights, target_count, first, end - first < BLOCK ? end - first : BLOCK, out);
}
