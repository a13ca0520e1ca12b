/* texture_sample.c - filtered lookups; see texture.h. Trilinear lookups with anisotropic probes, the
 * common case, sample several textures together, on both levels at the same time, in eight lanes; the
 * rarer filters sample one texture at a time. */
#include "draw/texture_set.h"

#include <math.h>
#include <string.h>

#include "base/simd.h"
#include "draw/texture_pyramid.h"
#include "scene/scene.h"

#include "shade/shade.h"

/* ---- levels ---- */

#define INLINE static inline __attribute__((always_inline))

/* Two levels and the weight of the second one. */
typedef struct level_pair {
    uint32_t first, second;
    float fraction;
} level_pair;

/* The lod log2(sqrt(width_2)) as existing levels; width_2 > 0 and normal.
 *
 * The level numbers depend on the exponent of width_2 alone, so that fetching need not wait for the
 * logarithm, which is accurate to 6e-5: far below what is visible. With the mantissa 1 + t it is t and a
 * correction that vanishes at both ends, so that octaves join. */
INLINE level_pair get_levels(const texture_pyramid *p, float width_2)
{
    uint32_t bits;
    memcpy(&bits, &width_2, sizeof bits);
    int32_t exponent = (int32_t)(bits >> 23) - 127;
    int32_t first = exponent >> 1; /* rounded down */
    bits = (bits & 0x007fffff) | 0x3f800000;
    float t;
    memcpy(&t, &bits, sizeof t);
    t -= 1.0f;
    float mantissa_log2 = t + t * (1.0f - t) * (0.438726f + t * (-0.239058f + t * 0.082131f));
    float fraction = 0.5f * ((float)(exponent & 1) + mantissa_log2);
    if (first < (int32_t)p->first_level)
        return (level_pair){.first = p->first_level, .second = p->first_level};
    if (first + 1 >= (int32_t)p->level_count)
        return (level_pair){.first = p->level_count - 1, .second = p->level_count - 1};
    return (level_pair){.first = (uint32_t)first, .second = (uint32_t)first + 1, .fraction = fraction};
}

/* The pixel's footprint in the image. False: it has no finite size. */
INLINE bool get_footprint(const texture_pyramid *p, const float duv_dx[2], const float duv_dy[2],
                          Footprint *f)
{
    *f = footprint_from_derivatives(vec2((float)p->width, (float)p->height), vec2(duv_dx[0], duv_dx[1]),
                                    vec2(duv_dy[0], duv_dy[1]));
    return footprint_is_finite(*f);
}

INLINE ProbeRow place_probes(const texture_pyramid *p, const Footprint *f)
{
    return footprint_probes(*f, (float)(1u << p->first_level), vec2(p->texel_size[0], p->texel_size[1]));
}

typedef float float4 __attribute__((vector_size(16))); /* RGBA; or u and v of two levels */
typedef int32_t int4 __attribute__((vector_size(16)));

/* ---- coordinates ---- */

/* Maps a texture coordinate u of any value, including NaN and infinity, to [0, 1] of the image by the wrap
 * mode. Beyond 2^23 floats have no fraction. */
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

/* ---- trilinear: positions of the probes ---- */

typedef uint32_t uint8 __attribute__((vector_size(32)));
typedef int32_t int8 __attribute__((vector_size(32)));

/* Texel indices of one probe, of the finer and the coarser level, and the weights of the second texels. */
typedef struct probe_taps {
    int4 above;      /* left, right of the finer level, left, right of the coarser one */
    int4 below;      /* the row below it */
    float4 fraction; /* u, v of the finer level, u, v of the coarser one */
} probe_taps;

/* What all probes have in common: lanes 0 and 1 are u and v of the finer level, 2 and 3 of the coarser one. */
typedef struct level_pair_view {
    float4 size;
    int4 int_size;
    int4 wrap_step; /* from beyond an edge to where it continues: the size where the axis repeats, else 1 */
    int4 stride;    /* width of the level */
} level_pair_view;

INLINE level_pair_view view_levels(const texture_binding *b, const texture_pyramid *p, level_pair levels)
{
    const texture_level *first = &p->levels[levels.first];
    const texture_level *second = &p->levels[levels.second];
    int32_t w0 = (int32_t)first->width;
    int32_t w1 = (int32_t)second->width;
    level_pair_view view = {.size = {first->size[0], first->size[1], second->size[0], second->size[1]},
                            .int_size = {w0, (int32_t)first->height, w1, (int32_t)second->height},
                            .stride = {w0, w0, w1, w1}};
    int32_t repeat_u = b->wrap_u == SCENE_WRAP_REPEAT ? -1 : 0;
    int32_t repeat_v = b->wrap_v == SCENE_WRAP_REPEAT ? -1 : 0;
    int4 repeats = {repeat_u, repeat_v, repeat_u, repeat_v};
    view.wrap_step = (repeats & view.int_size) | (~repeats & 1);
    return view;
}

/* The taps at (u, v) in [0, 1]: as get_taps(), for four coordinates. */
INLINE probe_taps place_taps(const level_pair_view *view, float u, float v)
{
    float4 x = (float4){u, v, u, v} * view->size - 0.5f;
    int4 first = __builtin_convertvector(x + 1.0f, int4) - 1;
    probe_taps taps = {.fraction = x - __builtin_convertvector(first, float4)};
    int4 second = first + 1;
    first += (first < 0) & view->wrap_step;
    second -= (second >= view->int_size) & view->wrap_step;
    int4 columns = __builtin_shufflevector(first, second, 0, 4, 2, 6);
    int4 rows = __builtin_shufflevector(first, second, 1, 5, 3, 7) * view->stride;
    taps.above = __builtin_shufflevector(rows, rows, 0, 0, 2, 2) + columns;
    taps.below = __builtin_shufflevector(rows, rows, 1, 1, 3, 3) + columns;
    return taps;
}

/* ---- trilinear: texels ---- */

/* Two texels of three or four 8-bit channels, one of each level.
 *
 * Colors are linear. Data stays in its place in the four bytes, so channel c is 256^c times its code,
 * which is exact in a float; data_scale() undoes that after blending, with identical bits. */
INLINE void fetch_two(const texture_pyramid *p, const unsigned char *a, const unsigned char *b,
                      uint32_t channel_count, bool is_data, float8 *out)
{
    if (is_data) {
        uint32_t s;
        uint32_t t;
        memcpy(&s, a, sizeof s); /* for three channels one byte more: MEM_TAIL allows it */
        memcpy(&t, b, sizeof t);
        uint8 texels = {s, s, s, s, t, t, t, t};
        if (channel_count == 3) {
            texels &= (uint8){0xff, 0xff00, 0xff0000, 0, 0xff, 0xff00, 0xff0000, 0};
            texels |= (uint8){0, 0, 0, 255, 0, 0, 0, 255};
            *out = __builtin_convertvector((int8)texels, float8);
            /* the top bit of the fourth would be a sign: half of its range is subtracted and added again */
        } else {
            texels &= (uint8){0xff, 0xff00, 0xff0000, 0xff000000, 0xff, 0xff00, 0xff0000, 0xff000000};
            texels ^= (uint8){0, 0, 0, 0x80000000, 0, 0, 0, 0x80000000};
            *out =
                __builtin_convertvector((int8)texels, float8) + (float8){0, 0, 0, 0x1p31f, 0, 0, 0, 0x1p31f};
        }
        return;
    }
    const float *color = p->color_values;
    const float *alpha = p->alpha_values;
    uint32_t opacity_a = channel_count == 3 ? 255 : a[3];
    uint32_t opacity_b = channel_count == 3 ? 255 : b[3];
    *out = (float8){color[a[0]], color[a[1]], color[a[2]], alpha[opacity_a],
                    color[b[0]], color[b[1]], color[b[2]], alpha[opacity_b]};
}

/* From data as fetch_two() returns it to [0, 255]. */
INLINE float4 data_scale(uint32_t channel_count)
{
    return (float4){1.0f, 0x1p-8f, 0x1p-16f, channel_count == 3 ? 1.0f : 0x1p-24f};
}

/* One probe in one texture; format and fraction (of the coarser level) as in sum_probes(). */
INLINE float4 blend_8(const texture_pyramid *p, const unsigned char *const texels[2], const probe_taps *t,
                      float fraction, uint32_t channel_count, bool is_data)
{
    float8 a;
    float8 b;
    float8 c;
    float8 d;
    size_t n = channel_count;
    fetch_two(p, texels[0] + (size_t)t->above[0] * n, texels[1] + (size_t)t->above[2] * n, channel_count,
              is_data, &a);
    fetch_two(p, texels[0] + (size_t)t->above[1] * n, texels[1] + (size_t)t->above[3] * n, channel_count,
              is_data, &b);
    fetch_two(p, texels[0] + (size_t)t->below[0] * n, texels[1] + (size_t)t->below[2] * n, channel_count,
              is_data, &c);
    fetch_two(p, texels[0] + (size_t)t->below[1] * n, texels[1] + (size_t)t->below[3] * n, channel_count,
              is_data, &d);
    float4 f = t->fraction;
    float8 u = __builtin_shufflevector(f, f, 0, 0, 0, 0, 2, 2, 2, 2);
    float8 v = __builtin_shufflevector(f, f, 1, 1, 1, 1, 3, 3, 3, 3);
    float8 above = a + (b - a) * u;
    float8 below = c + (d - c) * u;
    float8 levels = above + (below - above) * v;
    float4 fine = __builtin_shufflevector(levels, levels, 0, 1, 2, 3);
    float4 coarse = __builtin_shufflevector(levels, levels, 4, 5, 6, 7);
    return fine + (coarse - fine) * fraction;
}

/* The same for one and two channels, and for 16 bits. */
INLINE float4 blend_any(const texture_pyramid *p, const unsigned char *const texels[2], const probe_taps *t,
                        float fraction, uint32_t channel_count, image_type type)
{
    float4 level[2];
    for (int k = 0; k < 2; k++) {
        float4 a = fetch(p, texels[k], (size_t)t->above[2 * k], channel_count, type);
        float4 b = fetch(p, texels[k], (size_t)t->above[2 * k + 1], channel_count, type);
        float4 c = fetch(p, texels[k], (size_t)t->below[2 * k], channel_count, type);
        float4 d = fetch(p, texels[k], (size_t)t->below[2 * k + 1], channel_count, type);
        float4 above = a + (b - a) * t->fraction[2 * k];
        float4 below = c + (d - c) * t->fraction[2 * k];
        level[k] = above + (below - above) * t->fraction[2 * k + 1];
    }
    return level[0] + (level[1] - level[0]) * fraction;
}

/* All probes in one texture, for a format that is a constant at each call. */
INLINE float4 sum_probes(const texture_pyramid *p, level_pair levels, const probe_taps *taps, uint32_t count,
                         uint32_t channel_count, image_type type, bool is_data)
{
    const unsigned char *const texels[2] = {p->levels[levels.first].texels, p->levels[levels.second].texels};
    bool is_8 = type == IMAGE_U8 && channel_count >= 3;
    float4 sum = {0.0f, 0.0f, 0.0f, 0.0f};
    for (uint32_t i = 0; i < count; i++)
        sum += is_8 ? blend_8(p, texels, &taps[i], levels.fraction, channel_count, is_data)
                    : blend_any(p, texels, &taps[i], levels.fraction, channel_count, type);
    if (is_8 && is_data)
        return sum * data_scale(channel_count) * (1.0f / 255.0f / (float)count);
    return sum * (1.0f / (float)count);
}

INLINE float4 sample(const texture_pyramid *p, level_pair levels, const probe_taps *taps, uint32_t count)
{
    if (p->type == IMAGE_U16)
        return sum_probes(p, levels, taps, count, p->channel_count, IMAGE_U16, true);
    bool is_data = p->color_values == p->alpha_values;
    switch (p->channel_count) {
    case 1:
        return sum_probes(p, levels, taps, count, 1, IMAGE_U8, false);
    case 2:
        return sum_probes(p, levels, taps, count, 2, IMAGE_U8, false);
    case 3:
        return is_data ? sum_probes(p, levels, taps, count, 3, IMAGE_U8, true)
                       : sum_probes(p, levels, taps, count, 3, IMAGE_U8, false);
    default:
        return is_data ? sum_probes(p, levels, taps, count, 4, IMAGE_U8, true)
                       : sum_probes(p, levels, taps, count, 4, IMAGE_U8, false);
    }
}

DISPATCH_AVX2 static void sample_all(const texture_binding *b, const texture_pyramid *const *pyramids,
                                     uint32_t count, const float uv[2], const Footprint *f, float (*out)[4])
{
    ProbeRow probes = place_probes(pyramids[0], f);
    level_pair levels = get_levels(pyramids[0], probes.width2);
    level_pair_view view = view_levels(b, pyramids[0], levels);
    probe_taps taps[FOOTPRINT_MAX_PROBES];
    uint32_t probe_count = (uint32_t)probes.count;
    float begin = -0.5f * (float)(probe_count - 1);
    for (uint32_t i = 0; i < probe_count; i++)
        taps[i] = place_taps(&view, wrap_coordinate(uv[0] + (begin + (float)i) * probes.step_u, b->wrap_u),
                             wrap_coordinate(uv[1] + (begin + (float)i) * probes.step_v, b->wrap_v));
    for (uint32_t k = 0; k < count; k++) {
        float4 texel = sample(pyramids[k], levels, taps, probe_count);
        memcpy(out[k], &texel, sizeof texel);
    }
}

static void trilinear(const texture_binding *binding, const texture_pyramid *const *pyramids, uint32_t count,
                      const float uv[2], const Footprint *f, float (*out)[4])
{
    sample_all(binding, pyramids, count, uv, f, out);
}

/* ---- one texture, any filter ---- */

/* Whether two textures are read at the same texels with the same weights. */
static inline bool is_alike(const texture_binding *a, const texture_pyramid *p, const texture_binding *b,
                            const texture_pyramid *q)
{
    return a->wrap_u == b->wrap_u && a->wrap_v == b->wrap_v && a->min_filter == b->min_filter &&
           a->mip_filter == b->mip_filter && p->width == q->width && p->height == q->height &&
           p->first_level == q->first_level;
}

/* The two adjacent texels whose centers enclose a coordinate in [0, 1], and the weight of the second.
 * Clamped and mirrored edges repeat their last texel. */
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
INLINE float4 texel_linear(const texture_binding *b, const texture_pyramid *p, uint32_t level_number, float u,
                           float v)
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

static float4 texel_nearest(const texture_pyramid *p, uint32_t level_number, float u, float v)
{
    const texture_level *level = &p->levels[level_number];
    uint32_t x = (uint32_t)(u * (float)level->width);
    uint32_t y = (uint32_t)(v * (float)level->height);
    x = x < level->width ? x : level->width - 1;
    y = y < level->height ? y : level->height - 1;
    return fetch(p, level->texels, (size_t)y * level->width + x, p->channel_count, p->type);
}

static float4 texel_at_level(const texture_binding *b, const texture_pyramid *p, uint32_t level,
                             scene_filter filter, float u, float v)
{
    return filter == SCENE_FILTER_NEAREST ? texel_nearest(p, level, u, v) : texel_linear(b, p, level, u, v);
}

static float4 sample_minified(const texture_binding *b, const texture_pyramid *p, const float uv[2],
                              const Footprint *f)
{
    float u = wrap_coordinate(uv[0], b->wrap_u);
    float v = wrap_coordinate(uv[1], b->wrap_v);
    if (b->mip_filter == SCENE_MIP_NONE)
        return texel_at_level(b, p, p->first_level, b->min_filter, u, v);
    level_pair levels = get_levels(p, f->longest2);
    if (b->mip_filter ==
        SCENE_MIP_NEAREST) /* at lod + 1/2 exactly the finer one: OpenGL 4.6, equation 8.16 */
        return texel_at_level(b, p, levels.fraction > 0.5f ? levels.second : levels.first, b->min_filter, u,
                              v);
    float4 fine = texel_at_level(b, p, levels.first, b->min_filter, u, v);
    float4 coarse = texel_at_level(b, p, levels.second, b->min_filter, u, v);
    return fine + (coarse - fine) * levels.fraction;
}

static bool is_trilinear(const texture_binding *b)
{
    return b->mip_filter == SCENE_MIP_LINEAR && b->min_filter == SCENE_FILTER_LINEAR;
}

/* Whether the magnification filter applies: up to lod 0, or 0.5 where minification with a nearest filter is
 * coarser (OpenGL ES 3.0, section 3.8.11). */
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

/* Samples requests[first] and all later ones that are alike; returns them as bits. */
static uint32_t sample_alike(const texture_set *set, texture_request *requests, uint32_t first,
                             uint32_t count, const float uv[2], const Footprint *f)
{
    const texture_binding *b = &set->bindings[requests[first].texture];
    const texture_pyramid *pyramids[TEXTURE_GROUP] = {find_pyramid(set, &requests[first])};
    uint32_t indices[TEXTURE_GROUP] = {first};
    uint32_t alike = 1;
    for (uint32_t i = first + 1; i < count; i++) {
        const texture_pyramid *p = find_pyramid(set, &requests[i]);
        if (!p || !is_alike(b, pyramids[0], &set->bindings[requests[i].texture], p))
            continue;
        pyramids[alike] = p;
        indices[alike++] = i;
    }
    float texels[TEXTURE_GROUP][4];
    trilinear(b, pyramids, alike, uv, f, texels);
    uint32_t bits = 0;
    for (uint32_t k = 0; k < alike; k++) {
        memcpy(requests[indices[k]].texel, texels[k], sizeof texels[k]);
        bits |= 1u << indices[k];
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
                texel = texel_nearest(p, p->level_count - 1, 0.0f, 0.0f); /* the mean of the image */
            } else if (is_magnified(b, &f)) {
                texel = texel_at_level(b, p, p->first_level, b->mag_filter, wrap_coordinate(uv[0], b->wrap_u),
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
