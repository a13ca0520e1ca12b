/* compare_flip_kernels.c - see compare_flip_kernels.h. */
#include "compare/compare_flip_kernels.h"

#include <math.h>
#include <string.h>

#define PI 3.14159265358979323846

/* A term a sqrt(pi / b) exp(-pi^2 r^2 / b) of a filter, r in degrees: table 1 of the paper. */
typedef struct gauss_term {
    double a, b;
} gauss_term;
static const gauss_term achromatic = {1.0, 0.0047}, red_green = {1.0, 0.0053},
                        blue_yellow[2] = {{34.1, 0.04}, {13.5, 0.025}};
static const double widest = 0.04;         /* the largest b: all have the radius of this one */
static const double feature_width = 0.082; /* degrees: peak to trough of the eye's edge detector */
static const double negligible = 1e-9;     /* of a kernel's sum: weights that no float notices */

static double gauss(gauss_term t, double pixels_per_degree, int x)
{
    const double r = x / pixels_per_degree;
    return exp(-PI * PI * r * r / t.b);
}

/* Sum over a row of the filter. */
static double row_sum(gauss_term t, double pixels_per_degree, int radius)
{
    double sum = 0.0;
    for (int x = -radius; x <= radius; x++)
        sum += gauss(t, pixels_per_degree, x);
    return sum;
}

/* The terms of one filter in two dimensions add up to 1: what each has of it is split evenly between rows and columns. */
static void make_sensitivity(const gauss_term *terms, int count, double pixels_per_degree, int radius,
                             flip_kernel *out)
{
    double total = 0.0, shares[2], sums[2];
    for (int k = 0; k < count; k++) {
        sums[k] = row_sum(terms[k], pixels_per_degree, radius);
        shares[k] = terms[k].a * sqrt(PI / terms[k].b) * sums[k] * sums[k];
        total += shares[k];
    }
    for (int k = 0; k < count; k++) {
        const double scale = sqrt(shares[k] / total) / sums[k];
        out[k].radius = 0;
        for (int x = 0; x <= radius; x++) {
            const double weight = gauss(terms[k], pixels_per_degree, x);
            if (weight >= negligible * sums[k])
                out[k].radius = x;
            out[k].weights[x] = (float)(scale * weight);
        }
    }
}

/* Positive weights add up to 1, negative ones to -1, in one dimension, which makes it so in two. */
static void make_features(double pixels_per_degree, flip_kernels *out)
{
    const double sigma = 0.5 * feature_width * pixels_per_degree;
    const int radius = (int)ceil(3.0 * sigma);
    double sum = 0.0, slope = 0.0, positive = 0.0, negative = 0.0;
    for (int x = -radius; x <= radius; x++) {
        const double g = exp(-x * x / (2.0 * sigma * sigma)), curve = (x * x / (sigma * sigma) - 1.0) * g;
        sum += g;
        slope += x > 0 ? x * g : 0.0;
        positive += curve > 0.0 ? curve : 0.0;
        negative -= curve < 0.0 ? curve : 0.0;
    }
    out->gaussian.radius = out->first.radius = out->second.radius = radius;
    for (int x = 0; x <= radius; x++) {
        const double g = exp(-x * x / (2.0 * sigma * sigma)), curve = (x * x / (sigma * sigma) - 1.0) * g;
        out->gaussian.weights[x] = (float)(g / sum);
        out->first.weights[x] = (float)(x * g / slope);
        out->second.weights[x] = (float)(curve / (curve > 0.0 ? positive : negative));
    }
}

void flip_kernels_make(double pixels_per_degree, flip_kernels *out)
{
    const int radius = (int)ceil(3.0 * sqrt(widest / (2.0 * PI * PI)) * pixels_per_degree);
    memset(out, 0, sizeof *out);
    make_sensitivity(&achromatic, 1, pixels_per_degree, radius, &out->achromatic);
    make_sensitivity(&red_green, 1, pixels_per_degree, radius, &out->red_green);
    make_sensitivity(blue_yellow, 2, pixels_per_degree, radius, out->blue_yellow);
    make_features(pixels_per_degree, out);
    out->halo = radius > out->first.radius ? radius : out->first.radius;
}
