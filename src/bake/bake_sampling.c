/* bake_sampling.c - see bake_sampling.h. */
#include "bake/bake_sampling.h"

#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "base/parallel.h"
#include "base/result.h"

static const double pi = 3.14159265358979323846;

enum { LANES = 8 };
typedef int32_t int8 __attribute__((vector_size(32), may_alias));

/* Samples that are looked up in the same level, LANES at a time; the last ones may have weight 0. */
typedef struct sample_group {
    uint32_t first, block_count; /* blocks of LANES */
} sample_group;

typedef struct sample_set {
    uint32_t count;
    float8 *x, *y, *z; /* directions: z along R */
    float8 *weight;
    sample_group groups[BAKE_PYRAMID_LEVELS];
} sample_set;

typedef struct sampling {
    const bake_pyramid *pyramid;
    sample_set set;
    bake_watch *watch;
    cube *out;
} sampling;

/* The lod at which texels have the solid angle of a sample of density pdf. */
static double lod_of(const bake_pyramid *p, uint32_t count, double pdf)
{
    double solid_angle = BAKE_OVERLAP / (count * fmax(pdf, 1e-6));
    double size = p->levels[0].size;
    double lod = 0.5 * log2(solid_angle * 6.0 * size * size / (4.0 * pi));
    double last = p->level_count - 1;
    return lod < 0.0 ? 0.0 : lod < last ? lod : last;
}

/* Number of samples in the ring that begins at angle inner, where done of count samples lie inside: as many
 * as make cells as wide as high. */
static uint32_t ring_count(const bake_lobe_shares *shares, uint32_t count, uint32_t done, double inner)
{
    uint32_t few = 0;
    uint32_t many = count - done;
    while (many - few > 1) {
        uint32_t n = few + (many - few) / 2;
        double outer = 2.0 * asin(sqrt(bake_lobe_find(shares, (double)(done + n) / count)));
        if (n * (outer - inner) < 2.0 * pi * sin(0.5 * (inner + outer)))
            few = n;
        else
            many = n;
    }
    return many;
}

/* Directions at equal angles around R, and the lod at which they are looked up. */
typedef struct ring {
    uint32_t count;
    double lod;
    double sine, cosine, turn;
} ring;

static uint32_t make_rings(const bake_pyramid *p, const bake_lobe_shares *shares, uint32_t count, ring *rings)
{
    uint32_t ring_number = 0;
    double inner = 0.0;
    for (uint32_t done = 0; done < count; ring_number++) {
        uint32_t n = ring_count(shares, count, done, inner);
        double s2 = bake_lobe_find(shares, (done + 0.5 * n) / count);
        rings[ring_number] = (ring){.count = n,
                                    .lod = lod_of(p, count, bake_lobe_pdf(shares, s2)),
                                    .sine = 2.0 * sqrt(s2 * (1.0 - s2)),
                                    .cosine = 1.0 - 2.0 * s2,
                                    .turn = 2.399963229728653 * ring_number}; /* the golden angle */
        done += n;
        inner = 2.0 * asin(sqrt(bake_lobe_find(shares, (double)done / count)));
    }
    return ring_number;
}

/* Weight of a level in a lookup at a lod: 1 near the level, then linear over half a level. */
static double share_of(double lod, uint32_t level)
{
    double distance = fabs(lod - level);
    return distance <= 0.25 ? 1.0 : distance < 0.75 ? 1.5 - 2.0 * distance : 0.0;
}

/* Sorts samples by level. Some are in two levels, so that their blur changes gradually from ring to ring; a
 * step would weight one ring too much and the next too little. */
static void place_samples(const bake_pyramid *p, const ring *rings, uint32_t ring_total, sample_set *set)
{
    float *x = (float *)set->x;
    float *y = (float *)set->y;
    float *z = (float *)set->z;
    float *weight = (float *)set->weight;
    size_t at = 0;
    for (uint32_t level = 0; level < p->level_count; level++) {
        size_t first = at;
        for (uint32_t i = 0; i < ring_total; i++) {
            double share = share_of(rings[i].lod, level);
            for (uint32_t k = 0; share > 0.0 && k < rings[i].count; k++) {
                double phi = rings[i].turn + 2.0 * pi * k / rings[i].count;
                x[at] = (float)(rings[i].sine * cos(phi));
                y[at] = (float)(rings[i].sine * sin(phi));
                z[at] = (float)rings[i].cosine;
                weight[at++] = (float)share;
            }
        }
        for (; at % LANES; at++) {
            x[at] = y[at] = weight[at] = 0.0f;
            z[at] = 1.0f;
        }
        set->groups[level] = (sample_group){(uint32_t)(first / LANES), (uint32_t)((at - first) / LANES)};
    }
}

static facet_result create_set(const bake_pyramid *p, const bake_lobe *lobe, uint32_t count,
                               const facet_allocator *allocator, sample_set *set, facet_error *error)
{
    size_t blocks = 2 * ((size_t)count / LANES + 1) + BAKE_PYRAMID_LEVELS;
    bake_lobe_shares *shares = mem_alloc(allocator, 1, sizeof *shares);
    ring *rings = mem_alloc(allocator, count, sizeof *rings);
    *set = (sample_set){.count = count, .x = mem_alloc(allocator, blocks, 4 * sizeof *set->x)};
    facet_result result = FACET_OK;
    if (shares && rings && set->x) {
        set->y = set->x + blocks;
        set->z = set->y + blocks;
        set->weight = set->z + blocks;
        bake_lobe_share_init(lobe, shares);
        place_samples(p, rings, make_rings(p, shares, count, rings), set);
    } else {
        result = fail_memory(error, "samples", blocks * 4 * sizeof *set->x);
    }
    mem_free(shares);
    mem_free(rings);
    return result;
}

/* ---- looking up ---- */

static inline __attribute__((always_inline)) void choose(const int8 *mask, const float8 *a, const float8 *b,
                                                         float8 *out)
{
    *out = (float8)(((int8)*a & *mask) | ((int8)*b & ~*mask));
}

/* Positions of LANES directions in a level: indices of texels and bilinear weights towards the next ones
 * right and below. */
typedef struct sample_places {
    int8 texel;
    float8 right, down;
} sample_places;

/* 4 / pi atan(x) for x in [-1, 1], within 1.3e-5. Abramowitz and Stegun 1964, equation 4.4.47. */
static inline __attribute__((always_inline)) void equal_angles(const float8 *x, float8 *out)
{
    float8 x2 = *x * *x;
    *out = *x * (1.2730689f + x2 * (-0.4205504f + x2 * (0.2293626f + x2 * (-0.1083947f + x2 * 0.0265281f))));
}

/* cube_locate() and cube_fetch() of cube.h, without branches. */
static inline __attribute__((always_inline)) void locate(const float8 *x, const float8 *y, const float8 *z,
                                                         int32_t size, sample_places *out)
{
    const int8 sign_bit = (int8){0} + (int32_t)0x80000000;
    int8 sx = (int8)*x & sign_bit;
    int8 sy = (int8)*y & sign_bit;
    int8 sz = (int8)*z & sign_bit;
    float8 ax = (float8)((int8)*x & ~sign_bit);
    float8 ay = (float8)((int8)*y & ~sign_bit);
    float8 az = (float8)((int8)*z & ~sign_bit);
    int8 is_x = (ax >= ay) & (ax >= az);
    int8 is_y = ~is_x & (ay >= az);
    /* +X (-z, -y)  -X (z, -y)  +Y (x, z)  -Y (x, -z)  +Z (x, -y)  -Z (-x, -y) */
    float8 s, t, most;
    float8 z_turned = (float8)((int8)*z ^ sx ^ sign_bit);
    float8 x_turned = (float8)((int8)*x ^ (sz & ~is_y));
    float8 y_turned = (float8)((int8)*y ^ sign_bit);
    float8 z_up = (float8)((int8)*z ^ sy);
    choose(&is_x, &z_turned, &x_turned, &s);
    choose(&is_y, &z_up, &y_turned, &t);
    choose(&is_y, &ay, &az, &most);
    choose(&is_x, &ax, &most, &most);
    int8 negative = (is_x & sx) | (is_y & sy) | (~is_x & ~is_y & sz);
    int8 face =
        (~is_x & (2 + (2 & ~is_y))) + (int8)((__attribute__((vector_size(32))) uint32_t)negative >> 31);
    float half = 0.5f * (float)size;
    float8 q = 1.0f / most;
    float8 u, v;
    s *= q;
    t *= q;
    equal_angles(&s, &u);
    equal_angles(&t, &v);
    u = u * half + (half + 0.5f);
    v = v * half + (half + 0.5f);
    int8 x0 = __builtin_convertvector(u, int8);
    int8 y0 = __builtin_convertvector(v, int8);
    out->right = u - __builtin_convertvector(x0, float8);
    out->down = v - __builtin_convertvector(y0, float8);
    int32_t stride = size + 2;
    out->texel = (face * stride + y0) * stride + x0;
}

/* Sum over the samples of a level, rotated to the given axes. */
static inline __attribute__((always_inline)) void
add_group(const sampling *job, const cube *level, const sample_group *g, float axes[3][3], rgbx *sum)
{
    size_t stride = (size_t)level->size + 2;
    float8 part = {0}; /* sums of the left and of the right texels */
    for (uint32_t i = 0; i < g->block_count; i++) {
        float8 x = job->set.x[g->first + i];
        float8 y = job->set.y[g->first + i];
        float8 z = job->set.z[g->first + i];
        float8 dx = x * axes[0][0] + y * axes[1][0] + z * axes[2][0];
        float8 dy = x * axes[0][1] + y * axes[1][1] + z * axes[2][1];
        float8 dz = x * axes[0][2] + y * axes[1][2] + z * axes[2][2];
        sample_places p;
        locate(&dx, &dy, &dz, (int32_t)level->size, &p);
        float8 weight = job->set.weight[g->first + i];
        float8 weighted = p.right * weight;
        float8 rest = weight - weighted;
        int32_t texel[LANES];
        float right[LANES], left[LANES], down[LANES];
        memcpy(texel, &p.texel, sizeof texel);
        memcpy(right, &weighted, sizeof right);
        memcpy(left, &rest, sizeof left);
        memcpy(down, &p.down, sizeof down);
        for (uint32_t k = 0; k < LANES; k++) {
            float8 above, below; /* two texels each */
            memcpy(&above, level->texels + texel[k], sizeof above);
            memcpy(&below, level->texels + texel[k] + stride, sizeof below);
            float l = left[k];
            float r = right[k];
            part += (above + (below - above) * down[k]) * (float8){l, l, l, l, r, r, r, r};
        }
    }
    *sum += (rgbx){part[0] + part[4], part[1] + part[5], part[2] + part[6], part[3] + part[7]};
}

DISPATCH_AVX2 static void sample_rows(void *context, size_t begin, size_t end)
{
    const sampling *job = context;
    uint32_t size = job->out->size;
    for (size_t row = begin; row < end; row++) {
        uint32_t face = (uint32_t)(row / size);
        uint32_t y = (uint32_t)(row % size);
        for (uint32_t x = 0; x < size && !bake_watch_is_cancelled(job->watch); x++) {
            double d[3];
            cube_direction(face, (2.0 * x + 1.0) / size - 1.0, (2.0 * y + 1.0) / size - 1.0, d);
            double length = sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
            double across = sqrt(d[0] * d[0] + d[2] * d[2]);
            /* east, south and R; X for east at a pole */
            double e[2] = {across > 1e-9 ? -d[2] / across : 1.0, across > 1e-9 ? d[0] / across : 0.0};
            float axes[3][3] = {{(float)e[0], 0.0f, (float)e[1]},
                                {(float)(-e[1] * d[1] / length),
                                 (float)((e[1] * d[0] - e[0] * d[2]) / length),
                                 (float)(e[0] * d[1] / length)},
                                {(float)(d[0] / length), (float)(d[1] / length), (float)(d[2] / length)}};
            rgbx sum = {0};
            for (uint32_t level = 0; level < job->pyramid->level_count; level++)
                add_group(job, &job->pyramid->levels[level], &job->set.groups[level], axes, &sum);
            *cube_texel(job->out, face, (int)x, (int)y) = sum * (1.0f / sum[3]);
        }
        bake_watch_add(job->watch, (double)size * job->set.count);
    }
}

facet_result bake_sample(const bake_pyramid *p, const bake_lobe *lobe, uint32_t sample_count,
                         const facet_allocator *allocator, uint32_t thread_count, bake_watch *watch,
                         cube *out, facet_error *error)
{
    sampling job = {.pyramid = p, .watch = watch, .out = out};
    facet_result result = create_set(p, lobe, sample_count, allocator, &job.set, error);
    if (result == FACET_OK) {
        parallel_for(thread_count, 6 * (size_t)out->size, 1, sample_rows, &job);
        cube_fill_borders(out);
    }
    mem_free(job.set.x);
    return result;
}
