/* texture_sample.c - filtered lookups. See texture.h. The filters that are rare are here, one texture at a time. */
#include <string.h>

#include "draw/texture_texel.h"
#include "draw/texture_trilinear.h"

/* The two texels of an edge between whose centers a coordinate in [0, 1] lies, and how far. Clamped and mirrored
 * edges continue with their last texel. */
typedef struct taps {
    int32_t first, second;
    float fraction;
} taps;

INLINE taps get_taps(float coordinate, uint32_t size, scene_wrap wrap)
{
    float x = coordinate * (float)size - 0.5f;
    int32_t first = (int32_t)(x + 1.0f) - 1; /* floor, as x >= -0.5 */
    int32_t second = first + 1;
    float fraction = x - (float)first;
    int32_t last = (int32_t)size - 1;
    if (first < 0)
        first = wrap == SCENE_WRAP_REPEAT ? last : 0;
    if (second > last)
        second = wrap == SCENE_WRAP_REPEAT ? 0 : last;
    return (taps){.first = first, .second = second, .fraction = fraction};
}

/* ---- one level ---- */

INLINE float4 blend_taps(const texture_pyramid *p, const texture_level *level, taps x, taps y,
                         uint32_t channel_count, image_type type)
{
    size_t row_0 = (size_t)y.first * level->width;
    size_t row_1 = (size_t)y.second * level->width;
    float4 a = fetch(p, level->texels, row_0 + (size_t)x.first, channel_count, type);
    float4 b = fetch(p, level->texels, row_0 + (size_t)x.second, channel_count, type);
    float4 c = fetch(p, level->texels, row_1 + (size_t)x.first, channel_count, type);
    float4 d = fetch(p, level->texels, row_1 + (size_t)x.second, channel_count, type);
    float4 above = a + (b - a) * x.fraction;
    float4 below = c + (d - c) * x.fraction;
    return above + (below - above) * y.fraction;
}

/* Bilinear, at (u, v) in [0, 1]. */
INLINE float4 look_up_linear(const texture_binding *b, const texture_pyramid *p, uint32_t level_number,
                             float u, float v)
{
    const texture_level *level = &p->levels[level_number];
    taps x = get_taps(u, level->width, b->wrap_u);
    taps y = get_taps(v, level->height, b->wrap_v);
    if (p->type == IMAGE_U8)
        switch (p->channel_count) {
        case 1:
            return blend_taps(p, level, x, y, 1, IMAGE_U8);
        case 2:
            return blend_taps(p, level, x, y, 2, IMAGE_U8);
        case 3:
            return blend_taps(p, level, x, y, 3, IMAGE_U8);
        default:
            return blend_taps(p, level, x, y, 4, IMAGE_U8);
        }
    return blend_taps(p, level, x, y, p->channel_count, IMAGE_U16);
}

static float4 look_up_nearest(const texture_pyramid *p, uint32_t level_number, float u, float v)
{
    const texture_level *level = &p->levels[level_number];
    uint32_t x = (uint32_t)(u * (float)level->width);
    uint32_t y = (uint32_t)(v * (float)level->height);
    x = x < level->width ? x : level->width - 1;
    y = y < level->height ? y : level->height - 1;
    return fetch(p, level->texels, (size_t)y * level->width + x, p->channel_count, p->type);
}

static float4 look_up(const texture_binding *b, const texture_pyramid *p, uint32_t level, scene_filter filter,
                      float u, float v)
{
    return filter == SCENE_FILTER_NEAREST ? look_up_nearest(p, level, u, v)
                                          : look_up_linear(b, p, level, u, v);
}

static float4 sample_minified(const texture_binding *b, const texture_pyramid *p, const float uv[2],
                              const Footprint *f)
{
    float u = wrap_coordinate(uv[0], b->wrap_u);
    float v = wrap_coordinate(uv[1], b->wrap_v);
    if (b->mip_filter == SCENE_MIP_NONE)
        return look_up(b, p, p->first_level, b->min_filter, u, v);
    level_pair levels = get_levels(p, f->longest2);
    if (b->mip_filter ==
        SCENE_MIP_NEAREST) /* at lod + 1/2 exactly it is the finer one: OpenGL 4.6, equation 8.16 */
        return look_up(b, p, levels.fraction > 0.5f ? levels.second : levels.first, b->min_filter, u, v);
    float4 fine = look_up(b, p, levels.first, b->min_filter, u, v);
    float4 coarse = look_up(b, p, levels.second, b->min_filter, u, v);
    return fine + (coarse - fine) * levels.fraction;
}

static bool is_trilinear(const texture_binding *b)
{
    return b->mip_filter == SCENE_MIP_LINEAR && b->min_filter == SCENE_FILTER_LINEAR;
}

/* Whether the magnification filter applies: up to lod 0, or 0.5 where minification is coarser by a nearest filter
 * (OpenGL ES 3.0, section 3.8.11). */
static bool is_magnified(const texture_binding *b, const Footprint *f)
{
    bool has_mips = b->mip_filter != SCENE_MIP_NONE;
    if (has_mips && b->mag_filter == SCENE_FILTER_LINEAR && b->min_filter == SCENE_FILTER_NEAREST)
        return f->longest2 <= 2.0f;
    if (is_trilinear(b))
        return f->major2 <= 1.0f;
    return f->longest2 <= 1.0f;
}

static const texture_pyramid *find_pyramid(const texture_set *set, const texture_request *request)
{
    if (request->texture >= set->binding_count)
        return NULL;
    const texture_binding *b = &set->bindings[request->texture];
    return request->as_color ? b->color : b->data;
}

/* Looks up requests[first] and all those behind it that are alike; returns them as bits. */
static uint32_t sample_alike(const texture_set *set, texture_request *requests, uint32_t first,
                             uint32_t count, const float uv[2], const Footprint *f)
{
    const texture_binding *b = &set->bindings[requests[first].texture];
    const texture_pyramid *pyramids[TEXTURE_GROUP] = {find_pyramid(set, &requests[first])};
    uint32_t numbers[TEXTURE_GROUP] = {first};
    uint32_t alike = 1;
    for (uint32_t i = first + 1; i < count; i++) {
        const texture_pyramid *p = find_pyramid(set, &requests[i]);
        if (!p || !texture_is_alike(b, pyramids[0], &set->bindings[requests[i].texture], p))
            continue;
        pyramids[alike] = p;
        numbers[alike++] = i;
    }
    float texels[TEXTURE_GROUP][4];
    texture_trilinear(b, pyramids, alike, uv, f, texels);
    uint32_t bits = 0;
    for (uint32_t k = 0; k < alike; k++) {
        memcpy(requests[numbers[k]].texel, texels[k], sizeof texels[k]);
        bits |= 1u << numbers[k];
    }
    return bits;
}

void texture_sample_group(const texture_set *set, texture_request *requests, uint32_t count,
                          const float uv[2], const float duv_dx[2], const float duv_dy[2])
{
    uint32_t done = 0; /* bits */
    for (uint32_t i = 0; i < count; i++) {
        if (done >> i & 1)
            continue;
        float4 texel = {1.0f, 1.0f, 1.0f, 1.0f};
        const texture_pyramid *p = find_pyramid(set, &requests[i]);
        if (p) {
            const texture_binding *b = &set->bindings[requests[i].texture];
            Footprint f;
            if (!get_footprint(p, duv_dx, duv_dy, &f)) {
                texel = look_up_nearest(p, p->level_count - 1, 0.0f, 0.0f); /* the mean of the image */
            } else if (is_magnified(b, &f)) {
                texel = look_up(b, p, p->first_level, b->mag_filter, wrap_coordinate(uv[0], b->wrap_u),
                                wrap_coordinate(uv[1], b->wrap_v));
            } else if (is_trilinear(b)) {
                done |= sample_alike(set, requests, i, count, uv, &f);
                continue;
            } else {
                texel = sample_minified(b, p, uv, &f);
            }
        }
        memcpy(requests[i].texel, &texel, sizeof texel);
    }
}

void texture_sample(const texture_set *set, uint32_t index, bool as_color, const float uv[2],
                    const float duv_dx[2], const float duv_dy[2], float out[4])
{
    texture_request request = {.texture = index, .as_color = as_color};
    texture_sample_group(set, &request, 1, uv, duv_dx, duv_dy);
    memcpy(out, request.texel, sizeof request.texel);
}
