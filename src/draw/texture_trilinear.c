/* texture_trilinear.c - see texture_trilinear.h. Where probes read is worked out once for all textures; what they
 * read there is blended on both levels at the same time, in eight lanes. */
#include "base/simd.h"

#include "draw/texture_texel.h"
#include "draw/texture_trilinear.h"

typedef uint32_t uint8 __attribute__((vector_size(32)));
typedef int32_t int8 __attribute__((vector_size(32)));

/* ---- where ---- */

/* Texel numbers of one probe, of the finer and the coarser level, and the weights of the second texels. */
typedef struct probe_taps {
    int4 above;      /* left, right of the finer level, left, right of the coarser one */
    int4 below;      /* the row under it */
    float4 fraction; /* u, v of the finer level, u, v of the coarser one */
} probe_taps;

/* What all probes have in common: lanes 0 and 1 are u and v of the finer level, 2 and 3 of the coarser one. */
typedef struct level_pair_view {
    float4 size;
    int4 int_size;
    int4 wrap_step; /* from behind an edge to where it goes on: the size where the axis repeats, else 1 */
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

/* The taps at (u, v) in [0, 1]: what get_taps() in texture_sample.c does, for four coordinates. */
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

/* ---- what ---- */

/* Two texels of three or four 8-bit channels, one of each level.
 *
 * Colors are linear. Data stays where it is in the four bytes, so channel c comes out as 256^c times its code, which
 * a float has room for; data_scale() undoes that after blending, to the same bits. */
INLINE void fetch_two(const texture_pyramid *p, const unsigned char *a, const unsigned char *b,
                      uint32_t channel_count, bool is_data, float8 *out)
{
    if (is_data) {
        uint32_t s;
        uint32_t t;
        memcpy(&s, a, sizeof s); /* of three channels a byte more: MEM_TAIL allows it */
        memcpy(&t, b, sizeof t);
        uint8 texels = {s, s, s, s, t, t, t, t};
        if (channel_count == 3) {
            texels &= (uint8){0xff, 0xff00, 0xff0000, 0, 0xff, 0xff00, 0xff0000, 0};
            texels |= (uint8){0, 0, 0, 255, 0, 0, 0, 255};
            *out = __builtin_convertvector((int8)texels, float8);
        } else { /* the fourth one would be a sign: it is taken down by half its range and lifted again */
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

/* From what fetch_two() makes of data to [0, 255]. */
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

void texture_trilinear(const texture_binding *binding, const texture_pyramid *const *pyramids, uint32_t count,
                       const float uv[2], const Footprint *f, float (*out)[4])
{
    sample_all(binding, pyramids, count, uv, f, out);
}
