/* plot_vignette.c - see plot_vignette.h. */
#include <math.h>

#include "plot/plot_build.h"
#include "plot/plot_vignette.h"

/* Cosines of directions in one plane. */
typedef struct cosines {
    double NdotL, NdotV, NdotH, VdotH;
} cosines;
static cosines cosines_of(double theta, double phi)
{
    return (cosines){.NdotL = cos(phi),
                     .NdotV = cos(theta),
                     .NdotH = cos(0.5 * (theta + phi)),
                     .VdotH = cos(0.5 * (theta - phi))};
}

double vignette_pbr(double theta, double phi, double roughness, double metallic, double base, bool has_ramp)
{
    cosines c = cosines_of(theta, phi);
    double alpha = roughness * roughness;
    double a2 = alpha * alpha;
    double chi_N = has_ramp ? fmax(c.NdotH, 0.0) : c.NdotH > 0.0;
    double chi_V = has_ramp ? fmax(c.VdotH, 0.0) : c.VdotH > 0.0; /* H.L is the same */
    double t = c.NdotH * c.NdotH * (a2 - 1.0) + 1.0;
    double D = a2 * chi_N / (PLOT_PI * t * t);
    double G = 2.0 * c.NdotL * chi_V / (c.NdotL + sqrt(a2 + (1.0 - a2) * c.NdotL * c.NdotL)) * 2.0 * c.NdotV *
               chi_V / (c.NdotV + sqrt(a2 + (1.0 - a2) * c.NdotV * c.NdotV));
    double F0 = 0.04 * (1.0 - metallic) + metallic * base;
    double F = F0 + (1.0 - F0) * pow(1.0 - c.VdotH, 5.0);
    double diffuse = (1.0 - F) * (1.0 - metallic) * base / PLOT_PI;
    double specular = F * D * G / (4.0 * fabs(c.NdotV) * fabs(c.NdotL));
    return (diffuse + specular) * c.NdotL;
}

double vignette_ogl1(double theta, double phi, double shininess, double diffuse, double specular)
{
    cosines c = cosines_of(theta, phi);
    return fmax(c.NdotL, 0.0) * diffuse + pow(fmax(c.NdotH, 0.0), shininess) * specular;
}

double vignette_phi(int point)
{
    return (-80.0 + 5.0 * point) * PLOT_DEGREE;
}

double vignette_error(double theta, const double target[VIGNETTE_POINTS], double shininess, double diffuse,
                      double specular)
{
    double difference = 0.0, norm = 0.0;
    for (int i = 0; i < VIGNETTE_POINTS; i++) {
        double d = vignette_ogl1(theta, vignette_phi(i), shininess, diffuse, specular) - target[i];
        difference += d * d;
        norm += target[i] * target[i];
    }
    return sqrt(difference / norm);
}

static double clamp01(double x)
{
    return fmin(fmax(x, 0.0), 1.0);
}

/* Least squares of target = Cd a + Cs b with both in [0, 1]: the interior solution, or the best on the
 * four edges. */
static vignette_parameters solve_colors(double theta, const double target[VIGNETTE_POINTS], double shininess)
{
    double aa = 0.0, ab = 0.0, bb = 0.0, at = 0.0, bt = 0.0;
    for (int i = 0; i < VIGNETTE_POINTS; i++) {
        double a = vignette_ogl1(theta, vignette_phi(i), shininess, 1.0, 0.0);
        double b = vignette_ogl1(theta, vignette_phi(i), shininess, 0.0, 1.0);
        aa += a * a;
        ab += a * b;
        bb += b * b;
        at += a * target[i];
        bt += b * target[i];
    }
    double determinant = aa * bb - ab * ab;
    double d = (at * bb - bt * ab) / determinant;
    double s = (bt * aa - at * ab) / determinant;
    double candidates[5][2] = {{d, s},
                               {0.0, clamp01(bt / bb)},
                               {1.0, clamp01((bt - ab) / bb)},
                               {clamp01(at / aa), 0.0},
                               {clamp01((at - ab) / aa), 1.0}};
    vignette_parameters best = {.error = HUGE_VAL};
    for (int k = 0; k < 5; k++) {
        const double *c = candidates[k];
        if (!(c[0] >= 0.0 && c[0] <= 1.0 && c[1] >= 0.0 && c[1] <= 1.0))
            continue;
        double error = vignette_error(theta, target, shininess, c[0], c[1]);
        if (error < best.error)
            best = (vignette_parameters){shininess, c[0], c[1], error};
    }
    return best;
}

vignette_parameters vignette_fit(double theta, const double target[VIGNETTE_POINTS])
{
    enum { GRID = 129, STEPS = 60 };
    const double golden = 0.6180339887498949;
    int nearest = 0;
    vignette_parameters best = {.error = HUGE_VAL};
    for (int i = 0; i < GRID; i++) {
        vignette_parameters found = solve_colors(theta, target, i);
        if (found.error < best.error) {
            best = found;
            nearest = i;
        }
    }
    double low = fmax(nearest - 1.0, 0.0), high = fmin(nearest + 1.0, 128.0);
    for (int i = 0; i < STEPS; i++) {
        vignette_parameters left = solve_colors(theta, target, high - golden * (high - low));
        vignette_parameters right = solve_colors(theta, target, low + golden * (high - low));
        if (left.error < right.error)
            high = right.shininess;
        else
            low = left.shininess;
        best = left.error < best.error ? left : right.error < best.error ? right : best;
    }
    return best;
}
