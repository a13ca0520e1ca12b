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

/* Samples that are looked up in the same level, LANES at a time; the last ones repeat a sample with weight 0. */
typedef struct sample_group {
    uint32_t first, block_count, count; /* blocks of LANES; samples */
} sample_group;

typedef struct sample_set {
    uint32_t count;
    float8 *x, *y, *z; /* directions: z along R */
    sample_group groups[BAKE_PYRAMID_LEVELS];
} sample_set;

typedef struct sampling {
    const bake_pyramid *pyramid;
    sample_set set;
    bake_watch *watch;
    cube *out;
} sampling;

/* The level whose texels have about the solid angle that a sample of density pdf stands for. */
static uint32_t level_of(const bake_pyramid *p, uint32_t count, double pdf)
{
    double solid_angle = 4.0 / (count * fmax(pdf, 1e-6));
    double size = p->levels[0].size;
    double lod = 0.5 * log2(solid_angle * 6.0 * size * size / (4.0 * pi)) + 0.5;
    double last = p->level_count - 1;
    return (uint32_t)(lod < 0.0 ? 0.0 : lod < last ? lod : last);
}

static void make_directions(const bake_pyramid *p, const float *s2, const float *pdf, sample_set *set)
{
    uint32_t block = 0;
    for (uint32_t level = 0; level < p->level_count; level++) {
        sample_group *g = &set->groups[level];
        *g = (sample_group){.first = block};
        for (uint32_t i = 0; i < set->count; i++) {
            if (level_of(p, set->count, (double)pdf[i]) != level)
                continue;
            double sine = 2.0 * sqrt((double)s2[i] * (1.0 - (double)s2[i]));
            double phi = 2.399963229728653 * i; /* the golden angle */
            uint32_t to = g->count++;
            set->x[block + to / LANES][to % LANES] = (float)(sine * cos(phi));
            set->y[block + to / LANES][to % LANES] = (float)(sine * sin(phi));
            set->z[block + to / LANES][to % LANES] = (float)(1.0 - 2.0 * (double)s2[i]);
        }
        for (uint32_t to = g->count; to % LANES; to++) {
            set->x[block + to / LANES][to % LANES] = set->y[block + to / LANES][to % LANES] = 0.0f;
            set->z[block + to / LANES][to % LANES] = 1.0f;
        }
        g->block_count = (g->count + LANES - 1) / LANES;
        block += g->block_count;
    }
}

static facet_result create_set(const bake_pyramid *p, const bake_lobe *lobe, uint32_t count,
                               const facet_allocator *allocator, sample_set *set, facet_error *error)
{
    size_t blocks = (size_t)count / LANES + 1 + BAKE_PYRAMID_LEVELS;
    float *s2 = mem_alloc(allocator, count, 2 * sizeof *s2);
    *set = (sample_set){.count = count, .x = mem_alloc(allocator, blocks, 3 * sizeof *set->x)};
    facet_result result = FACET_OK;
    if (s2 && set->x) {
        set->y = set->x + blocks;
        set->z = set->y + blocks;
        bake_lobe_sample(lobe, count, s2, s2 + count);
        make_directions(p, s2, s2 + count, set);
    } else {
        result = fail_memory(error, "samples", blocks * 3 * sizeof *set->x);
    }
    mem_free(s2);
    return result;
}

/* ---- looking up ---- */

static inline __attribute__((always_inline)) void choose(const int8 *mask, const float8 *a, const float8 *b,
                                                         float8 *out)
{
    *out = (float8)(((int8)*a & *mask) | ((int8)*b & ~*mask));
}

/* Where LANES directions are in a level: numbers of texels, and how far towards the next right and below. */
typedef struct sample_places {
    int8 texel;
    float8 right, down;
} sample_places;

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
    float8 scale = half / most;
    float8 u = s * scale + (half + 0.5f);
    float8 v = t * scale + (half + 0.5f);
    int8 x0 = __builtin_convertvector(u, int8);
    int8 y0 = __builtin_convertvector(v, int8);
    out->right = u - __builtin_convertvector(x0, float8);
    out->down = v - __builtin_convertvector(y0, float8);
    int32_t stride = size + 2;
    out->texel = (face * stride + y0) * stride + x0;
}

static inline __attribute__((always_inline)) rgbx fetch(const rgbx *texels, size_t stride, const float *right,
                                                        const float *down)
{
    const rgbx *below = texels + stride;
    rgbx a = texels[0] + (texels[1] - texels[0]) * *right;
    rgbx b = below[0] + (below[1] - below[0]) * *right;
    return a + (b - a) * *down;
}

/* Sum over the samples of a level, turned to the axes right, up, out. */
static inline __attribute__((always_inline)) void
add_group(const sampling *job, const cube *level, const sample_group *g, float axes[3][3], rgbx *sum)
{
    size_t stride = (size_t)level->size + 2;
    rgbx part = {0};
    for (uint32_t i = 0; i < g->block_count; i++) {
        float8 x = job->set.x[g->first + i];
        float8 y = job->set.y[g->first + i];
        float8 z = job->set.z[g->first + i];
        float8 dx = x * axes[0][0] + y * axes[1][0] + z * axes[2][0];
        float8 dy = x * axes[0][1] + y * axes[1][1] + z * axes[2][1];
        float8 dz = x * axes[0][2] + y * axes[1][2] + z * axes[2][2];
        sample_places p;
        locate(&dx, &dy, &dz, (int32_t)level->size, &p);
        int32_t texel[LANES];
        float right[LANES], down[LANES];
        memcpy(texel, &p.texel, sizeof texel);
        memcpy(right, &p.right, sizeof right);
        memcpy(down, &p.down, sizeof down);
        uint32_t count = g->count - i * LANES < LANES ? g->count - i * LANES : LANES;
        for (uint32_t k = 0; k < count; k++)
            part += fetch(level->texels + texel[k], stride, &right[k], &down[k]);
    }
    *sum += part;
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
            /* east, south and R; at a pole, where there is no east, X */
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
