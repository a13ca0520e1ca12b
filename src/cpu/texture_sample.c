/* texture_sample.c - filtered lookups. See texture.h. */
#include <math.h>
#include <string.h>

#include "cpu/texture_footprint.h"
#include "cpu/texture_set.h"

typedef float float4 __attribute__((vector_size(16))); /* RGBA; or u and v of two levels */
typedef int32_t int4 __attribute__((vector_size(16)));
typedef uint32_t uint4 __attribute__((vector_size(16)));

/* ---- coordinates ---- */

/* Texture coordinate u of any value, NaN and infinity too, to [0, 1] of the image as wrap has it. Beyond 2^23 floats
 * have no fraction. */
INLINE float wrap_coordinate(float u, scene_wrap wrap)
{
    if (wrap == SCENE_WRAP_CLAMP)
        return u > 0.0f ? (u < 1.0f ? u : 1.0f) : 0.0f;
    if (!(fabsf(u) < 8388608.0f))
        return 0.0f;
    if (wrap == SCENE_WRAP_REPEAT) {
        float fraction = u - (float)(int)u;
        return fraction < 0.0f ? fraction + 1.0f : fraction;
    }
    int tile = (int)fabsf(u);
    float fraction = fabsf(u) - (float)tile;
    return tile & 1 ? 1.0f - fraction : fraction;
}

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

/* ---- texels ---- */

INLINE float4 fetch_8(const texture_pyramid *p, const unsigned char *texel, uint32_t channel_count)
{
    const float *color = p->color_values;
    switch (channel_count) {
    case 1:
        return (float4){color[texel[0]], color[texel[0]], color[texel[0]], 1.0f};
    case 2:
        return (float4){color[texel[0]], color[texel[0]], color[texel[0]], p->alpha_values[texel[1]]};
    case 3:
        return (float4){color[texel[0]], color[texel[1]], color[texel[2]], 1.0f};
    default:
        return (float4){color[texel[0]], color[texel[1]], color[texel[2]], p->alpha_values[texel[3]]};
    }
}

INLINE float4 fetch_16(const unsigned char *texel, uint32_t channel_count)
{
    uint16_t v[4] = {0, 0, 0, 65535};
    memcpy(v, texel, channel_count * sizeof *v);
    if (channel_count < 3) {
        v[3] = channel_count == 2 ? v[1] : 65535;
        v[1] = v[2] = v[0];
    }
    return (float4){(float)v[0], (float)v[1], (float)v[2], (float)v[3]} * (1.0f / 65535.0f);
}

INLINE float4 fetch(const texture_pyramid *p, const unsigned char *texels, size_t index,
                    uint32_t channel_count, image_type type)
{
    return type == IMAGE_U8 ? fetch_8(p, texels + index * channel_count, channel_count)
                            : fetch_16(texels + index * channel_count * 2, channel_count);
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

/* ---- two levels at once ---- */

/* Four texels of 8 bits that all channels read alike, to be blended: 255 stands for 1. */
typedef unsigned char byte16 __attribute__((vector_size(16)));
typedef uint16_t short8 __attribute__((vector_size(16)));

INLINE float4 unpack(uint32_t texel)
{
    const byte16 zero = {0};
    byte16 bytes = (byte16)(uint4){texel, 0, 0, 0};
    short8 shorts =
        (short8)__builtin_shufflevector(bytes, zero, 0, 16, 1, 17, 2, 18, 3, 19, 4, 20, 5, 21, 6, 22, 7, 23);
    int4 ints = (int4)__builtin_shufflevector(shorts, (short8)zero, 0, 8, 1, 9, 2, 10, 3, 11);
    return __builtin_convertvector(ints, float4);
}

/* fetch(), but 8-bit data of three and four channels in [0, 255]: see blend_levels(). */
INLINE float4 fetch_raw(const texture_pyramid *p, const unsigned char *texels, size_t index,
                        uint32_t channel_count, image_type type, bool is_data)
{
    if (type == IMAGE_U8 && is_data && channel_count == 4) {
        uint32_t texel;
        memcpy(&texel, texels + 4 * index, sizeof texel);
        return unpack(texel);
    }
    if (type == IMAGE_U8 && is_data && channel_count == 3) {
        uint32_t texel; /* and a byte more: MEM_TAIL allows it */
        memcpy(&texel, texels + 3 * index, sizeof texel);
        return unpack(texel | 0xff000000u);
    }
    return fetch(p, texels, index, channel_count, type);
}

/* Where a lookup reads two levels: lanes 0 and 1 are u and v of the first, 2 and 3 of the second. */
typedef struct level_pair_view {
    const unsigned char *texels[2];
    float4 size;
    int4 int_size;
    int4 wrap_step; /* from behind an edge to where it goes on: the size where the axis repeats, else 1 */
    size_t width[2];
    float fraction; /* of the second */
} level_pair_view;

INLINE level_pair_view view_levels(const texture_binding *b, const texture_pyramid *p, float width_2)
{
    level_pair levels = get_levels(p, width_2);
    const texture_level *first = &p->levels[levels.first];
    const texture_level *second = &p->levels[levels.second];
    level_pair_view view = {.texels = {first->texels, second->texels},
                            .size = {first->size[0], first->size[1], second->size[0], second->size[1]},
                            .int_size = {(int32_t)first->width, (int32_t)first->height,
                                         (int32_t)second->width, (int32_t)second->height},
                            .width = {first->width, second->width},
                            .fraction = levels.fraction};
    int32_t repeat_u = b->wrap_u == SCENE_WRAP_REPEAT ? -1 : 0;
    int32_t repeat_v = b->wrap_v == SCENE_WRAP_REPEAT ? -1 : 0;
    int4 repeats = {repeat_u, repeat_v, repeat_u, repeat_v};
    view.wrap_step = (repeats & view.int_size) | (~repeats & 1);
    return view;
}

/* Trilinear, at (u, v) in [0, 1]. What get_taps() does, for four coordinates. */
INLINE float4 blend_levels(const texture_pyramid *p, const level_pair_view *view, float u, float v,
                           uint32_t channel_count, image_type type, bool is_data)
{
    float4 x = (float4){u, v, u, v} * view->size - 0.5f;
    int4 first = __builtin_convertvector(x + 1.0f, int4) - 1;
    float4 fraction = x - __builtin_convertvector(first, float4);
    int4 second = first + 1;
    first += (first < 0) & view->wrap_step;
    second -= (second >= view->int_size) & view->wrap_step;
    float4 level[2];
    for (int k = 0; k < 2; k++) {
        const unsigned char *texels = view->texels[k];
        size_t row_0 = (size_t)first[2 * k + 1] * view->width[k];
        size_t row_1 = (size_t)second[2 * k + 1] * view->width[k];
        size_t left = (size_t)first[2 * k];
        size_t right = (size_t)second[2 * k];
        float4 a = fetch_raw(p, texels, row_0 + left, channel_count, type, is_data);
        float4 b = fetch_raw(p, texels, row_0 + right, channel_count, type, is_data);
        float4 c = fetch_raw(p, texels, row_1 + left, channel_count, type, is_data);
        float4 d = fetch_raw(p, texels, row_1 + right, channel_count, type, is_data);
        float4 above = a + (b - a) * fraction[2 * k];
        float4 below = c + (d - c) * fraction[2 * k];
        level[k] = above + (below - above) * fraction[2 * k + 1];
    }
    return level[0] + (level[1] - level[0]) * view->fraction;
}

/* sample_trilinear() for a format that is a constant at each call. */
INLINE float4 sum_probes(const texture_binding *b, const texture_pyramid *p, const float uv[2],
                         const probe_row *probes, uint32_t channel_count, image_type type, bool is_data)
{
    level_pair_view view = view_levels(b, p, probes->width_2);
    float begin = -0.5f * (float)(probes->count - 1);
    float4 sum = {0.0f, 0.0f, 0.0f, 0.0f};
    for (uint32_t i = 0; i < probes->count; i++) {
        float u = wrap_coordinate(uv[0] + (begin + (float)i) * probes->step[0], b->wrap_u);
        float v = wrap_coordinate(uv[1] + (begin + (float)i) * probes->step[1], b->wrap_v);
        sum += blend_levels(p, &view, u, v, channel_count, type, is_data);
    }
    bool is_raw = type == IMAGE_U8 && is_data && channel_count >= 3;
    return sum * ((is_raw ? 1.0f / 255.0f : 1.0f) / (float)probes->count);
}

/* The mean of the probes of place_probes(). */
static float4 sample_trilinear(const texture_binding *b, const texture_pyramid *p, const float uv[2],
                               const footprint *f)
{
    probe_row probes = place_probes(p, f);
    if (p->type == IMAGE_U16)
        return sum_probes(b, p, uv, &probes, p->channel_count, IMAGE_U16, true);
    bool is_data = p->color_values == p->alpha_values;
    switch (p->channel_count) {
    case 1:
        return sum_probes(b, p, uv, &probes, 1, IMAGE_U8, false);
    case 2:
        return sum_probes(b, p, uv, &probes, 2, IMAGE_U8, false);
    case 3:
        return is_data ? sum_probes(b, p, uv, &probes, 3, IMAGE_U8, true)
                       : sum_probes(b, p, uv, &probes, 3, IMAGE_U8, false);
    default:
        return is_data ? sum_probes(b, p, uv, &probes, 4, IMAGE_U8, true)
                       : sum_probes(b, p, uv, &probes, 4, IMAGE_U8, false);
    }
}

static float4 sample_minified(const texture_binding *b, const texture_pyramid *p, const float uv[2],
                              const footprint *f)
{
    if (b->mip_filter == SCENE_MIP_LINEAR && b->min_filter == SCENE_FILTER_LINEAR)
        return sample_trilinear(b, p, uv, f);
    float u = wrap_coordinate(uv[0], b->wrap_u);
    float v = wrap_coordinate(uv[1], b->wrap_v);
    if (b->mip_filter == SCENE_MIP_NONE)
        return look_up(b, p, p->first_level, b->min_filter, u, v);
    level_pair levels = get_levels(p, f->longest_2);
    if (b->mip_filter ==
        SCENE_MIP_NEAREST) /* at lod + 1/2 exactly it is the finer one: OpenGL 4.6, equation 8.16 */
        return look_up(b, p, levels.fraction > 0.5f ? levels.second : levels.first, b->min_filter, u, v);
    float4 fine = look_up(b, p, levels.first, b->min_filter, u, v);
    float4 coarse = look_up(b, p, levels.second, b->min_filter, u, v);
    return fine + (coarse - fine) * levels.fraction;
}

/* Whether the magnification filter applies: up to lod 0, or 0.5 where minification is coarser by a nearest filter
 * (OpenGL ES 3.0, section 3.8.11). */
static bool is_magnified(const texture_binding *b, const footprint *f)
{
    bool has_mips = b->mip_filter != SCENE_MIP_NONE;
    if (has_mips && b->mag_filter == SCENE_FILTER_LINEAR && b->min_filter == SCENE_FILTER_NEAREST)
        return f->longest_2 <= 2.0f;
    if (b->mip_filter == SCENE_MIP_LINEAR && b->min_filter == SCENE_FILTER_LINEAR)
        return f->major_2 <= 1.0f;
    return f->longest_2 <= 1.0f;
}

void texture_sample(const texture_set *set, uint32_t index, bool as_color, const float uv[2],
                    const float duv_dx[2], const float duv_dy[2], float out[4])
{
    float4 texel = {1.0f, 1.0f, 1.0f, 1.0f};
    const texture_binding *b = index < set->binding_count ? &set->bindings[index] : NULL;
    const texture_pyramid *p = !b ? NULL : as_color ? b->color : b->data;
    if (p) {
        footprint f;
        if (!get_footprint(p, duv_dx, duv_dy, &f))
            texel = look_up_nearest(p, p->level_count - 1, 0.0f, 0.0f); /* the mean of the image */
        else if (is_magnified(b, &f))
            texel = look_up(b, p, p->first_level, b->mag_filter, wrap_coordinate(uv[0], b->wrap_u),
                            wrap_coordinate(uv[1], b->wrap_v));
        else
            texel = sample_minified(b, p, uv, &f);
    }
    memcpy(out, &texel, sizeof texel);
}
