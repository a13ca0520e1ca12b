/* harmonics.c - see harmonics.h. A grid of 2 L rows and at least 3 L columns for degree L: Fourier transform of each
 * row, then for each order m sums over rows against the associated Legendre functions, and back the same way. A row and
 * its mirror at the equator share their Legendre functions: P_lm(-x) = (-1)^(l - m) P_lm(x), so what is summed is
 * the even part (row + mirror) where l - m is even and the odd part (row - mirror) where it is odd. */
#include "ibl/harmonics.h"

#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "base/parallel.h"
#include "base/result.h"
#include "ibl/equirect.h"
#include "ibl/fourier.h"

static const double pi = 3.14159265358979323846;

enum {
    PARTS = 6, /* R G B, real and imaginary */
    LANES = 8, /* of float8 */
    MAX_BLOCKS = HARMONICS_DEGREE / LANES,
    PAD = 2 /* texels around the grid, for cubic interpolation */
};

/* Columns of the grid: a power of two that keeps degree away from half of it, so that what a picture has above is
 * not mistaken for what is below. */
static uint32_t column_count(uint32_t degree)
{
    uint32_t count = 16;
    while (count < 3 * degree)
        count *= 2;
    return count;
}

/* Rows of coefficients in both directions: [order][even odd][PARTS][pair]. */
static size_t wave_index(uint32_t order, uint32_t is_odd, uint32_t part, uint32_t pair_count)
{
    return (((size_t)order * 2 + is_odd) * PARTS + part) * pair_count;
}

static size_t order_index(uint32_t order)
{
    return PARTS * ((size_t)order * (HARMONICS_DEGREE + 1) - (size_t)order * (order - 1) / 2);
}

static size_t coefficient_count(void)
{
    return order_index(HARMONICS_DEGREE) + PARTS;
}

/* ---- associated Legendre functions, orthonormal: integral of (P_lm(x))^2 dx = 1 / 2 pi ---- */

/* P_lm = a[l] (x P_(l-1)m - b[l] P_(l-2)m), from P_mm on. */
typedef struct legendre {
    uint32_t first_block, block_count; /* blocks of rows; before the first, all P_lm are next to 0 */
    float a[HARMONICS_DEGREE + 1], b[HARMONICS_DEGREE + 1];
    float8 x[MAX_BLOCKS];     /* cos(theta) of the rows of the northern hemisphere */
    float8 start[MAX_BLOCKS]; /* P_mm */
} legendre;

static double power(double x, uint32_t n)
{
    double result = 1.0;
    for (; n; n >>= 1, x *= x)
        if (n & 1)
            result *= x;
    return result;
}

static void legendre_init(legendre *p, uint32_t order, uint32_t degree, uint32_t pair_count)
{
    double m = order;
    /* P_lm falls off like an Airy function where l sin(theta) < m; 6 m^(1/3) further it is below 1e-6 of its top */
    p->block_count = pair_count / LANES;
    p->first_block = 0;
    while (p->first_block + 1 < p->block_count &&
           (degree + 1) * sin(pi * ((p->first_block + 1) * LANES - 0.5) / (2.0 * pair_count)) <
               m - 6.0 * cbrt(m))
        p->first_block++;
    for (uint32_t l = order + 1; l <= degree; l++) {
        double l2 = (double)l * l;
        double k2 = (double)(l - 1) * (l - 1);
        p->a[l] = (float)sqrt((4.0 * l2 - 1.0) / (l2 - m * m));
        p->b[l] = (float)sqrt((k2 - m * m) / (4.0 * k2 - 1.0));
    }
    double norm = 1.0 / sqrt(4.0 * pi);
    for (uint32_t k = 1; k <= order; k++)
        norm *= sqrt((2.0 * k + 1.0) / (2.0 * k));
    for (uint32_t j = p->first_block * LANES; j < pair_count; j++) {
        double theta = pi * (j + 0.5) / (2.0 * pair_count);
        double start = norm * power(sin(theta), order);
        p->x[j / LANES][j % LANES] = (float)cos(theta);
        /* P_lm comes to anything from l sin(theta) = m on, and for l up to 160 P_mm is then above 1e-26: what is
         * far below never grows. Zero keeps slow denormal numbers out. */
        p->start[j / LANES][j % LANES] = start < 1e-32 ? 0.0f : (float)start;
    }
}

/* ---- analysis ---- */

typedef struct analysis {
    const equirect_view *view;
    harmonics *out;
    fourier transform;
} analysis;

/* Rows j and their mirrors: waves, not yet less the mean. */
DISPATCH_AVX2 static void analyse_rows(void *context, size_t begin, size_t end)
{
    const analysis *job = context;
    uint32_t pair_count = HARMONICS_DEGREE;
    uint32_t width = job->view->width;
    for (size_t j = begin; j < end; j++) {
        float weight = (float)equirect_texel_solid_angle(width, job->view->height, (uint32_t)j);
        rgbx north[FOURIER_MAX], south[FOURIER_MAX];
        float8 row[FOURIER_MAX], re[FOURIER_MAX / 2], im[FOURIER_MAX / 2];
        equirect_view_texels(job->view, (uint32_t)j, 0, width, north);
        equirect_view_texels(job->view, job->view->height - 1 - (uint32_t)j, 0, width, south);
        for (uint32_t x = 0; x < width; x++) {
            rgbx n = north[x] * weight;
            rgbx s = south[x] * weight;
            row[x] = (float8){n[0], n[1], n[2], 0.0f, s[0], s[1], s[2], 0.0f};
        }
        fourier_forward(&job->transform, row, re, im);
        for (uint32_t m = 0; m <= HARMONICS_DEGREE; m++)
            for (uint32_t i = 0; i < 3; i++) {
                float *even = job->out->waves + wave_index(m, 0, 2 * i, pair_count) + j;
                float *odd = job->out->waves + wave_index(m, 1, 2 * i, pair_count) + j;
                even[0] = re[m][i] + re[m][i + 4];
                odd[0] = re[m][i] - re[m][i + 4];
                even[pair_count] = im[m][i] + im[m][i + 4];
                odd[pair_count] = im[m][i] - im[m][i + 4];
            }
    }
}

/* Takes the mean over the sphere out of the waves. */
static void remove_mean(harmonics *h)
{
    uint32_t pair_count = HARMONICS_DEGREE;
    uint32_t width = column_count(HARMONICS_DEGREE);
    for (uint32_t i = 0; i < 3; i++) {
        float *even = h->waves + wave_index(0, 0, 2 * i, pair_count);
        double sum = 0.0;
        for (uint32_t j = 0; j < pair_count; j++)
            sum += (double)even[j];
        double mean = sum / (4.0 * pi);
        for (uint32_t j = 0; j < pair_count; j++)
            even[j] -= (float)(2.0 * width * mean * equirect_texel_solid_angle(width, 2 * pair_count, j));
        h->mean[i] = (float)mean;
    }
}

DISPATCH_AVX2 static void analyse_orders(void *context, size_t begin, size_t end)
{
    const harmonics *h = context;
    for (size_t order = begin; order < end; order++) {
        uint32_t m = (uint32_t)order;
        legendre p;
        legendre_init(&p, m, HARMONICS_DEGREE, HARMONICS_DEGREE);
        float *out = h->coefficients + order_index(m);
        float8 now[MAX_BLOCKS], before[MAX_BLOCKS];
        memcpy(now, p.start, sizeof now);
        memset(before, 0, sizeof before);
        for (uint32_t l = m; l <= HARMONICS_DEGREE; l++, out += PARTS) {
            if (l > m) {
                for (uint32_t k = p.first_block; k < MAX_BLOCKS; k++) {
                    float8 next = (p.x[k] * now[k] - before[k] * p.b[l]) * p.a[l];
                    before[k] = now[k];
                    now[k] = next;
                }
            }
            const float8 *wave = (const float8 *)(h->waves + wave_index(m, (l - m) & 1, 0, HARMONICS_DEGREE));
            float8 sum[PARTS] = {{0}};
            for (uint32_t k = p.first_block; k < MAX_BLOCKS; k++)
                for (uint32_t part = 0; part < PARTS; part++)
                    sum[part] += now[k] * wave[part * MAX_BLOCKS + k];
            for (uint32_t part = 0; part < PARTS; part++) {
                float8 s = sum[part];
                out[part] = ((s[0] + s[1]) + (s[2] + s[3])) + ((s[4] + s[5]) + (s[6] + s[7]));
            }
        }
    }
}

static facet_result create_scratch(harmonics *h, facet_error *error)
{
    uint32_t degree = HARMONICS_DEGREE;
    size_t wave_count = wave_index(degree + 1, 0, 0, degree);
    size_t grid_count = (2 * (size_t)degree + 2 * PAD) * ((size_t)column_count(degree) + 2 * PAD);
    if (!h->waves)
        h->waves = mem_alloc(&h->allocator, wave_count, sizeof *h->waves);
    if (!h->grid)
        h->grid = mem_alloc(&h->allocator, grid_count, sizeof *h->grid);
    return h->waves && h->grid ? FACET_OK
                               : fail_memory(error, "filtered environment", grid_count * sizeof *h->grid);
}

void harmonics_trim(harmonics *h)
{
    mem_free(h->waves);
    mem_free(h->grid);
    h->waves = NULL;
    h->grid = NULL;
}

facet_result harmonics_create(const image *picture, const facet_allocator *allocator, uint32_t thread_count,
                              harmonics *out, facet_error *error)
{
    *out = (harmonics){0};
    harmonics h = {.coefficients = mem_alloc(allocator, coefficient_count(), sizeof(float))};
    h.allocator = allocator ? *allocator : h.allocator;
    equirect_view view = {0};
    facet_result result = create_scratch(&h, error);
    if (result == FACET_OK &&
        (!h.coefficients || !equirect_view_create(picture, column_count(HARMONICS_DEGREE),
                                                  2 * HARMONICS_DEGREE, allocator, &view)))
        result = fail_memory(error, "harmonics", coefficient_count() * sizeof(float));
    if (result == FACET_OK) {
        analysis job = {.view = &view, .out = &h};
        fourier_init(&job.transform, view.width);
        parallel_for(thread_count, HARMONICS_DEGREE, 16, analyse_rows, &job);
        remove_mean(&h);
        parallel_for(thread_count, HARMONICS_DEGREE + 1, 4, analyse_orders, &h);
        *out = h;
    } else {
        harmonics_destroy(&h);
    }
    equirect_view_destroy(&view);
    return result;
}

void harmonics_destroy(harmonics *h)
{
    harmonics_trim(h);
    mem_free(h->coefficients);
    *h = (harmonics){0};
}

/* ---- synthesis ---- */

typedef struct synthesis {
    const harmonics *in;
    const float *kernel;
    uint32_t degree;
    double rotation_rad;
    uint32_t width, height; /* of the grid, which has PAD more texels on all sides */
    fourier transform;
    cube *out;
} synthesis;

static rgbx *grid_texel(const synthesis *job, int x, int y)
{
    return job->in->grid + (size_t)(y + PAD) * (job->width + 2 * PAD) + (size_t)(x + PAD);
}

DISPATCH_AVX2 static void synthesise_orders(void *context, size_t begin, size_t end)
{
    const synthesis *job = context;
    uint32_t pair_count = job->degree;
    for (size_t order = begin; order < end; order++) {
        uint32_t m = (uint32_t)order;
        legendre p;
        legendre_init(&p, m, job->degree, pair_count);
        /* middles of columns of the grid of the analysis and of this one lie half a column off phi = 0 */
        double turn =
            m * (job->rotation_rad + pi * (1.0 / job->width - 1.0 / column_count(HARMONICS_DEGREE)));
        float c = (float)cos(turn);
        float s = (float)sin(turn);
        float scaled[HARMONICS_DEGREE + 1][PARTS];
        const float *in = job->in->coefficients + order_index(m);
        for (uint32_t l = m; l <= job->degree; l++, in += PARTS)
            for (int i = 0; i < 3; i++) {
                scaled[l][2 * i] = job->kernel[l] * (in[2 * i] * c - in[2 * i + 1] * s);
                scaled[l][2 * i + 1] = job->kernel[l] * (in[2 * i] * s + in[2 * i + 1] * c);
            }
        for (uint32_t k = 0; k < p.block_count; k++) {
            float8 even[PARTS] = {{0}};
            float8 odd[PARTS] = {{0}};
            float8 now = p.start[k];
            float8 before = {0};
            for (uint32_t l = m; k >= p.first_block && l <= job->degree; l += 2) {
                for (uint32_t part = 0; part < PARTS; part++)
                    even[part] += now * scaled[l][part];
                if (l == job->degree)
                    break;
                before = (p.x[k] * now - before * p.b[l + 1]) * p.a[l + 1];
                for (uint32_t part = 0; part < PARTS; part++)
                    odd[part] += before * scaled[l + 1][part];
                if (l + 2 <= job->degree)
                    now = (p.x[k] * before - now * p.b[l + 2]) * p.a[l + 2];
            }
            for (uint32_t part = 0; part < PARTS; part++) {
                float *to = job->in->waves + wave_index(m, 0, part, pair_count) + (size_t)k * LANES;
                memcpy(to, &even[part], sizeof even[part]);
                to = job->in->waves + wave_index(m, 1, part, pair_count) + (size_t)k * LANES;
                memcpy(to, &odd[part], sizeof odd[part]);
            }
        }
    }
}

DISPATCH_AVX2 static void synthesise_rows(void *context, size_t begin, size_t end)
{
    const synthesis *job = context;
    uint32_t pair_count = job->degree;
    int width = (int)job->width;
    rgbx mean = {job->in->mean[0], job->in->mean[1], job->in->mean[2], 0.0f};
    for (size_t j = begin; j < end; j++) {
        float8 row[FOURIER_MAX];
        float8 re[FOURIER_MAX / 2] = {{0}};
        float8 im[FOURIER_MAX / 2] = {{0}};
        for (uint32_t m = 0; m <= job->degree; m++) {
            float e[PARTS], o[PARTS];
            for (uint32_t part = 0; part < PARTS; part++) {
                e[part] = job->in->waves[wave_index(m, 0, part, pair_count) + j];
                o[part] = job->in->waves[wave_index(m, 1, part, pair_count) + j];
            }
            re[m] = (float8){e[0] + o[0], e[2] + o[2], e[4] + o[4], 0.0f,
                             e[0] - o[0], e[2] - o[2], e[4] - o[4], 0.0f};
            im[m] = (float8){e[1] + o[1], e[3] + o[3], e[5] + o[5], 0.0f,
                             e[1] - o[1], e[3] - o[3], e[5] - o[5], 0.0f};
        }
        fourier_backward(&job->transform, re, im, row);
        rgbx *north = grid_texel(job, 0, (int)j);
        rgbx *south = grid_texel(job, 0, (int)job->height - 1 - (int)j);
        for (int x = 0; x < width; x++) {
            north[x] = (rgbx){row[x][0], row[x][1], row[x][2], 0.0f} + mean;
            south[x] = (rgbx){row[x][4], row[x][5], row[x][6], 0.0f} + mean;
        }
        for (int x = 1; x <= PAD; x++) {
            north[-x] = north[width - x];
            north[width + x - 1] = north[x - 1];
            south[-x] = south[width - x];
            south[width + x - 1] = south[x - 1];
        }
    }
}

/* Behind a pole comes the same row half a turn on. */
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

/* Weights of four samples around a point at fraction f between the middle two (Catmull and Rom 1974). */
static inline void cubic_weights(float f, float w[4])
{
    w[0] = f * (-0.5f + f * (1.0f - 0.5f * f));
    w[1] = 1.0f + f * f * (1.5f * f - 2.5f);
    w[2] = f * (0.5f + f * (2.0f - 1.5f * f));
    w[3] = f * f * (0.5f * f - 0.5f);
}

/* The grid at (u, v) from its padded corner. */
static inline __attribute__((always_inline)) rgbx interpolate(const synthesis *job, float u, float v)
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
    return rgbx_not_negative(sum);
}

enum { CHUNK = 256 }; /* texels of a row at a time */

DISPATCH_AVX2 static void fill_cube_rows(void *context, size_t begin, size_t end)
{
    const synthesis *job = context;
    uint32_t size = job->out->size;
    float columns_per_rad = (float)job->width * 0.159154943f;
    float rows_per_rad = (float)job->height * 0.318309886f;
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
                out[x] = interpolate(job, u[x], v[x]);
        }
    }
}

facet_result harmonics_filter(harmonics *h, const float *kernel, uint32_t degree, double rotation_rad,
                              uint32_t size, const facet_allocator *allocator, uint32_t thread_count,
                              cube *out, facet_error *error)
{
    facet_result result = create_scratch(h, error);
    if (result == FACET_OK)
        result = cube_create(size, allocator, out, error);
    if (result != FACET_OK)
        return result;
    synthesis job = {.in = h,
                     .kernel = kernel,
                     .degree = degree,
                     .rotation_rad = rotation_rad,
                     .width = column_count(degree),
                     .height = 2 * degree,
                     .out = out};
    fourier_init(&job.transform, job.width);
    parallel_for(thread_count, degree + 1, 4, synthesise_orders, &job);
    parallel_for(thread_count, degree, 8, synthesise_rows, &job);
    fill_poles(&job);
    parallel_for(thread_count, 6 * (size_t)size, 16, fill_cube_rows, &job);
    cube_fill_borders(out);
    return FACET_OK;
}
