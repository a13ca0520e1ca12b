/* harmonics_filter.c - synthesis: from coefficients to a cube map, through a grid of 2 L rows and at least 3
 * L columns for degree L: sums over degrees, a Fourier transform of each row, then cubic interpolation, whose
 * error at the grid's spacing is at most 0.1 % of a sun's lobe. */
#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "base/parallel.h"
#include "base/result.h"
#include "ibl/equirect.h"
#include "ibl/harmonics_transform.h"
#include "ibl/harmonics.h"

static const double pi = 3.14159265358979323846;

enum {
    PARTS = HARMONICS_PARTS,
    LANES = LEGENDRE_LANES,
    PAD = 2 /* texels around the grid, for cubic interpolation */
};

typedef struct synthesis {
    const harmonics *in;
    const harmonics_filter_desc *desc;
    uint32_t width, height; /* of the grid without its padding of PAD texels on all sides */
    fourier transform;
    legendre_rows rows;
    cube *out;
} synthesis;

/* A power of two with degree well below its half. */
static uint32_t column_count(uint32_t degree)
{
    uint32_t count = 16;
    while (count < 3 * degree)
        count *= 2;
    return count;
}

static rgbx *grid_texel(const synthesis *job, int x, int y)
{
    return job->in->grid + (size_t)(y + PAD) * (job->width + 2 * PAD) + (size_t)(x + PAD);
}

#define INLINE static inline __attribute__((always_inline))

/* The first part_count parts of the coefficients of an order, scaled and rotated. */
INLINE void scale_order(const synthesis *job, uint32_t m, uint32_t part_count, float scaled[][PARTS])
{
    const harmonics *h = job->in;
    /* the column centers of both grids lie half a column off phi = 0 */
    double turn = m * (job->desc->rotation_rad + pi * (1.0 / job->width - 1.0 / h->column_count));
    float c = (float)cos(turn);
    float s = (float)sin(turn);
    const float *in = h->coefficients + harmonics_order_index(h->degree, m);
    for (uint32_t l = m; l <= job->desc->degree; l++, in += PARTS)
        for (uint32_t i = 0; i < part_count; i += 2) {
            scaled[l][i] = job->desc->kernel[l] * (in[i] * c - in[i + 1] * s);
            scaled[l][i + 1] = job->desc->kernel[l] * (in[i] * s + in[i + 1] * c);
        }
}

/* part_count is a constant where this is inlined. */
INLINE void synthesise_order(const synthesis *job, uint32_t m, uint32_t part_count)
{
    const uint32_t degree = job->desc->degree;
    float scaled[HARMONICS_MAX_DEGREE + 1][PARTS];
    scale_order(job, m, part_count, scaled);
    legendre p;
    legendre_init(&p, m, degree, &job->rows);
    for (uint32_t k = 0; k < job->rows.block_count; k++) {
        float8 even[PARTS] = {{0}};
        float8 odd[PARTS] = {{0}};
        double8 x = job->rows.x[k];
        double8 now = p.now[k];
        double8 before = p.before[k];
        for (uint32_t l = p.from[k]; l <= degree; l += 2) {
            float8 value;
            legendre_floats(&now, &value);
            for (uint32_t part = 0; part < part_count; part++)
                even[part] += value * scaled[l][part];
            if (l == degree)
                break;
            legendre_step(&x, &now, &before, p.b[l + 1], p.a[l + 1]);
            legendre_floats(&before, &value);
            for (uint32_t part = 0; part < part_count; part++)
                odd[part] += value * scaled[l + 1][part];
            legendre_step(&x, &before, &now, p.b[l + 2], p.a[l + 2]);
        }
        for (uint32_t part = 0; part < part_count; part++) {
            float *to = job->in->spectra + harmonics_spectrum_index(m, 0, part, degree) + (size_t)k * LANES;
            memcpy(to, &even[part], sizeof even[part]);
            to = job->in->spectra + harmonics_spectrum_index(m, 1, part, degree) + (size_t)k * LANES;
            memcpy(to, &odd[part], sizeof odd[part]);
        }
    }
}

DISPATCH_AVX2 static void synthesise_orders(void *context, size_t begin, size_t end)
{
    const synthesis *job = context;
    for (size_t order = begin; order < end; order++)
        if (job->in->is_grey)
            synthesise_order(job, (uint32_t)order, 2);
        else
            synthesise_order(job, (uint32_t)order, PARTS);
}

/* Lanes of the transform: the channels of a row and of its mirror row, or, where those are the same, four rows and
 * their mirror rows. */
enum { GREY_ROWS = 4 };
typedef float float4 __attribute__((vector_size(16)));

/* Waves of the pair of rows j, as lanes of re and im. */
INLINE void read_waves(const synthesis *job, uint32_t j, float8 *re, float8 *im)
{
    const uint32_t pair_count = job->desc->degree;
    for (uint32_t m = 0; m <= job->desc->degree; m++) {
        float e[PARTS], o[PARTS];
        for (uint32_t part = 0; part < PARTS; part++) {
            e[part] = job->in->spectra[harmonics_spectrum_index(m, 0, part, pair_count) + j];
            o[part] = job->in->spectra[harmonics_spectrum_index(m, 1, part, pair_count) + j];
        }
        re[m] = (float8){e[0] + o[0], e[2] + o[2], e[4] + o[4], 0.0f,
                         e[0] - o[0], e[2] - o[2], e[4] - o[4], 0.0f};
        im[m] = (float8){e[1] + o[1], e[3] + o[3], e[5] + o[5], 0.0f,
                         e[1] - o[1], e[3] - o[3], e[5] - o[5], 0.0f};
    }
}

/* Adds and subtracts the values of even and odd degrees of GREY_ROWS rows. */
INLINE void join_parities(const float *even, const float *odd, float8 *out)
{
    float4 e, o;
    memcpy(&e, even, sizeof e);
    memcpy(&o, odd, sizeof o);
    const float4 north = e + o, south = e - o;
    memcpy(out, &north, sizeof north);
    memcpy((float *)out + GREY_ROWS, &south, sizeof south);
}

/* The same for GREY_ROWS pairs of rows from j on; the number of pairs is a multiple of that. */
INLINE void read_grey_waves(const synthesis *job, uint32_t j, float8 *re, float8 *im)
{
    const uint32_t pair_count = job->desc->degree;
    for (uint32_t m = 0; m <= job->desc->degree; m++) {
        const float *even = job->in->spectra + harmonics_spectrum_index(m, 0, 0, pair_count) + j;
        const float *odd = job->in->spectra + harmonics_spectrum_index(m, 1, 0, pair_count) + j;
        join_parities(even, odd, &re[m]);
        join_parities(even + pair_count, odd + pair_count, &im[m]);
    }
}

/* Stores lanes of the transformed row as row y of the grid. */
INLINE void store_grid_row(const synthesis *job, const float8 *row, uint32_t y, const uint32_t lanes[3])
{
    const rgbx mean = {job->in->mean[0], job->in->mean[1], job->in->mean[2], 0.0f};
    const int width = (int)job->width;
    rgbx *out = grid_texel(job, 0, (int)y);
    for (int x = 0; x < width; x++)
        out[x] = (rgbx){row[x][lanes[0]], row[x][lanes[1]], row[x][lanes[2]], 0.0f} + mean;
    for (int x = 1; x <= PAD; x++) {
        out[-x] = out[width - x];
        out[width + x - 1] = out[x - 1];
    }
}

/* Items are pairs of rows, or groups of GREY_ROWS of them. */
DISPATCH_AVX2 static void synthesise_rows(void *context, size_t begin, size_t end)
{
    static const uint32_t north[3] = {0, 1, 2}, south[3] = {4, 5, 6};
    const synthesis *job = context;
    float8 row[FOURIER_MAX], re[FOURIER_MAX / 2], im[FOURIER_MAX / 2];
    size_t used = (job->desc->degree + 1) * sizeof *re;
    memset((char *)re + used, 0, job->width / 2 * sizeof *re - used);
    memset((char *)im + used, 0, job->width / 2 * sizeof *im - used);
    for (uint32_t j = (uint32_t)begin; j < (uint32_t)end; j++) {
        if (!job->in->is_grey) {
            read_waves(job, j, re, im);
            fourier_backward(&job->transform, re, im, row);
            store_grid_row(job, row, j, north);
            store_grid_row(job, row, job->height - 1 - j, south);
            continue;
        }
        read_grey_waves(job, GREY_ROWS * j, re, im);
        fourier_backward(&job->transform, re, im, row);
        for (uint32_t i = 0; i < GREY_ROWS; i++) {
            const uint32_t above[3] = {i, i, i}, below[3] = {GREY_ROWS + i, GREY_ROWS + i, GREY_ROWS + i};
            store_grid_row(job, row, GREY_ROWS * j + i, above);
            store_grid_row(job, row, job->height - 1 - (GREY_ROWS * j + i), below);
        }
    }
}

/* Rows continue beyond a pole, shifted by half a turn. */
static void fill_poles(const synthesis *job)
{
    int width = (int)job->width;
    int height = (int)job->height;
    for (int k = 1; k <= PAD; k++)
        for (int x = -PAD; x < width + PAD; x++) {
            int across = (x + width + width / 2) % width;
            *grid_texel(job, x, -k) = *grid_texel(job, across, k - 1);
            *grid_texel(job, x, height + k - 1) = *grid_texel(job, across, height - k);
        }
}

/* Weights of four samples at fraction f between the middle two (Catmull and Rom 1974). */
static inline void cubic_weights(float f, float w[4])
{
    w[0] = f * (-0.5f + f * (1.0f - 0.5f * f));
    w[1] = 1.0f + f * f * (1.5f * f - 2.5f);
    w[2] = f * (0.5f + f * (2.0f - 1.5f * f));
    w[3] = f * f * (0.5f * f - 0.5f);
}

/* Bicubic lookup at (u, v) from the padded corner of the grid. */
INLINE rgbx interpolate(const synthesis *job, float u, float v)
{
    size_t stride = (size_t)job->width + 2 * PAD;
    int u0 = (int)u;
    int v0 = (int)v;
    float wu[4], wv[4];
    cubic_weights(u - (float)u0, wu);
    cubic_weights(v - (float)v0, wv);
    const rgbx *g = job->in->grid + (size_t)(v0 - 1) * stride + (size_t)(u0 - 1);
    rgbx sum = {0};
    for (int k = 0; k < 4; k++, g += stride)
        sum += (g[0] * wu[0] + g[1] * wu[1] + g[2] * wu[2] + g[3] * wu[3]) * wv[k];
    return sum;
}

enum { CHUNK = 256 }; /* texels of a row at a time */

DISPATCH_AVX2 static void fill_cube_rows(void *context, size_t begin, size_t end)
{
    const synthesis *job = context;
    uint32_t size = job->out->size;
    float columns_per_rad = (float)job->width * 0.159154943f;
    float rows_per_rad = (float)job->height * 0.318309886f;
    const rgbx least = {job->in->least[0], job->in->least[1], job->in->least[2], 0.0f};
    for (size_t i = begin; i < end; i++) {
        uint32_t face = (uint32_t)(i / size);
        uint32_t y = (uint32_t)(i % size);
        double d0[3], d1[3];
        cube_direction(face, -1.0, (2.0 * y + 1.0) / size - 1.0, d0);
        cube_direction(face, 1.0, (2.0 * y + 1.0) / size - 1.0, d1);
        float from[3], step[3];
        for (int k = 0; k < 3; k++) {
            step[k] = (float)((d1[k] - d0[k]) / size);
            from[k] = (float)d0[k] + 0.5f * step[k];
        }
        for (uint32_t x0 = 0; x0 < size; x0 += CHUNK) {
            uint32_t count = size - x0 < CHUNK ? size - x0 : CHUNK;
            float u[CHUNK], v[CHUNK];
            for (uint32_t x = 0; x < count; x++) {
                float dx = from[0] + (float)(x0 + x) * step[0];
                float dy = from[1] + (float)(x0 + x) * step[1];
                float dz = from[2] + (float)(x0 + x) * step[2];
                u[x] = (equirect_atan2(dz, dx) + 3.14159265f) * columns_per_rad + (PAD - 0.5f);
                v[x] = equirect_atan2(sqrtf(dx * dx + dz * dz), dy) * rows_per_rad + (PAD - 0.5f);
            }
            rgbx *out = cube_texel(job->out, face, (int)x0, (int)y);
            for (uint32_t x = 0; x < count; x++)
                out[x] = rgbx_max(interpolate(job, u[x], v[x]), least) * job->desc->scale;
        }
    }
}

/* Allocates h->spectra and h->grid as needed. */
static facet_result create_scratch(harmonics *h, size_t spectrum_count, size_t grid_count, facet_error *error)
{
    if (h->spectrum_count >= spectrum_count && h->grid_count >= grid_count)
        return FACET_OK;
    harmonics_trim(h);
    h->spectra = mem_alloc(&h->allocator, spectrum_count, sizeof *h->spectra);
    h->grid = mem_alloc(&h->allocator, grid_count, sizeof *h->grid);
    if (!h->spectra || !h->grid) {
        harmonics_trim(h);
        return fail_memory(error, "filtered environment", grid_count * sizeof *h->grid);
    }
    h->spectrum_count = spectrum_count;
    h->grid_count = grid_count;
    return FACET_OK;
}

facet_result harmonics_filter(harmonics *h, const harmonics_filter_desc *desc, cube *out, facet_error *error)
{
    *out = (cube){0};
    uint32_t degree = desc->degree;
    synthesis job = {.in = h, .desc = desc, .width = column_count(degree), .height = 2 * degree, .out = out};
    TRY(create_scratch(h, harmonics_spectrum_index(degree + 1, 0, 0, degree),
                       ((size_t)job.height + 2 * PAD) * ((size_t)job.width + 2 * PAD), error));
    TRY(cube_create(desc->size, desc->allocator, out, error));
    fourier_init(&job.transform, job.width);
    legendre_place(&job.rows, 0, degree, job.height);
    parallel_for(desc->thread_count, degree + 1, 4, synthesise_orders, &job);
    parallel_for(desc->thread_count, h->is_grey ? degree / GREY_ROWS : degree, h->is_grey ? 8 / GREY_ROWS : 8,
                 synthesise_rows, &job);
    fill_poles(&job);
    parallel_for(desc->thread_count, 6 * (size_t)desc->size, 16, fill_cube_rows, &job);
    cube_fill_borders(out);
    return FACET_OK;
}
