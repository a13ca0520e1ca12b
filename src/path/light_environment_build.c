/* light_environment_build.c - makes the densities of an environment: see light_environment.h. */
#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "base/parallel.h"
#include "base/result.h"
#include "path/light_counts.h"

#include "path/light_environment_grid.h"

enum {
    FINEST_WIDTH =
        64, /* the grid of smaller pictures is finer than their texels, so that cells have whole columns */
    FINEST_HEIGHT = 32
};

static const double pi = 3.14159265358979323846;

/* ---- densities ---- */

/* From colatitude a to b: cos a - cos b = 2 sin((a + b) / 2) sin((b - a) / 2), without cancellation at the poles. */
static double patch_solid_angle(const light_environment *e, uint32_t y)
{
    double rows = (double)(e->height - 1);
    double a = fmax((double)y - 0.5, 0.0) / rows;
    double b = fmin((double)y + 0.5, rows) / rows;
    return 4.0 * pi / (double)e->width * (sin)(0.5 * pi * (a + b)) * (sin)(0.5 * pi * (b - a));
}

/* What building needs beside: directions of the columns, and sums over each row's part of a block. */
typedef struct building {
    light_environment *e;
    float *column_cos, *column_sin; /* of azimuth, per column */
    struct row_part {
        double light;    /* sum of radiance times solid angle */
        double along[2]; /* the same times cos and sin of the azimuth */
    } * parts;           /* per row, per block */
} building;

/* Radiance in the middle of a row of patches, at a point. */
static float middle_of_row(const light_environment *e, uint32_t x, uint32_t y)
{
    uint32_t upper = y > 0 ? y - 1 : 0;
    uint32_t lower = y + 1 < e->height ? y : y - 1;
    return 0.5f * (radiance_at(e, x, upper) + radiance_at(e, x, lower));
}

/* Writes the weights of a block's part of a row, which are the means of its patches, into ends, as floats, and returns their
 * sums. */
static struct row_part weigh_columns(const building *b, uint32_t y, uint32_t begin, uint32_t end,
                                     uint32_t *ends, size_t *positive)
{
    const light_environment *e = b->e;
    struct row_part sum = {0};
    float left = middle_of_row(e, begin, y);
    for (uint32_t x = begin; x < end; x++) {
        float right = middle_of_row(e, x + 1 < e->width ? x + 1 : 0, y);
        float weight = 0.5f * (left + right);
        memcpy(&ends[x - begin], &weight, sizeof weight);
        sum.light += (double)weight;
        sum.along[0] += (double)(weight * b->column_cos[x]);
        sum.along[1] += (double)(weight * b->column_sin[x]);
        *positive += weight > 0.0f;
        left = right;
    }
    return sum;
}

/* Weights to ends of counts, in place. */
static void count_columns(uint32_t *ends, uint32_t count, double all, size_t positive_all)
{
    double sum = 0.0;
    size_t positive = 0;
    for (uint32_t i = 0; i < count; i++) {
        float weight;
        memcpy(&weight, &ends[i], sizeof weight);
        sum += (double)weight;
        positive += weight > 0.0f;
        ends[i] = light_counts_end(sum, all, positive, positive_all);
    }
}

static void make_rows(void *context, size_t first, size_t last)
{
    const building *b = context;
    light_environment *e = b->e;
    for (size_t y = first; y < last; y++)
        for (uint32_t block = 0; block < BLOCKS; block++) {
            uint32_t begin = block_begin(e, block);
            uint32_t end = block_begin(e, block + 1);
            uint32_t *ends = e->columns + y * e->width + begin;
            size_t positive = 0;
            struct row_part part = weigh_columns(b, (uint32_t)y, begin, end, ends, &positive);
            if (positive > 0)
                count_columns(ends, end - begin, part.light, positive);
            double solid_angle = patch_solid_angle(e, (uint32_t)y) * (double)e->scale;
            part.light *= solid_angle;
            part.along[0] *= solid_angle;
            part.along[1] *= solid_angle;
            b->parts[y * BLOCKS + block] = part;
        }
}

/* The farthest that a direction of the cell is from the unit vector axis, as a sine; 1: a right angle or more. */
static float reach_of_cell(const light_environment *e, uint32_t band, uint32_t block, vec3 axis)
{
    enum { STEPS = 8 };
    float least = 1.0f; /* cosine */
    for (int i = 0; i <= STEPS; i++)
        for (int k = 0; k <= STEPS; k++) {
            double x = block_begin(e, block) +
                       (block_begin(e, block + 1) - block_begin(e, block)) * (double)i / STEPS;
            double y =
                band_begin(e, band) + (band_begin(e, band + 1) - band_begin(e, band)) * (double)k / STEPS;
            float d[3];
            equirect_direction(e->width, e->height - 1, x, fmin(fmax(y - 1.0, -0.5), e->height - 1.5), d);
            least = min(least, dot(axis, vec3(d[0], d[1], d[2])));
        }
    float angle =
        acos(clamp(least, -1.0f, 1.0f)) + 0.01f; /* between the steps it is less than that farther */
    return angle < 0.5f * PI ? sin(angle) : 1.0f;
}

/* Counts of the rows of a cell and what is known of the cell. */
static void make_cell(const building *b, uint32_t band, uint32_t block)
{
    light_environment *e = b->e;
    uint32_t begin = band_begin(e, band);
    uint32_t end = band_begin(e, band + 1);
    double all = 0.0;
    double moment[3] = {0.0, 0.0, 0.0};
    size_t positive_all = 0;
    for (uint32_t y = begin; y < end; y++) {
        const struct row_part *part = &b->parts[(size_t)y * BLOCKS + block];
        float up[3];
        equirect_direction(e->width, e->height - 1, 0.0, (double)y - 0.5, up);
        double sin_theta = (sqrt)(1.0 - (double)up[1] * (double)up[1]);
        all += part->light;
        moment[0] += part->along[0] * sin_theta;
        moment[1] += part->light * (double)up[1];
        moment[2] += part->along[1] * sin_theta;
        positive_all += part->light > 0.0;
    }
    if (!(all > 0.0))
        return;
    double sum = 0.0;
    size_t positive = 0;
    uint32_t *ends = e->rows + (size_t)block * e->height;
    for (uint32_t y = begin; y < end; y++) {
        double light = b->parts[(size_t)y * BLOCKS + block].light;
        sum += light;
        positive += light > 0.0;
        ends[y] = light_counts_end(sum, all, positive, positive_all);
    }
    uint32_t cell = block * BANDS + band;
    vec3 mean = vec3((float)(moment[0] / all), (float)(moment[1] / all), (float)(moment[2] / all));
    float length2 = min(dot(mean, mean), 1.0f);
    e->power[cell] = (float)all;
    e->mean_x[cell] = mean[0];
    e->mean_y[cell] = mean[1];
    e->mean_z[cell] = mean[2];
    e->spread[cell] = sqrt(1.0f - length2);
    e->reach[cell] = sqrt(length2) * reach_of_cell(e, band, block, normalize(mean));
}

static void make_tables(const building *b)
{
    light_environment *e = b->e;
    for (uint32_t x = 0; x < e->width; x++) {
        float d[3];
        equirect_direction(e->width, 1, (double)x + 0.5, 0.0, d);
        b->column_cos[x] = d[0];
        b->column_sin[x] = d[2];
    }
    for (uint32_t y = 0; y < e->height; y++)
        e->per_sr[y] = (float)(1.0 / patch_solid_angle(e, y));
    for (uint32_t y = 0; y < e->height / 2 + 2; y++) {
        double s = (sin)(0.5 * pi * fmax((double)y - 0.5, 0.0) / (double)(e->height - 1));
        e->half_sine2[y] = (float)(s * s);
    }
}

/* ---- making ---- */

static bool allocate(building *b, const facet_allocator *allocator)
{
    light_environment *e = b->e;
    e->columns = mem_alloc(allocator, e->height, e->width * sizeof *e->columns);
    e->rows = mem_zalloc(allocator, e->height, BLOCKS * sizeof *e->rows);
    e->half_sine2 = mem_alloc(allocator, e->height + (size_t)2, sizeof *e->half_sine2);
    e->per_sr = mem_alloc(allocator, e->height, sizeof *e->per_sr);
    b->column_cos = mem_alloc(allocator, e->width, sizeof *b->column_cos);
    b->column_sin = mem_alloc(allocator, e->width, sizeof *b->column_sin);
    b->parts = mem_alloc(allocator, e->height, BLOCKS * sizeof *b->parts);
    return e->columns && e->rows && e->half_sine2 && e->per_sr && b->column_cos && b->column_sin && b->parts;
}

/* Points per texel, odd: the middles of texels, where radiance has its kinks, are among them. */
static uint32_t points_for(uint32_t size, uint32_t finest)
{
    return size < finest ? (finest + size - 1) / size | 1u : 1;
}

facet_result light_environment_create(const image *picture, const light_setup *light,
                                      const facet_allocator *allocator, uint32_t thread_count,
                                      light_environment **out, facet_error *error)
{
    *out = NULL;
    building b = {.e = mem_zalloc(allocator, 1, sizeof *b.e)};
    if (!b.e)
        return fail_memory(error, "environment", sizeof *b.e);
    light_environment *e = b.e;
    e->picture = picture;
    e->scale = light->scale;
    e->rotation_cos = light->rotation_cos;
    e->rotation_sin = light->rotation_sin;
    e->width = picture->width * points_for(picture->width, FINEST_WIDTH);
    e->height = picture->height * points_for(picture->height, FINEST_HEIGHT) + 1;
    e->is_finer = e->width > picture->width || e->height > picture->height + 1;
    facet_result result = FACET_OK;
    if (allocate(&b, allocator)) {
        make_tables(&b);
        parallel_for(thread_count, e->height, 16, make_rows, &b);
        float all = 0.0f;
        for (uint32_t cell = 0; cell < CELLS; cell++) {
            make_cell(&b, cell % BANDS, cell / BANDS);
            all += e->power[cell];
        }
        if (all > 0.0f && all < INFINITY)
            *out = e;
    } else {
        result = fail_memory(error, "environment", (size_t)e->width * e->height * sizeof *e->columns);
    }
    mem_free(b.column_cos);
    mem_free(b.column_sin);
    mem_free(b.parts);
    if (!*out)
        light_environment_destroy(e);
    return result;
}

void light_environment_destroy(light_environment *e)
{
    if (!e)
        return;
    mem_free(e->columns);
    mem_free(e->rows);
    mem_free(e->half_sine2);
    mem_free(e->per_sr);
    mem_free(e);
}
