/* sh.c - see sh.h. The integral of a texel is that of a product of a function of longitude and one of latitude, so
 * each row is summed against five functions of longitude, and the sums against functions of latitude. Rows are
 * summed in float over SPAN texels and from there on in double. */
#include "ibl/sh.h"

#include <math.h>

#include "base/memory.h"
#include "base/parallel.h"
#include "base/result.h"
#include "ibl/rgbx.h"

static const double pi = 3.14159265358979323846;

enum {
    WAVE_COUNT = 5, /* 1, cos, sin, cos 2, sin 2 of longitude */
    SPAN = 64       /* texels that are summed in float: 8 additions in each of 24 lanes */
};

static const double sh_constants[SH_COUNT] = {0.28209479177387814, 0.48860251190291992, 0.48860251190291992,
                                              0.48860251190291992, 1.0925484305920792,  1.0925484305920792,
                                              0.31539156525252005, 1.0925484305920792,  0.54627421529603959};

static void polynomials(const double d[3], double p[SH_COUNT])
{
    double x = d[0];
    double y = d[1];
    double z = d[2];
    p[0] = 1.0;
    p[1] = y;
    p[2] = z;
    p[3] = x;
    p[4] = x * y;
    p[5] = y * z;
    p[6] = 3.0 * z * z - 1.0;
    p[7] = x * z;
    p[8] = x * x - y * y;
}

void sh_basis(const double d[3], double y[SH_COUNT])
{
    polynomials(d, y);
    for (int i = 0; i < SH_COUNT; i++)
        y[i] *= sh_constants[i];
}

typedef struct projection {
    const image *picture;
    float limit;
    float *waves;                      /* [WAVE_COUNT][3 width]: each value three times, for R, G, B */
    double (*row_sums)[WAVE_COUNT][3]; /* [height] */
} projection;

static inline float least_of(float a, float b)
{
    return a < b ? a : b;
}

DISPATCH_AVX2 static void sum_rows(void *context, size_t begin, size_t end)
{
    const projection *p = context;
    size_t count = 3 * (size_t)p->picture->width;
    float limit = p->limit;
    for (size_t y = begin; y < end; y++) {
        const float *row = (const float *)p->picture->pixels + y * count;
        double(*sums)[3] = p->row_sums[y];
        for (int w = 0; w < WAVE_COUNT; w++)
            sums[w][0] = sums[w][1] = sums[w][2] = 0.0;
        size_t i = 0;
        for (; i + 3 * SPAN <= count; i += 3 * SPAN) {
            for (int w = 0; w < WAVE_COUNT; w++) {
                const float *wave = p->waves + (size_t)w * count + i;
                float lanes[24];
                for (int k = 0; k < 24; k++)
                    lanes[k] = least_of(row[i + (size_t)k], limit) * wave[k];
                for (size_t j = 24; j < 3 * SPAN; j += 24)
                    for (size_t k = 0; k < 24; k++)
                        lanes[k] += least_of(row[i + j + k], limit) * wave[j + k];
                for (int k = 0; k < 24; k++)
                    sums[w][k % 3] += (double)lanes[k];
            }
        }
        for (; i < count; i++)
            for (int w = 0; w < WAVE_COUNT; w++)
                sums[w][i % 3] += (double)least_of(row[i], limit) * (double)p->waves[(size_t)w * count + i];
    }
}

/* Integrals of sin(theta) times {1, cos, cos^2, sin, sin cos, sin^2}(theta) over the rows between a and b. */
static void latitude_integrals(double a, double b, double out[6])
{
    double ca = cos(a);
    double cb = cos(b);
    double sa = sin(a);
    double sb = sin(b);
    out[0] = ca - cb;
    out[1] = 0.5 * (ca * ca - cb * cb);
    out[2] = (ca * ca * ca - cb * cb * cb) / 3.0;
    out[3] = 0.5 * (b - a) - 0.5 * (sb * cb - sa * ca);
    out[4] = (sb * sb * sb - sa * sa * sa) / 3.0;
    out[5] = out[0] - out[2];
}

/* Adds the texels of one row to the coefficients, the constants of the basis left out.
 * x = sin cos(phi), y = cos, z = sin sin(phi). */
static void add_row(double sums[WAVE_COUNT][3], const double latitude[6], double c[SH_COUNT][3])
{
    for (int i = 0; i < 3; i++) {
        double one = sums[0][i];
        double cosine = sums[1][i];
        double sine = sums[2][i];
        double cosine_2 = sums[3][i];
        double sine_2 = sums[4][i];
        c[0][i] += latitude[0] * one;
        c[1][i] += latitude[1] * one;
        c[2][i] += latitude[3] * sine;
        c[3][i] += latitude[3] * cosine;
        c[4][i] += latitude[4] * cosine;
        c[5][i] += latitude[4] * sine;
        c[6][i] +=
            1.5 * latitude[5] * (one - cosine_2) - latitude[0] * one; /* 3 sin^2(phi) = 1.5 (1 - cos 2 phi) */
        c[7][i] += 0.5 * latitude[5] * sine_2;
        c[8][i] += 0.5 * latitude[5] * (one + cosine_2) - latitude[2] * one;
    }
}

facet_result sh_project(const image *picture, const facet_allocator *allocator, uint32_t thread_count,
                        double radiance[SH_COUNT][3], facet_error *error)
{
    return sh_project_limited(picture, INFINITY, allocator, thread_count, radiance, error);
}

facet_result sh_project_limited(const image *picture, float limit, const facet_allocator *allocator,
                                uint32_t thread_count, double radiance[SH_COUNT][3], facet_error *error)
{
    uint32_t width = picture->width;
    uint32_t height = picture->height;
    facet_result result = FACET_OK;
    projection p = {picture, limit, mem_alloc(allocator, width, 3 * WAVE_COUNT * sizeof(float)),
                    mem_alloc(allocator, height, sizeof *p.row_sums)};
    if (!p.waves || !p.row_sums) {
        result = fail_memory(error, "irradiance", width * sizeof(float) * 3 * WAVE_COUNT);
        goto done;
    }
    double step = 2.0 * pi / width;
    for (uint32_t x = 0; x < width; x++) {
        double phi = (x + 0.5) * step - pi;
        double wave[WAVE_COUNT] = {1.0, cos(phi), sin(phi), cos(2.0 * phi), sin(2.0 * phi)};
        for (uint32_t w = 0; w < WAVE_COUNT; w++)
            for (uint32_t i = 0; i < 3; i++)
                p.waves[3 * ((size_t)w * width + x) + i] = (float)wave[w];
    }
    parallel_for(thread_count, height, 16, sum_rows, &p);

    /* the integral of cos(k phi) over a texel is its value in the middle times 2 sin(k step / 2) / k */
    double texel[WAVE_COUNT] = {step, 2.0 * sin(0.5 * step), 2.0 * sin(0.5 * step), sin(step), sin(step)};
    for (int k = 0; k < SH_COUNT; k++)
        radiance[k][0] = radiance[k][1] = radiance[k][2] = 0.0;
    for (uint32_t y = 0; y < height; y++) {
        for (int w = 0; w < WAVE_COUNT; w++)
            for (int i = 0; i < 3; i++)
                p.row_sums[y][w][i] *= texel[w];
        double latitude[6];
        latitude_integrals(pi * y / height, pi * (y + 1.0) / height, latitude);
        add_row(p.row_sums[y], latitude, radiance);
    }
    for (int k = 0; k < SH_COUNT; k++)
        for (int i = 0; i < 3; i++)
            radiance[k][i] *= sh_constants[k];
done:
    mem_free(p.waves);
    mem_free(p.row_sums);
    return result;
}

void sh_irradiance(const double radiance[SH_COUNT][3], double irradiance[SH_COUNT][3])
{
    for (int k = 0; k < SH_COUNT; k++)
        for (int i = 0; i < 3; i++)
            irradiance[k][i] = pi * (k == 0 ? 1.0 : k < 4 ? 2.0 / 3.0 : 0.25) * radiance[k][i];
}

void sh_fold_over_pi(const double irradiance[SH_COUNT][3], float c[SH_COUNT][3])
{
    for (int k = 0; k < SH_COUNT; k++)
        for (int i = 0; i < 3; i++)
            c[k][i] = (float)(sh_constants[k] / pi * irradiance[k][i]);
}

void sh_evaluate(const float c[SH_COUNT][3], const float N[3], float out[3])
{
    float x = N[0];
    float y = N[1];
    float z = N[2];
    float p[SH_COUNT] = {1.0f, y, z, x, x * y, y * z, 3.0f * z * z - 1.0f, x * z, x * x - y * y};
    for (int i = 0; i < 3; i++) {
        float sum = c[0][i];
        for (int k = 1; k < SH_COUNT; k++)
            sum += c[k][i] * p[k];
        out[i] = sum > 0.0f ? sum : 0.0f;
    }
}
