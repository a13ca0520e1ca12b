/* chi_square.h - chi-square test of samples against a density on the sphere. Includes test_support.h. */
#ifndef SHADE_CHI_SQUARE_H
#define SHADE_CHI_SQUARE_H

#include "test_support.h"

/* Upper incomplete gamma function Q(a, x) = Gamma(a, x) / Gamma(a): below a + 1 by the series of its
 * complement, above by Legendre's continued fraction (Press et al., "Numerical Recipes", section 6.2). */
static inline double incomplete_gamma(double a, double x)
{
    if (x <= 0.0)
        return 1.0;
    double front = exp(a * log(x) - x - lgamma(a));
    if (x < a + 1.0) {
        double term = 1.0 / a, sum = term;
        for (int n = 1; n < 100000 && term > sum * 1e-16; ++n) {
            term *= x / (a + n);
            sum += term;
        }
        return 1.0 - front * sum;
    }
    double b = x + 1.0 - a, c = 1e300, d = 1.0 / b, h = d;
    for (int i = 1; i < 100000; ++i) {
        double an = -i * (i - a);
        b += 2.0;
        d = 1.0 / (an * d + b);
        c = b + an / c;
        h *= d * c;
        if (fabs(d * c - 1.0) < 1e-15)
            break;
    }
    return front * h;
}

/* Probability that X of that many degrees of freedom is at least chi2. */
static inline double chi2_p_value(double chi2, double freedom)
{
    return incomplete_gamma(0.5 * freedom, 0.5 * chi2);
}

/* The significance of one of n tests that together have 0.01 (Sidak 1967). */
static inline __attribute__((unused)) double sidak_level(int n)
{
    return 1.0 - pow(1.0 - 0.01, 1.0 / n);
}

/* A sampler: draw() returns a unit direction, or false if there is none; pdf() its density per sr. */
typedef struct sphere_sampler {
    bool (*draw)(const void *context, vec2 u, vec3 *direction);
    float (*pdf)(const void *context, vec3 direction);
    const void *context;
} sphere_sampler;

enum { SPHERE_CELLS_PHI = 32, SPHERE_CELLS_Z = 64, SPHERE_DRAWS = 300000 };

/* A patch of the sphere: ranges of z and phi. */
typedef struct sphere_patch {
    double z[2], phi[2];
} sphere_patch;

/* Integral of the density over a patch, Gauss-Legendre with 5 x 5 points. */
static inline double sphere_patch_gauss(const sphere_sampler *s, sphere_patch patch)
{
    static const double node[5] = {-0.906179845938664, -0.538469310105683, 0.0, 0.538469310105683,
                                   0.906179845938664};
    static const double weight[5] = {0.236926885056189, 0.478628670499366, 0.568888888888889,
                                     0.478628670499366, 0.236926885056189};
    double z_middle = 0.5 * (patch.z[0] + patch.z[1]), z_half = 0.5 * (patch.z[1] - patch.z[0]);
    double phi_middle = 0.5 * (patch.phi[0] + patch.phi[1]), phi_half = 0.5 * (patch.phi[1] - patch.phi[0]);
    double sum = 0.0;
    for (int b = 0; b < 5; ++b)
        for (int a = 0; a < 5; ++a) {
            double z = z_middle + z_half * node[b], phi = phi_middle + phi_half * node[a];
            double r = sqrt(1.0 - z * z);
            vec3 d = vec3((float)(r * cos(phi)), (float)(r * sin(phi)), (float)z);
            sum += weight[a] * weight[b] * (double)s->pdf(s->context, d);
        }
    return sum * z_half * phi_half;
}

/* The same, patches with an edge (a horizon of microfacets) cut into quarters. */
static inline double sphere_patch_mass(const sphere_sampler *s, sphere_patch patch, int depth)
{
    double z_middle = 0.5 * (patch.z[0] + patch.z[1]), phi_middle = 0.5 * (patch.phi[0] + patch.phi[1]);
    double whole = sphere_patch_gauss(s, patch), sum = 0.0, mass[4];
    sphere_patch quarter[4];
    for (int i = 0; i < 4; ++i) {
        quarter[i] = patch;
        quarter[i].z[i & 1 ? 0 : 1] = z_middle;
        quarter[i].phi[i & 2 ? 0 : 1] = phi_middle;
        mass[i] = sphere_patch_gauss(s, quarter[i]);
        sum += mass[i];
    }
    if (depth == 0 || fabs(sum - whole) < 2e-7)
        return sum;
    sum = 0.0;
    for (int i = 0; i < 4; ++i)
        sum += sphere_patch_mass(s, quarter[i], depth - 1);
    return sum;
}

static inline __attribute__((unused)) double sphere_cell_mass(const sphere_sampler *s, int phi_cell,
                                                              int z_cell)
{
    const double pi = 3.14159265358979323846;
    sphere_patch patch = {
        {2.0 * z_cell / SPHERE_CELLS_Z - 1.0, 2.0 * (z_cell + 1) / SPHERE_CELLS_Z - 1.0},
        {2.0 * pi * phi_cell / SPHERE_CELLS_PHI, 2.0 * pi * (phi_cell + 1) / SPHERE_CELLS_PHI}};
    return sphere_patch_mass(s, patch, 5);
}

/* p-value of SPHERE_DRAWS samples against the density over the whole sphere. One minus the integral of the
 * density is the fraction of samples without a direction. Cells that expect fewer than 5 samples are pooled. */
static inline __attribute__((unused)) double chi2_over_sphere(const sphere_sampler *s, uint64_t seed)
{
    static double expected[SPHERE_CELLS_PHI * SPHERE_CELLS_Z], observed[SPHERE_CELLS_PHI * SPHERE_CELLS_Z];
    const double pi = 3.14159265358979323846;
    double total = 0.0;
    for (int z = 0; z < SPHERE_CELLS_Z; ++z)
        for (int p = 0; p < SPHERE_CELLS_PHI; ++p) {
            double mass = sphere_cell_mass(s, p, z);
            expected[z * SPHERE_CELLS_PHI + p] = mass * SPHERE_DRAWS;
            observed[z * SPHERE_CELLS_PHI + p] = 0.0;
            total += mass;
        }
    assert_true(total < 1.002);
    double pooled_expected = fmax(1.0 - total, 0.0) * SPHERE_DRAWS, pooled_observed = 0.0;
    test_rng rng = {seed};
    for (int i = 0; i < SPHERE_DRAWS; ++i) {
        vec3 d;
        if (!s->draw(s->context, rng_vec2(&rng), &d)) {
            pooled_observed += 1.0;
            continue;
        }
        double phi = (atan2)((double)d[1], (double)d[0]) / (2.0 * pi);
        int x = (int)((phi < 0.0 ? phi + 1.0 : phi) * SPHERE_CELLS_PHI);
        int y = (int)(((double)d[2] + 1.0) * 0.5 * SPHERE_CELLS_Z);
        x = x >= SPHERE_CELLS_PHI ? SPHERE_CELLS_PHI - 1 : x;
        y = y < 0 ? 0 : y >= SPHERE_CELLS_Z ? SPHERE_CELLS_Z - 1 : y;
        observed[y * SPHERE_CELLS_PHI + x] += 1.0;
    }
    double chi2 = 0.0;
    int freedom = -1;
    for (int i = 0; i < SPHERE_CELLS_PHI * SPHERE_CELLS_Z; ++i) {
        if (expected[i] < 5.0) {
            pooled_expected += expected[i];
            pooled_observed += observed[i];
            continue;
        }
        chi2 += (observed[i] - expected[i]) * (observed[i] - expected[i]) / expected[i];
        ++freedom;
    }
    if (pooled_expected > 5.0) {
        chi2 += (pooled_observed - pooled_expected) * (pooled_observed - pooled_expected) / pooled_expected;
        ++freedom;
    } else {
        assert_true(pooled_observed < 40.0);
    }
    return chi2_p_value(chi2, (double)freedom);
}

#endif
