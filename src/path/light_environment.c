/* light_environment.c - see light_environment.h. */
#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "base/parallel.h"
#include "base/result.h"
#include "base/simd.h"
#include "path/light_distribution.h"

#include "ibl/equirect.h"

#include "path/light_environment.h"

enum { BANDS = LIGHT_ENVIRONMENT_BANDS, BLOCKS = LIGHT_ENVIRONMENT_BLOCKS, CELLS = LIGHT_ENVIRONMENT_CELLS };

/* Grid points are texel centers, and in small images points between them; four points bound a patch, in
 * which radiance is bilinear. Patch (x, y) has points x and x + 1 of rows y - 1 and y; beyond the first
 * and the last row is the pole, up to which radiance is that of the row. */
struct light_environment {
    const image *map;
    float scale, rotation_cos, rotation_sin;
    float floor;            /* of radiance, mean of the channels, unscaled: only what exceeds it is sampled */
    uint32_t width, height; /* patches: as many columns as points, one more row */
    bool is_finer;          /* than the image */
    uint32_t *columns;      /* per row, per block: ends of counts, in proportion to the patches' radiance */
    uint32_t *rows;         /* per block, per band: ends of counts, in proportion to the light of the rows */
    float *half_sine2; /* sin^2 (theta / 2) of the upper edges of rows, down to the one below the middle */
    float *per_sr;     /* 1 / solid angle of a patch, by row */
    /* By cell: the sum of radiance times solid angle; its mean direction, which is the shorter the wider
     * the cell is; its spread and largest deviation from the mean direction, as sines. */
    float power[CELLS], mean_x[CELLS], mean_y[CELLS], mean_z[CELLS], spread[CELLS], reach[CELLS];
};

static inline uint32_t block_begin(const light_environment *e, uint32_t block)
{
    return (uint32_t)((uint64_t)e->width * block / BLOCKS);
}

static inline uint32_t band_begin(const light_environment *e, uint32_t band)
{
    return (uint32_t)((uint64_t)e->height * band / BANDS);
}

static inline float mean_of_channels(const float *texel)
{
    return (texel[0] + texel[1] + texel[2]) * (1.0f / 3.0f);
}

/* Mean of the channels at point x of row y above the floor, unscaled. */
static inline float radiance_at(const light_environment *e, uint32_t x, uint32_t y)
{
    const image *p = e->map;
    if (!e->is_finer)
        return max(mean_of_channels((const float *)p->pixels + 3 * ((size_t)p->width * y + x)) - e->floor,
                   0.0f);
    equirect_point point = {((float)x + 0.5f) / (float)e->width - 0.5f,
                            ((float)y + 0.5f) / (float)(e->height - 1)};
    rgbx c = equirect_fetch(p, point);
    return max(mean_of_channels((float[3]){c[0], c[1], c[2]}) - e->floor, 0.0f);
}

enum {
    FINEST_WIDTH =
        64, /* smaller images get a grid finer than their texels, so that cells have whole columns */
    FINEST_HEIGHT = 32
};

static const double pi = 3.14159265358979323846;

/* ---- densities ---- */

/* From colatitude a to b: cos a - cos b = 2 sin((a + b) / 2) sin((b - a) / 2), without cancellation at the
 * poles. */
static double patch_solid_angle(const light_environment *e, uint32_t y)
{
    double rows = (double)(e->height - 1);
    double a = fmax((double)y - 0.5, 0.0) / rows;
    double b = fmin((double)y + 0.5, rows) / rows;
    return 4.0 * pi / (double)e->width * sin(0.5 * pi * (a + b)) * sin(0.5 * pi * (b - a));
}

/* Temporaries of the construction: directions of the columns, and sums over each row's part of a block. */
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

/* Writes the weights of a block's part of a row, which are the means of its patches, into ends, as floats,
 * and returns their sums. */
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

/* The largest deviation of a direction of the cell from the unit vector axis, as a sine; 1: a right angle
 * or more. */
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
        acos(clamp(least, -1.0f, 1.0f)) + 0.01f; /* an upper bound of the deviation between the steps */
    return angle < 0.5f * PI ? sin(angle) : 1.0f;
}

/* Fills the counts of the rows of a cell, and its moments. */
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
        double sin_theta = sqrt(1.0 - (double)up[1] * (double)up[1]);
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
        double s = sin(0.5 * pi * fmax((double)y - 0.5, 0.0) / (double)(e->height - 1));
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

/* Half of the mean radiance. Relative MSE of 16 samples with 0, .3, .5, 1 times the mean, over that of 0: sun and sky
 * .94, .89, .86; glass under soft boxes .94, .89, .89; an armchair under a clear sky .69, .66, .67; a bottle in a hall
 * .80, .93, 1.02. Where light samples are nearly free of noise, as on a diffuse surface that nothing shades, the
 * whole mean adds the noise of BSDF samples. */
static facet_result find_floor(light_environment *e, const facet_allocator *allocator, uint32_t thread_count,
                               facet_error *error)
{
    double mean[3];
    TRY(equirect_mean(e->map, allocator, thread_count, mean, error));
    float floor = 0.5f * mean_of_channels((float[3]){(float)mean[0], (float)mean[1], (float)mean[2]});
    e->floor = floor < INFINITY ? floor : 0.0f;
    return FACET_OK;
}

facet_result light_environment_create(const image *map, const light_setup *light, bool is_compensated,
                                      const facet_allocator *allocator, uint32_t thread_count,
                                      light_environment **out, facet_error *error)
{
    *out = NULL;
    building b = {.e = mem_zalloc(allocator, 1, sizeof *b.e)};
    if (!b.e)
        return fail_memory(error, "environment", sizeof *b.e);
    light_environment *e = b.e;
    e->map = map;
    e->scale = light->scale;
    e->rotation_cos = light->rotation_cos;
    e->rotation_sin = light->rotation_sin;
    e->width = map->width * points_for(map->width, FINEST_WIDTH);
    e->height = map->height * points_for(map->height, FINEST_HEIGHT) + 1;
    e->is_finer = e->width > map->width || e->height > map->height + 1;
    facet_result result = FACET_OK;
    if (is_compensated)
        result = find_floor(e, allocator, thread_count, error);
    if (result == FACET_OK && allocate(&b, allocator)) {
        make_tables(&b);
        parallel_for(thread_count, e->height, 16, make_rows, &b);
        float all = 0.0f;
        for (uint32_t cell = 0; cell < CELLS; cell++) {
            make_cell(&b, cell % BANDS, cell / BANDS);
            all += e->power[cell];
        }
        if (all > 0.0f && all < INFINITY)
            *out = e;
    } else if (result == FACET_OK) {
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

/* The cosine that a cell which reaches above the horizon gets at least. With a sun in the map just below
 * the horizon a larger value would be too much (deviation of the estimated irradiance of 96 x 48 texels
 * with one of 1e5, worst of 24 normals: .03: 3.8; .01: 2.3; .003: 1.4); a much smaller one would be too
 * little for the rest of its cell. */
static const float DEFENSIVE_SHARE = 0.003f;

/* The last division that begins at or before index. */
static uint32_t division_of(uint32_t index, uint32_t size, uint32_t divisions)
{
    return (uint32_t)((((uint64_t)index + 1) * divisions - 1) / size);
}

/* ---- patches ---- */

/* Radiance at the corners of a patch. */
typedef struct patch {
    float upper_left, upper_right, lower_left, lower_right;
} patch;

static patch patch_at(const light_environment *e, uint32_t x, uint32_t y)
{
    uint32_t right = x + 1 < e->width ? x + 1 : 0;
    uint32_t upper = y > 0 ? y - 1 : 0;
    uint32_t lower = y + 1 < e->height ? y : y - 1;
    return (patch){radiance_at(e, x, upper), radiance_at(e, right, upper), radiance_at(e, x, lower),
                   radiance_at(e, right, lower)};
}

/* Density of the point (s, t) of a patch, relative to a uniform one. */
static float patch_density(const patch *p, float s, float t)
{
    float upper = mix(p->upper_left, p->upper_right, s);
    float lower = mix(p->lower_left, p->lower_right, s);
    return 4.0f * mix(upper, lower, t) / (p->upper_left + p->upper_right + p->lower_left + p->lower_right);
}

/* A sample in [0, 1) of the density 2 mix(a, b, x) / (a + b). */
static float sample_linear(float u, float a, float b)
{
    float most = max(a, b); /* keeps the squares finite and above 0 */
    a /= most;
    b /= most;
    float x = u * (a + b) / (a + sqrt(mix(a * a, b * b, u)));
    return min(x, 0x1.fffffep-1f);
}

/* ---- directions ---- */

/* World to environment and back: draw/light_setup.c. */
static vec3 to_map(const light_environment *e, vec3 d)
{
    return vec3(d[0] * e->rotation_cos - d[2] * e->rotation_sin, d[1],
                d[0] * e->rotation_sin + d[2] * e->rotation_cos);
}

static vec3 from_map(const light_environment *e, vec3 d)
{
    return vec3(d[0] * e->rotation_cos + d[2] * e->rotation_sin, d[1],
                d[2] * e->rotation_cos - d[0] * e->rotation_sin);
}

/* Rows are mirrored into the upper half: the angle from the nearer pole is computed from its half, since
 * cos would lose its digits. */
static bool is_lower(const light_environment *e, uint32_t y)
{
    return 2 * y > e->height - 1;
}

/* The direction at (s, t) of patch (x, y): uniform random numbers give uniform directions in it. */
static vec3 direction_in_patch(const light_environment *e, uint32_t x, uint32_t y, float s, float t)
{
    bool mirrored = is_lower(e, y);
    uint32_t row = mirrored ? e->height - 1 - y : y;
    float s2 = mix(e->half_sine2[row], e->half_sine2[row + 1], mirrored ? 1.0f - t : t);
    float sin_theta = 2.0f * sqrt(s2 * (1.0f - s2));
    float cos_theta = 1.0f - 2.0f * s2;
    float phi = 2.0f * PI * (((float)x + 0.5f + s) / (float)e->width - 0.5f);
    return vec3(sin_theta * cos(phi), mirrored ? -cos_theta : cos_theta, sin_theta * sin(phi));
}

typedef struct patch_point {
    uint32_t x, y;
    float s, t;
} patch_point;

/* The patch of the unit direction d of the map, and the point in it. */
static patch_point locate(const light_environment *e, vec3 d)
{
    equirect_point p = equirect_locate((float[3]){d[0], d[1], d[2]});
    float across = p.turns * (float)e->width + (0.5f * (float)e->width - 0.5f);
    across = across < 0.0f ? across + (float)e->width : across;
    float down = p.half_turns * (float)(e->height - 1) + 0.5f;
    patch_point point = {.x = (uint32_t)across, .y = (uint32_t)down};
    point.x = point.x < e->width ? point.x : e->width - 1; /* rounded up */
    point.y = point.y < e->height ? point.y : e->height - 1;
    point.s = clamp(across - (float)point.x, 0.0f, 1.0f);
    bool mirrored = is_lower(e, point.y);
    uint32_t row = mirrored ? e->height - 1 - point.y : point.y;
    float s2 = 0.5f * (d[0] * d[0] + d[2] * d[2]) / (1.0f + (mirrored ? -d[1] : d[1]));
    float t = (s2 - e->half_sine2[row]) / (e->half_sine2[row + 1] - e->half_sine2[row]);
    point.t = clamp(mirrored ? 1.0f - t : t, 0.0f, 1.0f);
    return point;
}

vec3 light_environment_radiance(const light_environment *e, vec3 d)
{
    vec3 turned = to_map(e, d);
    rgbx c = equirect_fetch(e->map, equirect_locate((float[3]){turned[0], turned[1], turned[2]}));
    return vec3(c[0], c[1], c[2]) * e->scale;
}

/* ---- sampling ---- */

/* Clamped cosine of a cell, for x, the cosine to its mean direction, and its spread to both sides: linear
 * from 0 at -spread to the cosine itself, and at least the defensive share wherever the cell reaches above
 * the horizon. */
DISPATCH_AVX2 static void weigh_cells(const light_environment *restrict e, const float *restrict N,
                                      float *restrict cells)
{
    const float nx = N[0];
    const float ny = N[1];
    const float nz = N[2];
    for (int i = 0; i < CELLS; i++) {
        float x = nx * e->mean_x[i] + ny * e->mean_y[i] + nz * e->mean_z[i];
        float near = 0.5f * (x + e->spread[i]);
        float cosine = x > near ? x : near;
        float clamped = cosine > 0.0f ? cosine : 0.0f;
        float least = x + e->reach[i] > 0.0f ? DEFENSIVE_SHARE : 0.0f;
        cells[i] = e->power[i] * (clamped + least);
    }
}

void light_environment_see(const light_environment *e, vec3 N, light_environment_view *view)
{
    vec3 turned = to_map(e, N);
    if (dot(N, N) > 0.0f)
        weigh_cells(e, (float[3]){turned[0], turned[1], turned[2]}, view->cells);
    else
        memcpy(view->cells, e->power, sizeof view->cells);
    for (int i = 0; i < BANDS; i++)
        view->bands[i] = 0.0f;
    for (int k = 0; k < BLOCKS; k++)
        for (int i = 0; i < BANDS; i++)
            view->bands[i] += view->cells[k * BANDS + i];
    view->irradiance = 0.0f;
    for (int i = 0; i < BANDS; i++)
        view->irradiance += view->bands[i];
}

float light_environment_sample(const light_environment *e, const light_environment_view *view,
                               const double u[2], vec3 *d)
{
    double across = u[0];
    double down = u[1];
    uint32_t band = (uint32_t)light_choose(view->bands, BANDS, &down);
    float blocks[BLOCKS];
    for (uint32_t k = 0; k < BLOCKS; k++)
        blocks[k] = view->cells[k * BANDS + band];
    uint32_t block = (uint32_t)light_choose(blocks, BLOCKS, &across);

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
    patch p = patch_at(e, x, y);
    float t = sample_linear((float)down, p.upper_left + p.upper_right, p.lower_left + p.lower_right);
    float s = sample_linear((float)across, mix(p.upper_left, p.lower_left, t),
                            mix(p.upper_right, p.lower_right, t));
    *d = from_map(e, direction_in_patch(e, x, y, s, t));
    float cell_probability = view->cells[block * BANDS + band] / view->irradiance;
    return cell_probability * (float)row_probability * (float)column_probability * e->per_sr[y] *
           patch_density(&p, s, t);
}

float light_environment_pdf(const light_environment *e, const light_environment_view *view, vec3 d)
{
    patch_point at = locate(e, to_map(e, d));
    uint32_t band = division_of(at.y, e->height, BANDS);
    uint32_t block = division_of(at.x, e->width, BLOCKS);
    float cell = view->cells[block * BANDS + band];
    if (!(cell > 0.0f))
        return 0.0f;
    uint32_t top = band_begin(e, band);
    uint32_t left = block_begin(e, block);
    double row = light_counts_probability(e->rows + (size_t)block * e->height + top, at.y - top);
    double column = light_counts_probability(e->columns + (size_t)at.y * e->width + left, at.x - left);
    if (!(row > 0.0 && column > 0.0))
        return 0.0f;
    patch p = patch_at(e, at.x, at.y);
    return cell / view->irradiance * (float)row * (float)column * e->per_sr[at.y] *
           patch_density(&p, at.s, at.t);
}
