/* harmonics.c - see harmonics.h. A grid of 2 L rows and 4 L columns for degree L: Fourier transform of each row,
 * then for each order m sums over rows against the associated Legendre functions, and back the same way. A row and
 * its mirror at the equator share their Legendre functions: P_lm(-x) = (-1)^(l - m) P_lm(x), so what is summed is
 * the even part (row + mirror) where l - m is even and the odd part (row - mirror) where it is odd. */
#include "ibl/harmonics.h"

#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "base/parallel.h"
#include "base/result.h"
#include "ibl/fourier.h"

static const double pi = 3.14159265358979323846;

enum {
    PARTS = 6,                    /* R G B, real and imaginary */
    LANES = 8,                    /* of float8 */
    MAX_PAIRS = HARMONICS_DEGREE, /* rows of a hemisphere */
    MAX_BLOCKS = MAX_PAIRS / LANES
};

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
    uint32_t order, block_count;
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
    p->order = order;
    p->block_count = pair_count / LANES;
    double m = order;
    for (uint32_t l = order + 1; l <= degree; l++) {
        double l2 = (double)l * l;
        double k2 = (double)(l - 1) * (l - 1);
        p->a[l] = (float)sqrt((4.0 * l2 - 1.0) / (l2 - m * m));
        p->b[l] = (float)sqrt((k2 - m * m) / (4.0 * k2 - 1.0));
    }
    double norm = 1.0 / sqrt(4.0 * pi);
    for (uint32_t k = 1; k <= order; k++)
        norm *= sqrt((2.0 * k + 1.0) / (2.0 * k));
    for (uint32_t j = 0; j < pair_count; j++) {
        double theta = pi * (j + 0.5) / (2.0 * pair_count);
        double start = norm * power(sin(theta), order);
        p->x[j / LANES][j % LANES] = (float)cos(theta);
        /* Near the poles high orders vanish: of degree l they come to anything from l sin(theta) = m on, and for l
         * up to 128 P_mm is then above 1e-21. Zero keeps slow denormal numbers out. */
        p->start[j / LANES][j % LANES] = start < 1e-30 ? 0.0f : (float)start;
    }
}

/* ---- analysis ---- */

typedef struct analysis {
    const equirect *grid;
    harmonics *out;
    fourier transform;
    float *waves;
} analysis;

IBL_DISPATCH static void analyse_rows(void *context, size_t begin, size_t end)
{
    const analysis *job = context;
    uint32_t pair_count = HARMONICS_DEGREE;
    uint32_t width = job->grid->width;
    const float *mean = job->out->mean;
    for (size_t j = begin; j < end; j++) {
        float weight = (float)equirect_texel_solid_angle(width, job->grid->height, (uint32_t)j);
        rgbx row[FOURIER_MAX], re[2][FOURIER_MAX / 2], im[2][FOURIER_MAX / 2];
        for (int south = 0; south < 2; south++) {
            const rgbx *from =
                job->grid->texels + (south ? job->grid->height - 1 - j : j) * ((size_t)width + 1);
            rgbx offset = {mean[0], mean[1], mean[2], 0.0f};
            for (uint32_t x = 0; x < width; x++)
                row[x] = (from[x] - offset) * weight;
            fourier_forward(&job->transform, row, re[south], im[south]);
        }
        for (uint32_t m = 0; m <= HARMONICS_DEGREE; m++)
            for (uint32_t odd = 0; odd < 2; odd++) {
                float sign = odd ? -1.0f : 1.0f;
                rgbx sum_re = re[0][m] + re[1][m] * sign;
                rgbx sum_im = im[0][m] + im[1][m] * sign;
                for (uint32_t i = 0; i < 3; i++) {
                    job->waves[wave_index(m, odd, 2 * i, pair_count) + j] = sum_re[i];
                    job->waves[wave_index(m, odd, 2 * i + 1, pair_count) + j] = sum_im[i];
                }
            }
    }
}

IBL_DISPATCH static void analyse_orders(void *context, size_t begin, size_t end)
{
    const analysis *job = context;
    for (size_t m = begin; m < end; m++) {
        legendre p;
        legendre_init(&p, (uint32_t)m, HARMONICS_DEGREE, HARMONICS_DEGREE);
        float *out = job->out->coefficients + order_index((uint32_t)m);
        float8 now[MAX_BLOCKS], before[MAX_BLOCKS];
        memcpy(now, p.start, sizeof now);
        memset(before, 0, sizeof before);
        for (uint32_t l = (uint32_t)m; l <= HARMONICS_DEGREE; l++, out += PARTS) {
            if (l > m) {
                for (uint32_t k = 0; k < MAX_BLOCKS; k++) {
                    float8 next = (p.x[k] * now[k] - before[k] * p.b[l]) * p.a[l];
                    before[k] = now[k];
                    now[k] = next;
                }
            }
            const float *wave =
                job->waves + wave_index((uint32_t)m, (l - (uint32_t)m) & 1, 0, HARMONICS_DEGREE);
            const float8 *w = (const float8 *)wave;
            for (uint32_t part = 0; part < PARTS; part++, w += MAX_BLOCKS) {
                float8 sum = now[0] * w[0];
                for (uint32_t k = 1; k < MAX_BLOCKS; k++)
                    sum += now[k] * w[k];
                out[part] = ((sum[0] + sum[1]) + (sum[2] + sum[3])) + ((sum[4] + sum[5]) + (sum[6] + sum[7]));
            }
        }
    }
}

facet_result harmonics_create(const image *picture, const facet_allocator *allocator, uint32_t thread_count,
                              harmonics *out, facet_error *error)
{
    *out = (harmonics){0};
    equirect grid;
    facet_result result = equirect_create(picture, 4 * HARMONICS_DEGREE, 2 * HARMONICS_DEGREE, false,
                                          allocator, thread_count, &grid, error);
    if (result != FACET_OK)
        return result;
    size_t wave_count = wave_index(HARMONICS_DEGREE + 1, 0, 0, HARMONICS_DEGREE);
    harmonics h = {.coefficients = mem_alloc(allocator, coefficient_count(), sizeof(float))};
    analysis job = {.grid = &grid, .out = &h, .waves = mem_alloc(allocator, wave_count, sizeof(float))};
    if (!h.coefficients || !job.waves) {
        result = fail_memory(error, "harmonics", wave_count * sizeof(float));
        mem_free(h.coefficients);
    } else {
        equirect_mean(&grid, h.mean);
        fourier_init(&job.transform, grid.width);
        parallel_for(thread_count, HARMONICS_DEGREE, 16, analyse_rows, &job);
        parallel_for(thread_count, HARMONICS_DEGREE + 1, 4, analyse_orders, &job);
        *out = h;
    }
    mem_free(job.waves);
    equirect_destroy(&grid);
    return result;
}

void harmonics_destroy(harmonics *h)
{
    mem_free(h->coefficients);
    *h = (harmonics){0};
}

/* ---- synthesis ---- */

enum { PAD = 2 }; /* texels around the grid, for cubic interpolation */

typedef struct synthesis {
    const harmonics *in;
    const float *kernel;
    uint32_t degree;
    fourier transform;
    float *waves;
    rgbx *grid; /* 2 degree rows of 4 degree texels, PAD more on all sides */
    cube *out;
} synthesis;

static rgbx *grid_texel(const synthesis *job, int x, int y)
{
    size_t stride = 4 * (size_t)job->degree + 2 * PAD;
    return job->grid + (size_t)(y + PAD) * stride + (size_t)(x + PAD);
}

IBL_DISPATCH static void synthesise_orders(void *context, size_t begin, size_t end)
{
    const synthesis *job = context;
    uint32_t pair_count = job->degree;
    for (size_t order = begin; order < end; order++) {
        uint32_t m = (uint32_t)order;
        legendre p;
        legendre_init(&p, m, job->degree, pair_count);
        /* middles of columns of the grid of the analysis and of this one lie half a column off phi = 0 */
        double turn = m * pi * (1.0 / (4.0 * job->degree) - 1.0 / (4.0 * HARMONICS_DEGREE));
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
            float8 sum[2][PARTS] = {{{0}}};
            float8 now = p.start[k];
            float8 before = {0};
            for (uint32_t l = m; l <= job->degree; l++) {
                if (l > m) {
                    float8 next = (p.x[k] * now - before * p.b[l]) * p.a[l];
                    before = now;
                    now = next;
                }
                for (uint32_t part = 0; part < PARTS; part++)
                    sum[(l - m) & 1][part] += now * scaled[l][part];
            }
            for (uint32_t odd = 0; odd < 2; odd++)
                for (uint32_t part = 0; part < PARTS; part++) {
                    float *to = job->waves + wave_index(m, odd, part, pair_count) + (size_t)k * LANES;
                    memcpy(to, &sum[odd][part], sizeof sum[odd][part]);
                }
        }
    }
}

IBL_DISPATCH static void synthesise_rows(void *context, size_t begin, size_t end)
{
    const synthesis *job = context;
    uint32_t pair_count = job->degree;
    int width = (int)(4 * job->degree);
    rgbx mean = {job->in->mean[0], job->in->mean[1], job->in->mean[2], 0.0f};
    for (size_t j = begin; j < end; j++)
        for (int south = 0; south < 2; south++) {
            rgbx re[FOURIER_MAX / 2] = {{0}};
            rgbx im[FOURIER_MAX / 2] = {{0}};
            float sign = south ? -1.0f : 1.0f;
            for (uint32_t m = 0; m <= job->degree; m++)
                for (uint32_t i = 0; i < 3; i++) {
                    const float *even = job->waves + wave_index(m, 0, 2 * i, pair_count) + j;
                    const float *odd = job->waves + wave_index(m, 1, 2 * i, pair_count) + j;
                    re[m][i] = even[0] + sign * odd[0];
                    im[m][i] = even[pair_count] + sign * odd[pair_count];
                }
            rgbx *row = grid_texel(job, 0, south ? 2 * (int)job->degree - 1 - (int)j : (int)j);
            fourier_backward(&job->transform, re, im, row);
            for (int x = 0; x < width; x++)
                row[x] += mean;
            for (int x = 1; x <= PAD; x++) {
                row[-x] = row[width - x];
                row[width + x - 1] = row[x - 1];
            }
        }
}

/* Behind a pole comes the same row half a turn on. */
static void fill_poles(const synthesis *job)
{
    int height = 2 * (int)job->degree;
    int width = 4 * (int)job->degree;
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

IBL_DISPATCH static void fill_cube_rows(void *context, size_t begin, size_t end)
{
    const synthesis *job = context;
    uint32_t size = job->out->size;
    float columns_per_rad = (float)(4 * job->degree) * 0.159154943f;
    size_t stride = 4 * (size_t)job->degree + 2 * PAD;
    for (size_t i = begin; i < end; i++) {
        uint32_t face = (uint32_t)(i / size);
        uint32_t y = (uint32_t)(i % size);
        for (uint32_t x = 0; x < size; x++) {
            double d[3];
            cube_direction(face, (2.0 * x + 1.0) / size - 1.0, (2.0 * y + 1.0) / size - 1.0, d);
            float across = sqrtf((float)(d[0] * d[0] + d[2] * d[2]));
            float u =
                (equirect_atan2((float)d[2], (float)d[0]) + 3.14159265f) * columns_per_rad + (PAD - 0.5f);
            float v = equirect_atan2(across, (float)d[1]) * columns_per_rad + (PAD - 0.5f);
            int u0 = (int)u;
            int v0 = (int)v;
            float wu[4], wv[4];
            cubic_weights(u - (float)u0, wu);
            cubic_weights(v - (float)v0, wv);
            const rgbx *g = job->grid + (size_t)(v0 - 1) * stride + (size_t)(u0 - 1);
            rgbx sum = {0};
            for (int k = 0; k < 4; k++, g += stride)
                sum += (g[0] * wu[0] + g[1] * wu[1] + g[2] * wu[2] + g[3] * wu[3]) * wv[k];
            *cube_texel(job->out, face, (int)x, (int)y) = rgbx_not_negative(sum);
        }
    }
}

facet_result harmonics_filter(const harmonics *h, const float *kernel, uint32_t degree, uint32_t size,
                              const facet_allocator *allocator, uint32_t thread_count, cube *out,
                              facet_error *error)
{
    facet_result result = cube_create(size, allocator, out, error);
    if (result != FACET_OK)
        return result;
    size_t wave_count = wave_index(degree + 1, 0, 0, degree);
    size_t grid_count = (2 * (size_t)degree + 2 * PAD) * (4 * (size_t)degree + 2 * PAD);
    synthesis job = {.in = h,
                     .kernel = kernel,
                     .degree = degree,
                     .waves = mem_alloc(allocator, wave_count, sizeof(float)),
                     .grid = mem_alloc(allocator, grid_count, sizeof(rgbx)),
                     .out = out};
    if (!job.waves || !job.grid) {
        cube_destroy(out);
        result = fail_memory(error, "filtered environment", grid_count * sizeof(rgbx));
    } else {
        fourier_init(&job.transform, 4 * degree);
        parallel_for(thread_count, degree + 1, 4, synthesise_orders, &job);
        parallel_for(thread_count, degree, 8, synthesise_rows, &job);
        fill_poles(&job);
        parallel_for(thread_count, 6 * (size_t)size, 16, fill_cube_rows, &job);
        cube_fill_borders(out);
    }
    mem_free(job.waves);
    mem_free(job.grid);
    return result;
}
