/* narrow_fit.c - how much of each picture of narrow.h makes a lobe: least squares over degrees l of the difference of
 * transfer functions, weights of at least 0. */
#include <math.h>
#include <string.h>

#include "ibl/narrow.h"

static const double pi = 3.14159265358979323846;

enum { DEGREES = 64 };

/* Of the mixture's mass around a picture's variance, what its weight is at least. */
static const double least_share = 0.5;

/* Transfer functions, and how much a degree counts. */
typedef struct spectrum {
    uint32_t picture_count;
    double variance[NARROW_COUNT]; /* of the pictures, rad^2 */
    double degree[DEGREES], importance[DEGREES];
    double part[NARROW_PARTS][DEGREES];
    double product[NARROW_PARTS][NARROW_PARTS];
} spectrum;

/* x K_1(x), error below 1e-7. Abramowitz and Stegun 1964, equations 9.8.3, 9.8.7 and 9.8.8. */
static double x_bessel_k1(double x)
{
    static const double i1[7] = {0.5, 0.87890594, 0.51498869, 0.15084934, 0.02658733, 0.00301532, 0.00032411};
    static const double near[7] = {1.0,         0.15443144,  -0.67278579, -0.18156897,
                                   -0.01919402, -0.00110404, -0.00004686};
    static const double far[7] = {1.25331414,  0.23498619, -0.03655620, 0.01504268,
                                  -0.00780353, 0.00325614, -0.00068245};
    double sum = 0.0;
    if (x <= 0.0)
        return 1.0;
    if (x > 2.0) {
        for (int i = 6; i >= 0; i--)
            sum = sum * (2.0 / x) + far[i];
        return sqrt(x) * exp(-x) * sum;
    }
    double t = x * x / 14.0625; /* (x / 3.75)^2 */
    double bessel_i1 = 0.0;
    for (int i = 6; i >= 0; i--) {
        sum = sum * (0.25 * x * x) + near[i];
        bessel_i1 = bessel_i1 * t + i1[i];
    }
    return x * log(0.5 * x) * (x * bessel_i1) + sum;
}

/* Of a GGX lobe as its reflection has it: twice as wide as the lobe of half vectors, whose transform in the plane is
 * alpha l K_1(alpha l). */
static double lobe_transfer(double perceptual_roughness, double degree)
{
    return x_bessel_k1(2.0 * perceptual_roughness * perceptual_roughness * degree);
}

/* Of bilinear interpolation; x: radians from one sample to the next. */
static double tent(double x)
{
    double s = x > 0.0 ? sin(0.5 * x) / (0.5 * x) : 1.0;
    return s * s;
}

/* Of what narrow.c makes, relative to the mirror, of waves that run x radians a column and y a row. */
static double picture_transfer(uint32_t picture, double x, double y)
{
    double result = 1.0 / (tent(x) * tent(y));
    for (uint32_t i = 0;; i++, x *= 2.0, y *= 2.0) {
        for (int pass = 0; pass < NARROW_PASSES; pass++)
            result *= (1.0 - narrow_variances[i][pass] * (1.0 - cos(x))) *
                      (1.0 - narrow_variances[i][pass] * (1.0 - cos(y)));
        if (i == picture)
            return result * tent(x) * tent(y);
        result *= 0.25 * (3.0 * cos(0.5 * x) + cos(1.5 * x)) * 0.25 * (3.0 * cos(0.5 * y) + cos(1.5 * y));
    }
}

static void spectrum_init(spectrum *s, uint32_t picture_count, double row_rad)
{
    double row2 = row_rad * row_rad;
    double variance = 0.0; /* of what a picture holds; bilinear lookup adds a sixth of a squared texel */
    s->picture_count = picture_count;
    for (uint32_t k = 0; k < NARROW_COUNT; k++, row2 *= 4.0) {
        variance += k ? 0.1875 * row2 : 0.0;
        for (int pass = 0; pass < NARROW_PASSES; pass++)
            variance += narrow_variances[k][pass] * row2;
        s->variance[k] = variance + (row2 - row_rad * row_rad) / 6.0;
    }
    double lowest = 4.0;
    double highest = 1.3 * pi / row_rad;
    for (int i = 0; i < DEGREES; i++) {
        double l = lowest * pow(highest / lowest, i / (DEGREES - 1.0));
        double x = l * row_rad * cos(pi / 8.0); /* neither along the grid nor diagonal */
        double y = l * row_rad * sin(pi / 8.0);
        /* Pictures hold about as much in each octave, 1 / l^2 in a degree; suns as much in each degree. */
        double mirror = tent(x) * tent(y);
        s->degree[i] = l;
        s->importance[i] = (1.0 + l * l / (120.0 * 120.0)) * mirror * mirror;
        s->part[NARROW_MIRROR][i] = 1.0;
        s->part[NARROW_LOBE][i] = lobe_transfer((double)NARROW_END, l);
        for (uint32_t k = 0; k < NARROW_COUNT; k++)
            s->part[1 + k][i] = k < picture_count ? picture_transfer(k, x, y) : 0.0;
    }
    for (int a = 0; a < NARROW_PARTS; a++)
        for (int b = 0; b < NARROW_PARTS; b++) {
            s->product[a][b] = 0.0;
            for (int i = 0; i < DEGREES; i++)
                s->product[a][b] += s->importance[i] * s->part[a][i] * s->part[b][i];
        }
}

/* Solves a x = b in place by Gaussian elimination, a symmetric and positive definite; false: it is not. */
static bool solve(uint32_t n, double a[NARROW_PARTS][NARROW_PARTS], double b[NARROW_PARTS])
{
    for (uint32_t i = 0; i < n; i++) {
        if (!(a[i][i] > 1e-12))
            return false;
        for (uint32_t j = i + 1; j < n; j++) {
            double factor = a[j][i] / a[i][i];
            for (uint32_t k = i; k < n; k++)
                a[j][k] -= factor * a[i][k];
            b[j] -= factor * b[i];
        }
    }
    for (uint32_t i = n; i-- > 0;) {
        for (uint32_t k = i + 1; k < n; k++)
            b[i] -= a[i][k] * b[k];
        b[i] /= a[i][i];
    }
    return true;
}

/* The weights of the parts in set, which add up to total, that come nearest to the target with the products b; false:
 * one of them would be negative. */
static bool fit_set(const spectrum *s, uint32_t set, const double b[NARROW_PARTS], double total,
                    double weights[NARROW_PARTS])
{
    uint32_t parts[NARROW_PARTS], count = 0;
    double a[NARROW_PARTS][NARROW_PARTS], x[NARROW_PARTS];
    memset(weights, 0, NARROW_PARTS * sizeof *weights);
    for (uint32_t k = 0; k < NARROW_PARTS; k++)
        if (set >> k & 1)
            parts[count++] = k;
    /* the first is what the others leave of the total */
    const double *first = s->product[parts[0]];
    for (uint32_t i = 1; i < count; i++) {
        for (uint32_t j = 1; j < count; j++)
            a[i - 1][j - 1] =
                s->product[parts[i]][parts[j]] - first[parts[i]] - first[parts[j]] + first[parts[0]];
        x[i - 1] = b[parts[i]] - b[parts[0]] - total * (first[parts[i]] - first[parts[0]]);
    }
    if (!solve(count - 1, a, x))
        return false;
    double left = total;
    for (uint32_t i = 1; i < count; i++) {
        if (x[i - 1] < 0.0)
            return false;
        weights[parts[i]] = x[i - 1];
        left -= x[i - 1];
    }
    weights[parts[0]] = left;
    return left >= 0.0;
}

/* Half the squared error of weights, but for what does not depend on them. */
static double error_of(const spectrum *s, const double b[NARROW_PARTS], const double weights[NARROW_PARTS])
{
    double sum = 0.0;
    for (int i = 0; i < NARROW_PARTS; i++) {
        double row = -b[i];
        for (int k = 0; k < NARROW_PARTS; k++)
            row += 0.5 * s->product[i][k] * weights[k];
        sum += weights[i] * row;
    }
    return sum;
}

/* Weights that the parts have at least: of the lobe of NARROW_END what makes its tail this lobe's, of the wider pictures
 * some of the mixture's mass around their variance. Next to what a sun sends to the middle, the squared error knows
 * nothing of the glow around it, and would leave gaps there. */
static void find_least(const spectrum *s, double perceptual_roughness, double least[NARROW_PARTS])
{
    double end = pow((double)NARROW_END, 4.0);
    double alpha2 = pow(perceptual_roughness, 4.0);
    double before = 0.0;
    memset(least, 0, NARROW_PARTS * sizeof *least);
    least[NARROW_LOBE] = alpha2 / end;
    for (uint32_t k = s->picture_count; k > 1; k--) {
        double limit =
            sqrt(s->variance[k - 1] * s->variance[k - 2]); /* between a picture and the narrower one */
        double mass = (1.0 - exp(-2.0 * alpha2 / limit)) - alpha2 / end * (1.0 - exp(-2.0 * end / limit));
        least[k] = least_share * (mass - before);
        before = mass;
    }
}

/* The best set of parts: the error is convex, so that the best of those without negative weights is the best there is. */
static void fit_lobe(const spectrum *s, double perceptual_roughness, float weights[NARROW_PARTS])
{
    uint32_t available = 1u << NARROW_MIRROR | 1u << NARROW_LOBE | ((1u << s->picture_count) - 1) << 1;
    double least[NARROW_PARTS];
    double b[NARROW_PARTS] = {0.0};
    double left = 1.0;
    find_least(s, perceptual_roughness, least);
    for (int k = 0; k < NARROW_PARTS; k++)
        left -= least[k];
    for (int i = 0; i < DEGREES; i++) {
        double target = lobe_transfer(perceptual_roughness, s->degree[i]);
        for (int k = 0; k < NARROW_PARTS; k++)
            target -= least[k] * s->part[k][i];
        for (int k = 0; k < NARROW_PARTS; k++)
            b[k] += s->importance[i] * s->part[k][i] * target;
    }
    double best[NARROW_PARTS] = {left};
    double lowest = error_of(s, b, best);
    for (uint32_t set = 1; set < 1u << NARROW_PARTS; set++) {
        double w[NARROW_PARTS];
        if ((set & ~available) || !fit_set(s, set, b, left, w))
            continue;
        double error = error_of(s, b, w);
        if (error < lowest) {
            lowest = error;
            memcpy(best, w, sizeof best);
        }
    }
    for (int k = 0; k < NARROW_PARTS; k++)
        weights[k] = (float)(best[k] + least[k]);
}

void narrow_fit(uint32_t count, double row_rad, float weights[NARROW_STEPS + 1][NARROW_PARTS])
{
    spectrum s;
    spectrum_init(&s, count, row_rad);
    memset(weights, 0, (NARROW_STEPS + 1) * sizeof *weights);
    weights[0][NARROW_MIRROR] = 1.0f;
    weights[NARROW_STEPS][NARROW_LOBE] = 1.0f;
    for (int i = 1; i < NARROW_STEPS; i++)
        fit_lobe(&s, (double)NARROW_END * i / NARROW_STEPS, weights[i]);
}
