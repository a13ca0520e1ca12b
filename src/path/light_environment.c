/* light_environment.c - see light_environment.h. */
#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "base/parallel.h"
#include "base/result.h"
#include "ibl/equirect.h"
#include "path/light_counts.h"

#include "path/light_environment.h"

enum {
    BANDS = LIGHT_ENVIRONMENT_BANDS,
    BLOCKS = LIGHT_ENVIRONMENT_BLOCKS,
    CELLS = LIGHT_ENVIRONMENT_CELLS,
    FINEST_WIDTH = 64, /* pictures below this are divided: one texel's density would be too coarse for what is
                          interpolated in it, and cells have whole columns and rows */
    FINEST_HEIGHT = 32
};

/* Share of a cell's light that any cell above the horizon keeps: what the guess of the cosine is wrong by. */
static const float DEFENSIVE_SHARE = 0.03f;

struct light_environment {
    const image *picture;
    float scale, rotation_cos, rotation_sin;
    uint32_t width, height, columns_per_texel, rows_per_texel; /* of the grid of densities */
    uint32_t *columns; /* per row, per block: ends of counts, in proportion to the texels' radiance */
    uint32_t *rows;    /* per block, per band: ends of counts, in proportion to the light of the rows */
    float *
        half_sine2; /* sin^2 (theta / 2) of the upper edge of rows of the upper half; and of the lower one's end */
    float *per_sr; /* 1 / solid angle of a texel, by row */
    /* By cell: sum of radiance times solid angle, and its mean direction, which is shorter the more it spreads; how far it
     * spreads, and the farthest that a direction of the cell is from the mean one, as sines. */
    float power[CELLS], mean_x[CELLS], mean_y[CELLS], mean_z[CELLS], spread[CELLS], reach[CELLS];
};

static uint32_t block_begin(const light_environment *e, uint32_t block)
{
    return (uint32_t)((uint64_t)e->width * block / BLOCKS);
}

static uint32_t band_begin(const light_environment *e, uint32_t band)
{
    return (uint32_t)((uint64_t)e->height * band / BANDS);
}

/* The last division whose begin, as above, is not behind index. */
static uint32_t division_of(uint32_t index, uint32_t size, uint32_t divisions)
{
    return (uint32_t)((((uint64_t)index + 1) * divisions - 1) / size);
}

/* ---- directions ---- */

/* World to environment and back: cpu/light_setup.c. */
static vec3 to_picture(const light_environment *e, vec3 d)
{
    return vec3(d[0] * e->rotation_cos - d[2] * e->rotation_sin, d[1],
                d[0] * e->rotation_sin + d[2] * e->rotation_cos);
}

static vec3 from_picture(const light_environment *e, vec3 d)
{
    return vec3(d[0] * e->rotation_cos + d[2] * e->rotation_sin, d[1],
                d[2] * e->rotation_cos - d[0] * e->rotation_sin);
}

/* The direction at `across` and `down` of texel (x, y), both in [0, 1): uniform numbers give uniform directions in it. The
 * angle from the nearer pole comes from its half: cos would leave nothing of it. */
static vec3 direction_in_texel(const light_environment *e, uint32_t x, uint32_t y, float across, float down)
{
    bool is_lower = 2 * y >= e->height;
    uint32_t row = is_lower ? e->height - 1 - y : y;
    float t = is_lower ? 1.0f - down : down;
    float s2 = mix(e->half_sine2[row], e->half_sine2[row + 1], t);
    float sin_theta = 2.0f * sqrt(s2 * (1.0f - s2));
    float cos_theta = 1.0f - 2.0f * s2;
    float phi = 2.0f * PI * (((float)x + across) / (float)e->width - 0.5f);
    return vec3(sin_theta * cos(phi), is_lower ? -cos_theta : cos_theta, sin_theta * sin(phi));
}

vec3 light_environment_radiance(const light_environment *e, vec3 d)
{
    vec3 turned = to_picture(e, d);
    rgbx c = equirect_fetch(e->picture, equirect_locate((float[3]){turned[0], turned[1], turned[2]}));
    return vec3(c[0], c[1], c[2]) * e->scale;
}

/* ---- densities ---- */

/* What building needs beside: directions of the columns, and sums over each row's part of a block. */
typedef struct building {
    light_environment *e;
    float *column_cos, *column_sin; /* of azimuth, per column */
    struct row_part {
        double light;    /* sum of radiance times solid angle */
        double along[2]; /* the same times cos and sin of the azimuth */
    } * parts;           /* per row, per block */
} building;

static float mean_of_channels(const float *texel)
{
    return (texel[0] + texel[1] + texel[2]) * (1.0f / 3.0f);
}

/* Radiance in the middle of (x, y) of the grid: of the picture, interpolated where the grid is finer. */
static float radiance_of(const light_environment *e, uint32_t x, uint32_t y)
{
    const image *p = e->picture;
    if (e->columns_per_texel == 1 && e->rows_per_texel == 1)
        return mean_of_channels((const float *)p->pixels + 3 * ((size_t)p->width * y + x));
    equirect_point point = {((float)x + 0.5f) / (float)e->width - 0.5f, ((float)y + 0.5f) / (float)e->height};
    rgbx c = equirect_fetch(p, point);
    return mean_of_channels((float[3]){c[0], c[1], c[2]});
}

/* Mean of the interpolated radiance over the rows' extent at the middle of a column: the tent that interpolates has 1/8 of
 * its area in each neighbour. */
static float mean_along_column(const light_environment *e, uint32_t x, uint32_t y)
{
    uint32_t above = y > 0 ? y - 1 : 0;
    uint32_t below = y + 1 < e->height ? y + 1 : y;
    return 0.125f * (radiance_of(e, x, above) + radiance_of(e, x, below)) + 0.75f * radiance_of(e, x, y);
}

/* Writes the weights of a block's part of a row into ends, as floats, and returns their sums. */
static struct row_part weigh_columns(const building *b, uint32_t y, uint32_t begin, uint32_t end,
                                     uint32_t *ends, size_t *positive)
{
    const light_environment *e = b->e;
    struct row_part sum = {0};
    float left = mean_along_column(e, begin > 0 ? begin - 1 : e->width - 1, y);
    float here = mean_along_column(e, begin, y);
    for (uint32_t x = begin; x < end; x++) {
        float right = mean_along_column(e, x + 1 < e->width ? x + 1 : 0, y);
        float weight = 0.125f * (left + right) + 0.75f * here;
        memcpy(&ends[x - begin], &weight, sizeof weight);
        sum.light += (double)weight;
        sum.along[0] += (double)(weight * b->column_cos[x]);
        sum.along[1] += (double)(weight * b->column_sin[x]);
        *positive += weight > 0.0f;
        left = here;
        here = right;
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
            double solid_angle =
                equirect_texel_solid_angle(e->width, e->height, (uint32_t)y) * (double)e->scale;
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
            equirect_direction(e->width, e->height, x - 0.5, y - 0.5, d);
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
        equirect_direction(e->width, e->height, 0.0, y, up);
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
    uint32_t cell = band * BLOCKS + block;
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
        equirect_direction(e->width, 1, x, 0.0, d);
        b->column_cos[x] = d[0];
        b->column_sin[x] = d[2];
    }
    for (uint32_t y = 0; y < e->height; y++)
        e->per_sr[y] = (float)(1.0 / equirect_texel_solid_angle(e->width, e->height, y));
    for (uint32_t y = 0; y <= (e->height + 1) / 2; y++) {
        float s = sin(0.5f * PI * (float)y / (float)e->height);
        e->half_sine2[y] = s * s;
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

static uint32_t divisions_for(uint32_t size, uint32_t finest)
{
    return size < finest ? (finest + size - 1) / size : 1;
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
    e->columns_per_texel = divisions_for(picture->width, FINEST_WIDTH);
    e->rows_per_texel = divisions_for(picture->height, FINEST_HEIGHT);
    e->width = picture->width * e->columns_per_texel;
    e->height = picture->height * e->rows_per_texel;
    facet_result result = FACET_OK;
    if (allocate(&b, allocator)) {
        make_tables(&b);
        parallel_for(thread_count, e->height, 16, make_rows, &b);
        float all = 0.0f;
        for (uint32_t cell = 0; cell < CELLS; cell++) {
            make_cell(&b, cell / BLOCKS, cell % BLOCKS);
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

/* ---- sampling ---- */

/* Clamped cosine of a cell whose mean direction is at x and that spreads to both sides of it: the line from 0 at -spread
 * to the cosine itself, never below what any part of the cell is worth. */
void light_environment_see(const light_environment *e, vec3 N, light_environment_view *view)
{
    vec3 n = to_picture(e, N);
    if (!(dot(N, N) > 0.0f)) {
        memcpy(view->cells, e->power, sizeof view->cells);
    } else {
        float nx = n[0];
        float ny = n[1];
        float nz = n[2];
        for (int i = 0; i < CELLS; i++) {
            float x = nx * e->mean_x[i] + ny * e->mean_y[i] + nz * e->mean_z[i];
            float near = 0.5f * (x + e->spread[i]);
            float cosine = x > near ? x : near;
            cosine = cosine > 0.0f ? cosine : 0.0f;
            float least = x + e->reach[i] > 0.0f ? DEFENSIVE_SHARE : 0.0f;
            view->cells[i] = e->power[i] * (cosine + least);
        }
    }
    float sum = 0.0f;
    for (int i = 0; i < CELLS; i++)
        sum += view->cells[i];
    view->irradiance = sum;
}

/* The item of weights[0 .. count - 1] with the sum `all` that u falls on; *rest as light_counts_find(). Items of weight 0 are
 * never it. */
static uint32_t find_item(const double *weights, uint32_t count, double all, double u, double *rest)
{
    double target = u * all;
    uint32_t found = count;
    for (uint32_t i = 0; i < count; i++) {
        if (!(weights[i] > 0.0))
            continue;
        if (found < count)
            target -= weights[found];
        found = i;
        if (target < weights[i])
            break;
    }
    target /= weights[found];
    *rest = target < 1.0 - 0x1p-53 ? target : 1.0 - 0x1p-53;
    return found;
}

float light_environment_sample(const light_environment *e, const light_environment_view *view,
                               const double u[2], vec3 *d)
{
    double bands[BANDS];
    double blocks[BLOCKS];
    double all = 0.0;
    for (int i = 0; i < BANDS; i++) {
        bands[i] = 0.0;
        for (int k = 0; k < BLOCKS; k++)
            bands[i] += (double)view->cells[i * BLOCKS + k];
        all += bands[i];
    }
    double down;
    double across;
    uint32_t band = find_item(bands, BANDS, all, u[1], &down);
    for (uint32_t k = 0; k < BLOCKS; k++)
        blocks[k] = (double)view->cells[band * BLOCKS + k];
    uint32_t block = find_item(blocks, BLOCKS, bands[band], u[0], &across);

    double row_probability;
    double column_probability;
    uint32_t top = band_begin(e, band);
    uint32_t left = block_begin(e, block);
    uint32_t y =
        top + (uint32_t)light_counts_find(e->rows + (size_t)block * e->height + top,
                                          band_begin(e, band + 1) - top, down, &row_probability, &down);
    uint32_t x = left + (uint32_t)light_counts_find(e->columns + (size_t)y * e->width + left,
                                                    block_begin(e, block + 1) - left, across,
                                                    &column_probability, &across);
    *d = from_picture(e, direction_in_texel(e, x, y, (float)across, (float)down));
    float cell_probability = view->cells[band * BLOCKS + block] / view->irradiance;
    return cell_probability * (float)row_probability * (float)column_probability * e->per_sr[y];
}

float light_environment_pdf(const light_environment *e, const light_environment_view *view, vec3 d)
{
    vec3 turned = to_picture(e, d);
    equirect_point p = equirect_locate((float[3]){turned[0], turned[1], turned[2]});
    uint32_t x = (uint32_t)clamp((p.turns + 0.5f) * (float)e->width, 0.0f, (float)(e->width - 1));
    uint32_t y = (uint32_t)clamp(p.half_turns * (float)e->height, 0.0f, (float)(e->height - 1));
    uint32_t band = division_of(y, e->height, BANDS);
    uint32_t block = division_of(x, e->width, BLOCKS);
    float cell = view->cells[band * BLOCKS + block];
    if (!(cell > 0.0f))
        return 0.0f;
    uint32_t top = band_begin(e, band);
    uint32_t left = block_begin(e, block);
    double row = light_counts_probability(e->rows + (size_t)block * e->height + top, y - top);
    double column = light_counts_probability(e->columns + (size_t)y * e->width + left, x - left);
    return row > 0.0 ? cell / view->irradiance * (float)row * (float)column * e->per_sr[y] : 0.0f;
}
