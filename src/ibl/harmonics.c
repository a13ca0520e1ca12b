/* harmonics.c - analysis: coefficients of a panorama, by a Fourier transform of each row and, for each order
 * m, sums over rows against associated Legendre functions.
 *
 * Texels have constant radiance. Along a row the integrals of e^(-i m phi) over texels are those at the
 * centers times sinc(m width / 2), exactly. Along a column f = P_lm sin(theta) obeys f'' = -k^2 f to first
 * order, with k^2 = l (l + 1) - m^2 / sin(theta)^2 by Legendre's equation, so the integral over a texel of
 * height d is its center value times 1 - k^2 d^2 / 24. */
#include "ibl/harmonics.h"

#include <float.h>
#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "base/parallel.h"
#include "base/result.h"
#include "ibl/equirect.h"
#include "ibl/harmonics_transform.h"

static const double pi = 3.14159265358979323846;

enum {
    PARTS = HARMONICS_PARTS,
    LANES = LEGENDRE_LANES,
    BAND_ROWS = 256, /* pairs of rows at a time: the spectra of an order fit the L1 cache */
    BAND_BLOCKS = BAND_ROWS / LANES,
    CHUNK = 256 /* texels on the stack */
};

typedef struct analysis {
    const equirect_view *view;
    harmonics *out;
    fourier transform;
    uint32_t splits;          /* transforms that make up that of a row */
    bool is_wider, is_higher; /* texels of the view cover several texels of the panorama, or parts of them */
    uint32_t first, count;    /* pairs of rows of the band */
    uint32_t capacity;        /* of pairs in the spectra: a multiple of LANES */
    legendre_rows rows;
} analysis;

/* ---- rows ---- */

/* Columns part, part + splits, .. of row y and its mirror row, minus the mean, weighted. */
static inline void read_split(const analysis *job, uint32_t y, uint32_t part, float8 *row)
{
    uint32_t width = job->view->width;
    uint32_t mirror = job->view->height - 1 - y;
    float weight = (float)equirect_texel_solid_angle(width, job->view->height, y);
    rgbx mean = {job->out->mean[0], job->out->mean[1], job->out->mean[2], 0.0f};
    for (uint32_t x0 = 0; x0 < width; x0 += CHUNK) {
        rgbx north[CHUNK], south[CHUNK];
        uint32_t count = width - x0 < CHUNK ? width - x0 : CHUNK;
        equirect_view_texels(job->view, y, x0, count, north);
        equirect_view_texels(job->view, mirror, x0, count, south);
        float8 *to = row + x0 / job->splits;
        for (uint32_t x = part; x < count; x += job->splits) {
            rgbx n = (north[x] - mean) * weight;
            rgbx s = (south[x] - mean) * weight;
            *to++ = (float8){n[0], n[1], n[2], 0.0f, s[0], s[1], s[2], 0.0f};
        }
    }
}

/* Adds the transform of one part: X[m] = sum over parts of e^(-2 pi i m part / width) X_part[m] (Cooley
 * and Tukey 1965). */
static inline void add_split(const analysis *job, uint32_t part, const float8 *re, const float8 *im,
                             float8 *sum_re, float8 *sum_im)
{
    double step = -2.0 * pi * part / job->view->width;
    for (uint32_t m = 0; m <= job->out->degree; m++) {
        float c = (float)cos(step * m);
        float s = (float)sin(step * m);
        sum_re[m] += re[m] * c - im[m] * s;
        sum_im[m] += re[m] * s + im[m] * c;
    }
}

/* Pairs of rows begin .. end - 1 of the band. */
DISPATCH_AVX2 static void analyse_rows(void *context, size_t begin, size_t end)
{
    const analysis *job = context;
    uint32_t degree = job->out->degree;
    float8 row[FOURIER_MAX], re[FOURIER_MAX / 2], im[FOURIER_MAX / 2];
    float8 sum_re[HARMONICS_MAX_DEGREE + 1], sum_im[HARMONICS_MAX_DEGREE + 1];
    for (size_t j = begin; j < end; j++) {
        const float8 *x_re = re;
        const float8 *x_im = im;
        read_split(job, job->first + (uint32_t)j, 0, row);
        fourier_forward(&job->transform, row, re, im);
        if (job->splits > 1) {
            memcpy(sum_re, re, (degree + 1) * sizeof *re);
            memcpy(sum_im, im, (degree + 1) * sizeof *im);
            for (uint32_t part = 1; part < job->splits; part++) {
                read_split(job, job->first + (uint32_t)j, part, row);
                fourier_forward(&job->transform, row, re, im);
                add_split(job, part, re, im, sum_re, sum_im);
            }
            x_re = sum_re;
            x_im = sum_im;
        }
        for (uint32_t m = 0; m <= degree; m++)
            for (uint32_t i = 0; i < 3; i++) {
                float *even = job->out->spectra + harmonics_spectrum_index(m, 0, 2 * i, job->capacity) + j;
                float *odd = job->out->spectra + harmonics_spectrum_index(m, 1, 2 * i, job->capacity) + j;
                even[0] = x_re[m][i] + x_re[m][i + 4];
                odd[0] = x_re[m][i] - x_re[m][i + 4];
                even[job->capacity] = x_im[m][i] + x_im[m][i + 4];
                odd[job->capacity] = x_im[m][i] - x_im[m][i + 4];
            }
    }
}

/* Rows that pad the last block. */
static void clear_fill(const analysis *job)
{
    for (uint32_t wave = 0; wave < 2 * PARTS * (job->out->degree + 1); wave++)
        for (uint32_t j = job->count; j % LANES; j++)
            job->out->spectra[(size_t)wave * job->capacity + j] = 0.0f;
}

/* ---- orders ---- */

/* Adds the band's contribution to the coefficients of each order. */
DISPATCH_AVX2 static void analyse_orders(void *context, size_t begin, size_t end)
{
    const analysis *job = context;
    const harmonics *h = job->out;
    uint32_t blocks = job->capacity / LANES;
    uint32_t block_count = job->rows.block_count;
    double height = pi / job->view->height;
    float curvature = (float)(height * height / 24.0) * (job->is_higher ? -1.0f : 1.0f);
    for (size_t order = begin; order < end; order++) {
        uint32_t m = (uint32_t)order;
        legendre p;
        legendre_init(&p, m, h->degree, &job->rows);
        double8 x[BAND_BLOCKS];
        float8 share[BAND_BLOCKS]; /* the part that does not depend on l */
        for (uint32_t k = 0; k < block_count; k++) {
            x[k] = job->rows.x[k];
            float8 s;
            legendre_floats(&job->rows.sine[k], &s);
            share[k] = 1.0f + curvature * (float)m * (float)m / (s * s);
        }
        double half = pi * m / job->view->width;
        float sinc = m ? (float)(sin(half) / half) : 1.0f;
        float scale = job->is_wider ? 1.0f / sinc : sinc;
        float *out = h->coefficients + harmonics_order_index(h->degree, m);
        uint32_t first = block_count;
        for (uint32_t l = m; l <= h->degree; l++, out += PARTS) {
            while (first > 0 && p.from[first - 1] <= l)
                first--;
            const float8 *wave =
                (const float8 *)(h->spectra + harmonics_spectrum_index(m, (l - m) & 1, 0, job->capacity));
            float l_share = curvature * (float)l * (float)(l + 1);
            double a = p.a[l + 1];
            double b = p.b[l + 1];
            float8 sum[PARTS] = {{0}};
            for (uint32_t k = first; k < block_count; k++) {
                float8 value;
                legendre_floats(&p.now[k], &value);
                value *= share[k] - l_share;
                for (uint32_t part = 0; part < PARTS; part++)
                    sum[part] += value * wave[part * blocks + k];
                double8 next = p.before[k];
                legendre_step(&x[k], &p.now[k], &next, b, a);
                p.before[k] = p.now[k];
                p.now[k] = next;
            }
            for (uint32_t part = 0; part < PARTS; part++) {
                float8 s = sum[part];
                out[part] += (((s[0] + s[1]) + (s[2] + s[3])) + ((s[4] + s[5]) + (s[6] + s[7]))) * scale;
            }
        }
    }
}

/* ---- the grid of the analysis ---- */

static uint32_t power_of_two_from(uint32_t x)
{
    return x <= 1 ? 1u : 2u << (31 - __builtin_clz(x - 1));
}

/* Columns: those of the panorama if they are a power of two, otherwise so many that texels straddling two
 * columns hardly matter. More than 16 per degree are not needed. */
static void choose_columns(const image *panorama, uint32_t degree, analysis *job, uint32_t *width)
{
    uint32_t own = power_of_two_from(panorama->width);
    uint32_t least = power_of_two_from(2 * degree + 2);
    uint32_t most = power_of_two_from(16 * degree);
    bool is_own = own == panorama->width;
    uint32_t columns = is_own ? own : 2 * own;
    columns = columns > most ? most : columns < least ? least : columns;
    job->is_wider = !is_own || columns < own;
    job->splits = columns > FOURIER_MAX ? columns / FOURIER_MAX : 1;
    *width = columns;
}

/* Rows: those of the panorama, each split until k d < 2; at most 8 per degree. */
static void choose_rows(const image *panorama, uint32_t degree, analysis *job, uint32_t *height)
{
    uint32_t least = degree + degree / 2 + degree / 8;
    uint32_t parts = (least + panorama->height - 1) / panorama->height;
    if (panorama->height & parts & 1)
        parts++;
    job->is_higher = panorama->height > 8 * degree;
    *height = job->is_higher ? 8 * degree : parts * panorama->height;
}

/* ---- the least radiance ---- */

enum { MIN_PARTS = 64 }; /* parts of the panorama's rows */

typedef struct least_search {
    const image *panorama;
    float least[MIN_PARTS][3];
} least_search;

static void search_rows(void *context, size_t begin, size_t end)
{
    least_search *job = context;
    size_t row = (size_t)job->panorama->width * 3;
    for (size_t part = begin; part < end; part++) {
        const float *texel =
            (const float *)job->panorama->pixels + job->panorama->height * part / MIN_PARTS * row;
        const float *last =
            (const float *)job->panorama->pixels + job->panorama->height * (part + 1) / MIN_PARTS * row;
        float *least = job->least[part];
        least[0] = least[1] = least[2] = FLT_MAX;
        for (; texel < last; texel += 3)
            for (int i = 0; i < 3; i++)
                least[i] = texel[i] < least[i] ? texel[i] : least[i];
    }
}

static void find_least(const image *panorama, uint32_t thread_count, float least[3])
{
    least_search job = {.panorama = panorama};
    parallel_for(thread_count, MIN_PARTS, 1, search_rows, &job);
    for (int i = 0; i < 3; i++) {
        least[i] = FLT_MAX;
        for (int part = 0; part < MIN_PARTS; part++)
            least[i] = job.least[part][i] < least[i] ? job.least[part][i] : least[i];
    }
}

/* ---- the functions of harmonics.h ---- */

facet_result harmonics_create(const image *panorama, uint32_t degree, const facet_allocator *allocator,
                              uint32_t thread_count, harmonics *out, facet_error *error)
{
    *out = (harmonics){0};
    harmonics h = {.degree = degree};
    h.allocator = allocator ? *allocator : h.allocator;
    analysis job = {.out = &h};
    equirect_view view = {0};
    double mean[3];
    uint32_t width, height;
    choose_columns(panorama, degree, &job, &width);
    choose_rows(panorama, degree, &job, &height);
    uint32_t pairs = height / 2;
    job.capacity = pairs < BAND_ROWS ? (pairs + LANES - 1) / LANES * LANES : BAND_ROWS;
    size_t count = harmonics_order_index(degree, degree) + PARTS;
    size_t spectrum_count = harmonics_spectrum_index(degree + 1, 0, 0, job.capacity);
    h.coefficients = mem_zalloc(allocator, count, sizeof *h.coefficients);
    h.spectra = mem_alloc(allocator, spectrum_count, sizeof *h.spectra);
    facet_result result = FACET_OK;
    if (!h.coefficients || !h.spectra ||
        !equirect_view_create(panorama, width, height, false, allocator, &view))
        result = fail_memory(error, "harmonics", (count + spectrum_count) * sizeof(float));
    if (result == FACET_OK)
        result = equirect_mean(panorama, allocator, thread_count, mean, error);
    if (result == FACET_OK) {
        job.view = &view;
        fourier_init(&job.transform, width / job.splits);
        for (int i = 0; i < 3; i++)
            h.mean[i] = (float)mean[i];
        find_least(panorama, thread_count, h.least);
        for (job.first = 0; job.first < pairs; job.first += job.count) {
            job.count = pairs - job.first < job.capacity ? pairs - job.first : job.capacity;
            legendre_place(&job.rows, job.first, job.count, height);
            parallel_for(thread_count, job.count, 8, analyse_rows, &job);
            clear_fill(&job);
            parallel_for(thread_count, degree + 1, 4, analyse_orders, &job);
        }
        h.column_count = width;
        harmonics_trim(&h);
        *out = h;
    } else {
        harmonics_destroy(&h);
    }
    equirect_view_destroy(&view);
    return result;
}

void harmonics_trim(harmonics *h)
{
    mem_free(h->spectra);
    mem_free(h->grid);
    h->spectra = NULL;
    h->grid = NULL;
    h->spectrum_count = h->grid_count = 0;
}

void harmonics_destroy(harmonics *h)
{
    harmonics_trim(h);
    mem_free(h->coefficients);
    *h = (harmonics){0};
}
