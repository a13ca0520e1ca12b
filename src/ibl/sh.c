/* sh.c - see sh.h. The integral over a texel is a product of a function of longitude and one of latitude, so
 * each row is summed against five functions of longitude, and these sums against functions of latitude. Rows
 * are summed in float over SPAN texels, beyond that in double. */
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
    const image *panorama;
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
    size_t count = 3 * (size_t)p->panorama->width;
    float limit = p->limit;
    for (size_t y = begin; y < end; y++) {
        const float *row = (const float *)p->panorama->pixels + y * count;
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

/* Adds the texels of one row to the coefficients, without the constants of the basis. x = sin cos(phi), y =
 * cos, z = sin sin(phi). */
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

facet_result sh_project(const image *panorama, const facet_allocator *allocator, uint32_t thread_count,
                        double radiance[SH_COUNT][3], facet_error *error)
{
    return sh_project_limited(panorama, INFINITY, allocator, thread_count, radiance, error);
}

facet_result sh_project_limited(const image *panorama, float limit, const facet_allocator *allocator,
                                uint32_t thread_count, double radiance[SH_COUNT][3], facet_error *error)
{
    uint32_t width = panorama->width;
    uint32_t height = panorama->height;
    facet_result result = FACET_OK;
    projection p = {panorama, limit, mem_alloc(allocator, width, 3 * WAVE_COUNT * sizeof(float)),
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

    /* the integral of cos(k phi) over a texel is its value at the center times 2 sin(k step / 2) / k */
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

/* ---- windows ---- */

/* sh.h has them to ten digits: sqrt(1 / 4 pi), sqrt(3 / 4 pi), sqrt(15 / 4 pi); sqrt(5 / 16 pi) is K2 /
 * sqrt 12. */
static const double K0 = 0.28209479177387814;
static const double K1 = 0.48860251190291992;
static const double K2 = 1.0925484305920792;
static const double K20 = 0.31539156525252005;

typedef struct quadric {
    double c, b[3], M[3][3];
} quadric;

static quadric quadric_from(const double c[SH_COUNT])
{
    double d20 = K20 * c[6]; /* 3 z^2 - 1 = 2 z^2 - x^2 - y^2 */
    double d22 = 0.5 * K2 * c[8];
    double xy = 0.5 * K2 * c[4];
    double yz = 0.5 * K2 * c[5];
    double xz = 0.5 * K2 * c[7];
    return (quadric){.c = K0 * c[0],
                     .b = {K1 * c[3], K1 * c[1], K1 * c[2]},
                     .M = {{d22 - d20, xy, xz}, {xy, -d22 - d20, yz}, {xz, yz, 2.0 * d20}}};
}

static void quadric_to(const quadric *q, double c[SH_COUNT])
{
    c[0] = q->c / K0;
    c[1] = q->b[1] / K1;
    c[2] = q->b[2] / K1;
    c[3] = q->b[0] / K1;
    c[4] = q->M[0][1] / (0.5 * K2);
    c[5] = q->M[1][2] / (0.5 * K2);
    c[6] = 0.5 * q->M[2][2] / K20;
    c[7] = q->M[0][2] / (0.5 * K2);
    c[8] = (q->M[0][0] - q->M[1][1]) / K2;
}

void sh_rotate(double c[SH_COUNT][3], double rotation_rad)
{
    double cosine = cos(rotation_rad);
    double sine = sin(rotation_rad);
    const double T[3][3] = {{cosine, 0.0, sine}, {0.0, 1.0, 0.0}, {-sine, 0.0, cosine}};
    for (int channel = 0; channel < 3; channel++) {
        double one[SH_COUNT];
        for (int k = 0; k < SH_COUNT; k++)
            one[k] = c[k][channel];
        quadric q = quadric_from(one);
        quadric turned = {.c = q.c};
        for (int i = 0; i < 3; i++)
            for (int j = 0; j < 3; j++) {
                turned.b[i] += T[i][j] * q.b[j];
                for (int k = 0; k < 3; k++)
                    for (int l = 0; l < 3; l++)
                        turned.M[i][j] += T[i][k] * q.M[k][l] * T[j][l];
            }
        quadric_to(&turned, one);
        for (int k = 0; k < SH_COUNT; k++)
            c[k][channel] = one[k];
    }
}

/* ---- the least value ---- */

/* Jacobi rotation of columns p and q of M, and of b, that makes M[p][q] 0. Golub and Van Loan 2013, section
 * 8.5.2. */
static void jacobi_turn(quadric *f, int p, int q)
{
    if (f->M[p][q] == 0.0)
        return;
    double tau = (f->M[q][q] - f->M[p][p]) / (2.0 * f->M[p][q]);
    double t = (tau < 0.0 ? -1.0 : 1.0) / (fabs(tau) + sqrt(1.0 + tau * tau));
    double cosine = 1.0 / sqrt(1.0 + t * t);
    double sine = t * cosine;
    for (int i = 0; i < 3; i++) {
        double a = f->M[i][p];
        double b = f->M[i][q];
        f->M[i][p] = cosine * a - sine * b;
        f->M[i][q] = sine * a + cosine * b;
    }
    for (int i = 0; i < 3; i++) {
        double a = f->M[p][i];
        double b = f->M[q][i];
        f->M[p][i] = cosine * a - sine * b;
        f->M[q][i] = sine * a + cosine * b;
    }
    double a = f->b[p];
    double b = f->b[q];
    f->b[p] = cosine * a - sine * b;
    f->b[q] = sine * a + cosine * b;
}

/* In the eigenbasis of M the function is c + sum of m_i n_i^2 + b_i n_i, and its minimum on the unit sphere
 * is the maximum over s <= min m of
 *   g(s) = c + s - sum of b_i^2 / (4 (m_i - s)),
 * which is concave (Lagrange multiplier; there is no duality gap, More and Sorensen 1983). Its slope 1 - sum
 * (b_i / (2 (m_i - s)))^2 changes sign between min m - |b| / 2 and min m. */
double sh_minimum(const double c[SH_COUNT])
{
    quadric f = quadric_from(c);
    for (int sweep = 0; sweep < 8; sweep++) { /* converges quadratically: 4 suffice */
        jacobi_turn(&f, 0, 1);
        jacobi_turn(&f, 0, 2);
        jacobi_turn(&f, 1, 2);
    }
    double least = fmin(fmin(f.M[0][0], f.M[1][1]), f.M[2][2]);
    double low = least - 0.5 * sqrt(f.b[0] * f.b[0] + f.b[1] * f.b[1] + f.b[2] * f.b[2]);
    double high = least;
    for (int i = 0; i < 60; i++) {
        double s = 0.5 * (low + high);
        double slope = 1.0;
        for (int k = 0; k < 3; k++) {
            double q = f.M[k][k] > s ? f.b[k] / (2.0 * (f.M[k][k] - s)) : 0.0;
            slope -= q * q;
        }
        if (slope > 0.0)
            low = s;
        else
            high = s;
    }
    double value = f.c + low;
    for (int k = 0; k < 3; k++)
        if (f.M[k][k] > low)
            value -= f.b[k] * f.b[k] / (4.0 * (f.M[k][k] - low));
    return value;
}

/* ---- windows ---- */

void sh_window(double narrowness, double factors[2])
{
    for (int l = 1; l <= 2; l++) {
        double x = pi * l * narrowness;
        double sinc = x > 1e-6 ? sin(x) / x : 1.0;
        factors[l - 1] = sinc * sinc * sinc * sinc;
    }
}

static void apply_window(const double from[SH_COUNT][3], double narrowness, double to[SH_COUNT][3])
{
    double factors[2];
    sh_window(narrowness, factors);
    for (int k = 0; k < SH_COUNT; k++)
        for (int i = 0; i < 3; i++)
            to[k][i] = from[k][i] * (k == 0 ? 1.0 : k < 4 ? factors[0] : factors[1]);
}

/* Whether irradiance is nowhere negative, even after rounding to float. */
static bool is_lit_everywhere(const double radiance[SH_COUNT][3])
{
    double irradiance[SH_COUNT][3];
    sh_irradiance(radiance, irradiance);
    for (int i = 0; i < 3; i++) {
        double one[SH_COUNT];
        for (int k = 0; k < SH_COUNT; k++)
            one[k] = irradiance[k][i];
        if (sh_minimum(one) < 1e-6 * K0 * one[0])
            return false;
    }
    return true;
}

double sh_dering(double radiance[SH_COUNT][3])
{
    if (is_lit_everywhere((const double(*)[3])radiance))
        return 0.0;
    double wide = 0.0;
    double narrow = 1.0 / 3.0;
    double windowed[SH_COUNT][3];
    for (int i = 0; i < 40; i++) {
        double middle = 0.5 * (wide + narrow);
        apply_window((const double(*)[3])radiance, middle, windowed);
        if (is_lit_everywhere((const double(*)[3])windowed))
            narrow = middle;
        else
            wide = middle;
    }
    apply_window((const double(*)[3])radiance, narrow, windowed);
    for (int k = 0; k < SH_COUNT; k++)
        for (int i = 0; i < 3; i++)
            radiance[k][i] = windowed[k][i];
    return narrow;
}
