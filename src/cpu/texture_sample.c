/* texture_sample.c - filtered lookups. See texture.h. */
#include <math.h>
#include <string.h>

#include "cpu/texture_set.h"

typedef float float4 __attribute__((vector_size(16))); /* RGBA */

#define INLINE static inline __attribute__((always_inline))

enum { MAX_PROBES = 16 };

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

/* ---- levels ---- */

/* A lod as two levels and the weight of the second one; within the levels that are there. */
typedef struct level_pair {
    uint32_t first, second;
    float fraction;
} level_pair;

static level_pair get_levels(const texture_pyramid *p, float lod)
{
    float low = (float)p->first_level;
    float high = (float)(p->level_count - 1);
    lod = lod > low ? (lod < high ? lod : high) : low;
    uint32_t first = (uint32_t)lod;
    float fraction = lod - (float)first;
    return (level_pair){.first = first, .second = fraction > 0.0f ? first + 1 : first, .fraction = fraction};
}

/* Where the pixel lands in the texture: an ellipse. Lengths in texels of the full image. */
typedef struct footprint {
    float longest;      /* length of the longer one of the derivatives along x and y, rho of OpenGL */
    float major, minor; /* singular values of the derivatives: the axes' lengths */
    float axis[2];      /* du, dv over the major axis */
} footprint;

/* False: it has no finite size. */
static bool get_footprint(const texture_pyramid *p, const float duv_dx[2], const float duv_dy[2],
                          footprint *f)
{
    float width = (float)p->width;
    float height = (float)p->height;
    float ux = duv_dx[0] * width;
    float vx = duv_dx[1] * height;
    float uy = duv_dy[0] * width;
    float vy = duv_dy[1] * height;
    /* J J^T of the derivatives J = (ux uy; vx vy): its eigenvalues are the squared axes. */
    float a = ux * ux + uy * uy;
    float b = ux * vx + uy * vy;
    float c = vx * vx + vy * vy;
    float mean = 0.5f * (a + c);
    if (!(mean < 1e18f))
        return false;
    float half = 0.5f * (a - c);
    float spread = sqrtf(half * half + b * b);
    float major_2 = mean + spread;
    float minor_2 = mean > spread ? mean - spread : 0.0f;
    float x_2 = ux * ux + vx * vx;
    float y_2 = uy * uy + vy * vy;
    f->longest = sqrtf(x_2 > y_2 ? x_2 : y_2);
    f->major = sqrtf(major_2);
    f->minor = sqrtf(minor_2);
    /* The eigenvector of major_2, by the row of the matrix that is farther from 0. */
    float eu = half > 0.0f ? half + spread : b;
    float ev = half > 0.0f ? b : spread - half;
    float length_2 = eu * eu + ev * ev;
    float scale = length_2 > 0.0f ? f->major / sqrtf(length_2) : 0.0f;
    f->axis[0] = eu * scale / width;
    f->axis[1] = ev * scale / height;
    return true;
}

/* Trilinear probes along the major axis of the footprint (after McCormack et al. 1999, "Feline").
 *
 * As many as the axes' ratio asks for, up to 16, each as wide as the minor axis. Up to a ratio of 1.5 one probe as
 * wide as the major axis does; from there to 2 two of them part while their width shrinks to the minor axis. n probes
 * of width w that are s apart have the second moment (w^2 + (n^2 - 1) s^2) / 12; s is such that it is major^2 / 12,
 * that of the footprint, so that hardly anything jumps where one more probe comes in. */
static float4 sample_trilinear(const texture_binding *b, const texture_pyramid *p, const float uv[2],
                               const footprint *f)
{
    /* Nothing is finer than a texel of the finest level. */
    float finest = (float)(1u << p->first_level);
    float minor = f->minor > finest ? f->minor : finest;
    minor = minor > f->major / MAX_PROBES ? minor : f->major / MAX_PROBES;
    float ratio = f->major > minor ? f->major / minor : 1.0f;
    uint32_t probe_count = 1;
    float width = minor * ratio;
    if (ratio > 2.0f) {
        probe_count = (uint32_t)ceilf(ratio - 0.25f); /* they overlap enough for that */
        width = minor;
    } else if (ratio > 1.5f) {
        probe_count = 2;
        width = minor * (3.0f - ratio);
    }
    probe_count = probe_count < MAX_PROBES ? probe_count : MAX_PROBES;

    level_pair levels = get_levels(p, log2f(width));
    float narrowing = width / f->major;
    float spacing = 0.0f; /* over the major axis */
    if (probe_count > 1)
        spacing = sqrtf((1.0f - narrowing * narrowing) / (float)(probe_count * probe_count - 1));
    float step_u = f->axis[0] * spacing;
    float step_v = f->axis[1] * spacing;
    float u = uv[0] - 0.5f * (float)(probe_count - 1) * step_u;
    float v = uv[1] - 0.5f * (float)(probe_count - 1) * step_v;
    float4 sum = {0.0f, 0.0f, 0.0f, 0.0f};
    for (uint32_t i = 0; i < probe_count; i++) {
        float wrapped_u = wrap_coordinate(u + (float)i * step_u, b->wrap_u);
        float wrapped_v = wrap_coordinate(v + (float)i * step_v, b->wrap_v);
        float4 fine = look_up_linear(b, p, levels.first, wrapped_u, wrapped_v);
        if (levels.second != levels.first) {
            float4 coarse = look_up_linear(b, p, levels.second, wrapped_u, wrapped_v);
            fine += (coarse - fine) * levels.fraction;
        }
        sum += fine;
    }
    return sum * (1.0f / (float)probe_count);
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
    float lod = log2f(f->longest);
    if (b->mip_filter == SCENE_MIP_NEAREST) {
        level_pair levels = get_levels(p, ceilf(lod + 0.5f) - 1.0f); /* OpenGL 4.6, equation 8.16 */
        return look_up(b, p, levels.first, b->min_filter, u, v);
    }
    level_pair levels = get_levels(p, lod);
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
        return f->longest <= 1.41421356f;
    if (b->mip_filter == SCENE_MIP_LINEAR && b->min_filter == SCENE_FILTER_LINEAR)
        return f->major <= 1.0f;
    return f->longest <= 1.0f;
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
