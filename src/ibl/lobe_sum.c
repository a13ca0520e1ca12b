/* lobe_sum.c - see lobe_sum.h. Blocks are six times smaller than a lobe is wide; away from the axis, where a narrow lobe
 * falls off slowly, four times larger ones do. A block's weight is taken where its energy is, so that the error is of second
 * order in the spread of energy within it. */
#include "ibl/lobe_sum.h"

#include <math.h>

#include "base/memory.h"
#include "base/parallel.h"
#include "base/result.h"
#include "base/simd.h"
#include "ibl/equirect.h"
#include "ibl/gauss.h"

#include "shade/shade.h"

static const double pi_double = 3.14159265358979323846;

/* ---- blocks ---- */

typedef struct block_job {
    const image *picture; /* of which the first level is made */
    float limit;
    uint32_t step;            /* texels along an edge of its blocks */
    uint32_t parts;           /* of a texel, each way, that count as texels */
    const lobe_blocks *below; /* of which another one is */
    lobe_blocks *to;
} block_job;

/* Sums of a block while it is put together. */
typedef struct block_sums {
    double energy[3], moment[3], middle[3];
} block_sums;

static void add_part(block_sums *s, const float energy[3], const float direction[3], double solid_angle)
{
    double bright = (double)energy[0] + (double)energy[1] + (double)energy[2];
    for (int i = 0; i < 3; i++) {
        s->energy[i] += (double)energy[i];
        s->moment[i] += bright * (double)direction[i];
        s->middle[i] += solid_angle * (double)direction[i]; /* where a black one is */
    }
}

static void add_texels(const block_job *job, uint32_t x, uint32_t y, block_sums *sums)
{
    const image *picture = job->picture;
    uint32_t width = picture->width * job->parts;
    uint32_t height = picture->height * job->parts;
    uint32_t step = job->step;
    for (uint32_t v = step * y; v < step * (y + 1) && v < height; v++) {
        double solid_angle = equirect_texel_solid_angle(width, height, v);
        for (uint32_t u = step * x; u < step * (x + 1) && u < width; u++) {
            const float *texel = (const float *)picture->pixels +
                                 3 * ((size_t)(v / job->parts) * picture->width + u / job->parts);
            float energy[3], direction[3];
            for (int i = 0; i < 3; i++)
                energy[i] = min(texel[i], job->limit) * (float)solid_angle;
            equirect_direction(width, height, u, v, direction);
            add_part(sums, energy, direction, solid_angle);
        }
    }
}

static void add_blocks(const lobe_blocks *below, uint32_t x, uint32_t y, block_sums *sums)
{
    for (uint32_t v = 2 * y; v < 2 * y + 2 && v < below->height; v++)
        for (uint32_t u = 2 * x; u < 2 * x + 2 && u < below->width; u++) {
            size_t k = (size_t)v * below->width + u;
            const float energy[3] = {below->energy[0][k], below->energy[1][k], below->energy[2][k]};
            const float direction[3] = {below->direction[0][k], below->direction[1][k],
                                        below->direction[2][k]};
            add_part(sums, energy, direction, 1.0);
        }
}

static void make_blocks(void *context, size_t begin, size_t end)
{
    const block_job *job = context;
    const lobe_blocks *to = job->to;
    for (uint32_t y = (uint32_t)begin; y < end; y++)
        for (uint32_t x = 0; x < to->width; x++) {
            block_sums s = {{0.0}, {0.0}, {0.0}};
            if (job->below)
                add_blocks(job->below, x, y, &s);
            else
                add_texels(job, x, y, &s);
            const double *d = s.moment;
            double length2 = d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
            if (!(length2 > 0.0)) {
                d = s.middle;
                length2 = d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
            }
            double scale = length2 > 0.0 ? 1.0 / (sqrt)(length2) : 0.0;
            size_t k = (size_t)y * to->width + x;
            for (int i = 0; i < 3; i++) {
                to->direction[i][k] = (float)(d[i] * scale);
                to->energy[i][k] = (float)s.energy[i];
            }
        }
}

static bool allocate_blocks(uint32_t width, uint32_t height, const facet_allocator *allocator,
                            lobe_blocks *out)
{
    size_t count = (size_t)width * height;
    float *memory = mem_alloc(allocator, count, 6 * sizeof(float));
    if (!memory)
        return false;
    *out = (lobe_blocks){.width = width, .height = height, .texel_rad = PI / (float)height};
    for (int i = 0; i < 3; i++) {
        out->direction[i] = memory + (size_t)i * count;
        out->energy[i] = memory + (size_t)(3 + i) * count;
    }
    return true;
}

facet_result lobe_sum_create(const image *picture, float limit, const facet_allocator *allocator,
                             uint32_t thread_count, lobe_sum *out, facet_error *error)
{
    uint32_t step = 1;
    uint32_t parts = 1;
    while (picture->width / step > LOBE_SUM_MAX_WIDTH)
        step *= 2;
    while (picture->width * parts < LOBE_SUM_MIN_WIDTH)
        parts *= 2;
    uint32_t width = (picture->width * parts + step - 1) / step;
    uint32_t height = (picture->height * parts + step - 1) / step;
    *out = (lobe_sum){.texel_rad = PI / (float)picture->height};
    for (uint32_t level = 0; level < LOBE_SUM_LEVELS; level++) {
        lobe_blocks *to = &out->levels[level];
        if (!allocate_blocks(width, height, allocator, to)) {
            lobe_sum_destroy(out);
            return fail_memory(error, "blocks of texels", (size_t)width * height * 6 * sizeof(float));
        }
        out->level_count++;
        block_job job = {.picture = picture,
                         .limit = limit,
                         .step = step,
                         .parts = parts,
                         .below = level ? to - 1 : NULL,
                         .to = to};
        parallel_for(thread_count, height, 8, make_blocks, &job);
        width = (width + 1) / 2;
        height = (height + 1) / 2;
    }
    return FACET_OK;
}

void lobe_sum_destroy(lobe_sum *s)
{
    for (uint32_t level = 0; level < s->level_count; level++)
        mem_free(s->levels[level].direction[0]);
    *s = (lobe_sum){0};
}

/* ---- lobes ---- */

/* The weight at cosine x >= 0 from the axis. */
static inline float weight_of_GGX(float x, float alpha)
{
    return D_GGX(sqrt(0.5f + 0.5f * x), alpha) * x;
}

/* Charlie's, whose powers no loop of vectors has; linear between entries. */
static inline float weight_of_table(const float table[LOBE_TABLE_SIZE + 2], float x)
{
    float place = x * (float)LOBE_TABLE_SIZE;
    int i = (int)place;
    return table[i] + (table[i + 1] - table[i]) * (place - (float)i);
}

static float weight_of(facet_lobe lobe, float alpha, float x)
{
    switch (lobe) {
    case FACET_LOBE_GGX:
        return weight_of_GGX(x, alpha);
    case FACET_LOBE_CHARLIE:
        return D_Charlie(sqrt(0.5f + 0.5f * x), alpha) * x;
    default:
        return x;
    }
}

/* The integral of the weight over the hemisphere, in panels of the angle that double in width. */
static double integrate_lobe(facet_lobe lobe, float alpha)
{
    double sum = 0.0;
    double from = 0.0;
    double width = lobe == FACET_LOBE_GGX ? 0.25 * (double)alpha : 0.05;
    while (from < 0.5 * pi_double) {
        double to = fmin(from + width, 0.5 * pi_double);
        for (int i = 0; i < 8; i++) {
            double w;
            double theta = gauss_8(i, from, to, &w);
            float x = (float)(cos)(theta);
            sum += w * 2.0 * pi_double * (sin)(theta) * (double)weight_of(lobe, alpha, x);
        }
        from = to;
        width *= lobe == FACET_LOBE_GGX ? 1.5 : 1.0;
    }
    return sum;
}

void lobe_plan_make(const lobe_sum *sum, facet_lobe lobe, float perceptual_roughness, lobe_plan *out)
{
    float alpha = alpha_from_roughness(perceptual_roughness);
    /* of Charlie's ring, which has two sharp edges; all lobes end sharply at the horizon */
    float largest = lobe == FACET_LOBE_CHARLIE ? alpha * (1.0f / 5.0f) : alpha * (1.0f / 6.0f);
    largest = lobe == FACET_LOBE_LAMBERT ? 1.0f : largest;
    largest = min(largest, max(0.026f, 1.01f * sum->texel_rad)); /* no texel has anything smaller in it */
    uint32_t near = 0;
    while (near + 1 < sum->level_count && sum->levels[near + 1].texel_rad <= largest)
        near++;
    *out = (lobe_plan){.sum = sum,
                       .lobe = lobe,
                       .alpha = alpha,
                       .scale = (float)(1.0 / integrate_lobe(lobe, alpha)),
                       .near = near,
                       .far = near,
                       .x_near = -2.0f,
                       .x_far = -2.0f};
    if (lobe == FACET_LOBE_CHARLIE)
        for (int i = 0; i < LOBE_TABLE_SIZE + 2; i++)
            out->table[i] = weight_of(lobe, alpha, min((float)i / LOBE_TABLE_SIZE, 1.0f));
    if (lobe == FACET_LOBE_GGX && near + 2 < sum->level_count) {
        float fade = 8.0f * sum->levels[near + 2].texel_rad;
        if (2.0f * fade < 0.5f * PI) {
            out->far = near + 2;
            out->x_near = cos(fade);
            out->x_far = cos(2.0f * fade);
        }
    }
}

/* ---- sums ---- */

enum { LANES = 16 };

/* Which part of a lobe a loop adds: all of it, what is close to the axis, the rest. */
typedef enum lobe_part { PART_ALL, PART_NEAR, PART_FAR } lobe_part;

typedef struct lane_sums {
    float rgb[3][LANES];
} lane_sums;

static inline float fade(float x, float x_far, float scale)
{
    float t = clamp((x - x_far) * scale, 0.0f, 1.0f);
    return t * t * (3.0f - 2.0f * t);
}

/* Adds count blocks from k on, LANES at a time: weights, then sums, each a plain loop. */
static inline __attribute__((always_inline)) void add_run(const lobe_plan *p, const lobe_blocks *b,
                                                          facet_lobe lobe, lobe_part part,
                                                          const float axis[3], size_t k, size_t count,
                                                          lane_sums *sums)
{
    const float *dx = b->direction[0] + k;
    const float *dy = b->direction[1] + k;
    const float *dz = b->direction[2] + k;
    float alpha = p->alpha;
    float fade_scale = 1.0f / (p->x_near - p->x_far);
    for (size_t i = 0; i < count; i += LANES) {
        size_t run = count - i < LANES ? count - i : LANES;
        float weights[LANES];
        for (size_t j = 0; j < run; j++) {
            float x = max(axis[0] * dx[i + j] + axis[1] * dy[i + j] + axis[2] * dz[i + j], 0.0f);
            float w = lobe == FACET_LOBE_GGX       ? weight_of_GGX(x, alpha)
                      : lobe == FACET_LOBE_CHARLIE ? weight_of_table(p->table, x)
                                                   : x;
            if (part == PART_NEAR)
                w *= fade(x, p->x_far, fade_scale);
            if (part == PART_FAR)
                w *= 1.0f - fade(x, p->x_far, fade_scale);
            weights[j] = w;
        }
        for (int c = 0; c < 3; c++)
            for (size_t j = 0; j < run; j++)
                sums->rgb[c][j] += weights[j] * b->energy[c][k + i + j];
    }
}

/* Each lobe with each of its parts is a loop of its own. */
DISPATCH_AVX2 static void lobe_add_run(const lobe_plan *p, const lobe_blocks *b, lobe_part part,
                                       const float axis[3], size_t k, size_t count, lane_sums *sums)
{
    if (p->lobe == FACET_LOBE_CHARLIE)
        add_run(p, b, FACET_LOBE_CHARLIE, PART_ALL, axis, k, count, sums);
    else if (p->lobe != FACET_LOBE_GGX)
        add_run(p, b, FACET_LOBE_LAMBERT, PART_ALL, axis, k, count, sums);
    else if (part == PART_ALL)
        add_run(p, b, FACET_LOBE_GGX, PART_ALL, axis, k, count, sums);
    else if (part == PART_NEAR)
        add_run(p, b, FACET_LOBE_GGX, PART_NEAR, axis, k, count, sums);
    else
        add_run(p, b, FACET_LOBE_GGX, PART_FAR, axis, k, count, sums);
}

/* The blocks less than an angle from the axis: in each row a stretch of columns, which may run over the seam. */
static void add_near(const lobe_plan *p, const float axis[3], lane_sums *sums)
{
    const lobe_blocks *b = &p->sum->levels[p->near];
    float reach = acos(p->x_far) + 2.0f * b->texel_rad; /* energy is not in the middle of its block */
    float theta_axis = acos(clamp(axis[1], -1.0f, 1.0f));
    float column = (atan(axis[2], axis[0]) * (0.5f * INV_PI) + 0.5f) * (float)b->width;
    float cos_reach = cos(min(reach, PI));
    for (uint32_t y = 0; y < b->height; y++) {
        float theta = ((float)y + 0.5f) * b->texel_rad;
        if (abs(theta - theta_axis) > reach)
            continue;
        float level = axis[1] * cos(theta);
        float swing = sin(theta_axis) * sin(theta);
        /* level + swing cos(phi) > cos(reach) */
        float c = (cos_reach - level) / max(swing, 1e-9f);
        float columns =
            c <= -1.0f ? (float)b->width : acos(min(c, 1.0f)) * (0.5f * INV_PI) * (float)b->width + 2.0f;
        size_t row = (size_t)y * b->width;
        if (2.0f * columns >= (float)b->width) {
            lobe_add_run(p, b, PART_NEAR, axis, row, b->width, sums);
            continue;
        }
        float first = column - columns;
        first = first < 0.0f ? first + (float)b->width : first;
        uint32_t from = (uint32_t)first < b->width ? (uint32_t)first : b->width - 1;
        uint32_t count = (uint32_t)(2.0f * columns) + 1;
        uint32_t before = from + count < b->width ? count : b->width - from;
        lobe_add_run(p, b, PART_NEAR, axis, row + from, before, sums);
        if (before < count)
            lobe_add_run(p, b, PART_NEAR, axis, row, count - before, sums);
    }
}

void lobe_plan_gather(const lobe_plan *p, const float axis[3], float out[3])
{
    lane_sums sums = {{{0.0f}}};
    const lobe_blocks *b = &p->sum->levels[p->far];
    size_t count = (size_t)b->width * b->height;
    if (p->near == p->far) {
        lobe_add_run(p, b, PART_ALL, axis, 0, count, &sums);
    } else {
        lobe_add_run(p, b, PART_FAR, axis, 0, count, &sums);
        add_near(p, axis, &sums);
    }
    for (int c = 0; c < 3; c++) {
        double total = 0.0;
        for (int j = 0; j < LANES; j++)
            total += (double)sums.rgb[c][j];
        out[c] = (float)(total * (double)p->scale);
    }
}
