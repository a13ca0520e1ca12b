/* sh_window.c - see sh_window.h. Nine harmonics are c + b.N + N M N, M symmetric and without trace: what Y1 and Y2 are
 * made of. Turning them is turning b and M, and their least value is that of a quadratic form on the unit sphere. */
#include "ibl/sh_window.h"

#include <math.h>

static const double pi = 3.14159265358979323846;

/* sh.h has them to ten digits: sqrt(1 / 4 pi), sqrt(3 / 4 pi), sqrt(15 / 4 pi); sqrt(5 / 16 pi) is K2 / sqrt 12. */
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

/* Turns columns p and q of M, and b with them, so that M[p][q] becomes 0. Golub and Van Loan 2013, section 8.5.2. */
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

/* Along the axes of M, m_i, the function is c + sum of m_i n_i^2 + b_i n_i, and its least value on the unit sphere the
 * largest over s <= min m of
 *   g(s) = c + s - sum of b_i^2 / (4 (m_i - s)),
 * which is concave (Lagrange's multiplier; there is no gap, More and Sorensen 1983). Its slope 1 - sum (b_i / (2 (m_i -
 * s)))^2 changes sign between min m - |b| / 2 and min m. */
double sh_least(const double c[SH_COUNT])
{
    quadric f = quadric_from(c);
    for (int sweep = 0; sweep < 8; sweep++) { /* converges quadratically: 4 do */
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

/* Whether irradiance is nowhere negative, also when it is rounded to float. */
static bool is_lit_everywhere(const double radiance[SH_COUNT][3])
{
    double irradiance[SH_COUNT][3];
    sh_irradiance(radiance, irradiance);
    for (int i = 0; i < 3; i++) {
        double one[SH_COUNT];
        for (int k = 0; k < SH_COUNT; k++)
            one[k] = irradiance[k][i];
        if (sh_least(one) < 1e-6 * K0 * one[0])
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
