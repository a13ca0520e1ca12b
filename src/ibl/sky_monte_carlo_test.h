/* sky_monte_carlo_test.h - for tests: radiance of the atmosphere at one wavelength, in double,
 * independently of the renderer: single scattering by direct integration, all orders by delta tracking
 * from the eye (Woodcock) with the sun sampled at each collision. */
#ifndef IBL_SKY_MONTE_CARLO_TEST_H
#define IBL_SKY_MONTE_CARLO_TEST_H

#include <math.h>
#include <stdbool.h>
#include <stdint.h>

#define MC_GROUND 6360.0
#define MC_TOP 6460.0
#define MC_PI 3.14159265358979323846

/* 1/km at the ground (ozone: at 25 km). */
typedef struct mc_air {
    double rayleigh, haze_scattering, haze_extinction, haze_g, ozone, ground_albedo;
} mc_air;

/* xorshift64, Marsaglia 2003. */
static double mc_random(uint64_t *state)
{
    *state ^= *state << 13;
    *state ^= *state >> 7;
    *state ^= *state << 17;
    return (double)(*state >> 11) * 0x1p-53;
}

static double mc_dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static double mc_height(const double p[3])
{
    return fmax(sqrt(mc_dot(p, p)) - MC_GROUND, 0.0);
}

static void mc_move(double p[3], const double d[3], double t)
{
    for (int i = 0; i < 3; i++)
        p[i] += t * d[i];
}

/* Scattering of molecules and of haze, and extinction of all. */
static void mc_coefficients(const mc_air *a, double h, double out[3])
{
    double ozone = fmax(0.0, 1.0 - fabs(h - 25.0) / 15.0);
    out[0] = a->rayleigh * exp(-h / 8.0);
    out[1] = a->haze_scattering * exp(-h / 1.2);
    out[2] = out[0] + a->haze_extinction * exp(-h / 1.2) + a->ozone * ozone;
}

/* Length of a ray in the air; *is_ground: it ends at the ground. */
static double mc_length(const double p[3], const double d[3], bool *is_ground)
{
    double b = mc_dot(p, d), r2 = mc_dot(p, p);
    double ground = b * b - r2 + MC_GROUND * MC_GROUND;
    *is_ground = b < 0.0 && ground >= 0.0;
    return *is_ground ? fmax(-b - sqrt(ground), 0.0) : -b + sqrt(b * b - r2 + MC_TOP * MC_TOP);
}

static double mc_transmittance(const mc_air *a, const double p[3], const double d[3], double length,
                               int steps)
{
    double sum = 0.0;
    for (int i = 0; i < steps; i++) {
        double from = length * i * i / ((double)steps * steps);
        double to = length * (i + 1) * (i + 1) / ((double)steps * steps);
        double q[3] = {p[0], p[1], p[2]}, c[3];
        mc_move(q, d, 0.5 * (from + to));
        mc_coefficients(a, mc_height(q), c);
        sum += c[2] * (to - from);
    }
    return exp(-sum);
}

static double mc_sun(const mc_air *a, const double p[3], const double sun[3])
{
    bool is_ground;
    double length = mc_length(p, sun, &is_ground);
    return is_ground ? 0.0 : mc_transmittance(a, p, sun, length, 60);
}

static double mc_phase_rayleigh(double c)
{
    return 3.0 / (16.0 * MC_PI) * (1.0 + c * c);
}
static double mc_phase_haze(double c, double g)
{
    return (1.0 - g * g) / (4.0 * MC_PI * pow(1.0 + g * g - 2.0 * g * c, 1.5));
}

/* Light scattered once, per illuminance of the sun outside, by direct integration. */
static inline double mc_single(const mc_air *a, const double eye[3], const double d[3], const double sun[3])
{
    enum { STEPS = 2000 };
    bool is_ground;
    double length = mc_length(eye, d, &is_ground), c = mc_dot(d, sun), depth = 0.0, sum = 0.0;
    for (int i = 0; i < STEPS; i++) {
        double from = length * i * i / ((double)STEPS * STEPS);
        double to = length * (i + 1) * (i + 1) / ((double)STEPS * STEPS);
        double p[3] = {eye[0], eye[1], eye[2]}, k[3];
        mc_move(p, d, 0.5 * (from + to));
        mc_coefficients(a, mc_height(p), k);
        double source = k[0] * mc_phase_rayleigh(c) + k[1] * mc_phase_haze(c, a->haze_g);
        sum += source * mc_sun(a, p, sun) * exp(-depth - 0.5 * k[2] * (to - from)) * (to - from);
        depth += k[2] * (to - from);
    }
    return sum;
}

/* Turns d by an angle of the given cosine, into a random azimuth. */
static void mc_turn(double d[3], double cosine, uint64_t *random)
{
    double s = d[2] < 0.0 ? -1.0 : 1.0, k = -1.0 / (s + d[2]), q = d[0] * d[1] * k;
    double t[3] = {1.0 + s * d[0] * d[0] * k, s * q, -s * d[0]}, b[3] = {q, s + d[1] * d[1] * k, -d[1]};
    double sine = sqrt(fmax(1.0 - cosine * cosine, 0.0)), phi = 2.0 * MC_PI * mc_random(random), norm = 0.0;
    for (int i = 0; i < 3; i++) {
        d[i] = d[i] * cosine + sine * (cos(phi) * t[i] + sin(phi) * b[i]);
        norm += d[i] * d[i];
    }
    for (int i = 0; i < 3; i++)
        d[i] /= sqrt(norm);
}

static double mc_scattering_cosine(bool is_haze, double g, uint64_t *random)
{
    if (is_haze) {
        double k = (1.0 - g * g) / (1.0 - g + 2.0 * g * mc_random(random));
        return (1.0 + g * g - k * k) / (2.0 * g);
    }
    for (;;) {
        double c = 2.0 * mc_random(random) - 1.0;
        if (2.0 * mc_random(random) <= 1.0 + c * c)
            return c;
    }
}

/* Advances to the next collision; false: there is none within length. */
static bool mc_collide(const mc_air *a, double p[3], const double d[3], double length, uint64_t *random)
{
    double nearest = fmin(fmax(-mc_dot(p, d), 0.0), length), lowest[3] = {p[0], p[1], p[2]}, k[3];
    mc_move(lowest, d, nearest);
    mc_coefficients(a, fmax(mc_height(lowest) - 1e-5, 0.0), k);
    double most = k[2] + a->ozone, t = 0.0;
    for (;;) {
        t -= log(1.0 - mc_random(random)) / most;
        if (t >= length)
            return false;
        double q[3] = {p[0], p[1], p[2]};
        mc_move(q, d, t);
        mc_coefficients(a, mc_height(q), k);
        if (mc_random(random) * most < k[2]) {
            mc_move(p, d, t);
            return true;
        }
    }
}

/* One path; all orders of scattering. */
static double mc_path(const mc_air *a, const double eye[3], const double direction[3], const double sun[3],
                      uint64_t *random)
{
    double p[3] = {eye[0], eye[1], eye[2]}, d[3] = {direction[0], direction[1], direction[2]};
    double weight = 1.0, L = 0.0;
    for (int order = 0; order < 100; order++) {
        bool is_ground;
        double length = mc_length(p, d, &is_ground), k[3];
        if (mc_collide(a, p, d, length, random)) {
            mc_coefficients(a, mc_height(p), k);
            double c = mc_dot(d, sun), both = k[0] + k[1];
            weight *= both / k[2];
            L += weight * mc_sun(a, p, sun) *
                 (k[0] * mc_phase_rayleigh(c) + k[1] * mc_phase_haze(c, a->haze_g)) / both;
            mc_turn(d, mc_scattering_cosine(mc_random(random) * both >= k[0], a->haze_g, random), random);
        } else if (is_ground) {
            mc_move(p, d, length);
            double r = sqrt(mc_dot(p, p));
            for (int i = 0; i < 3; i++) {
                d[i] = p[i] / r;
                p[i] = d[i] * (MC_GROUND + 1e-7);
            }
            weight *= a->ground_albedo;
            L += weight / MC_PI * fmax(mc_dot(d, sun), 0.0) * mc_sun(a, p, sun);
            mc_turn(d, sqrt(mc_random(random)), random);
        } else {
            break;
        }
        if (weight < 0.05) { /* Russian roulette */
            if (mc_random(random) < 0.5)
                break;
            weight *= 2.0;
        }
    }
    return L;
}

/* Radiance per illuminance of the sun outside; *deviation: standard deviation of it. */
static inline double mc_radiance(const mc_air *a, const double eye[3], const double d[3], const double sun[3],
                                 int paths, uint64_t seed, double *deviation)
{
    double sum = 0.0, squares = 0.0;
    for (int i = 0; i < paths; i++) {
        double L = mc_path(a, eye, d, sun, &seed);
        sum += L;
        squares += L * L;
    }
    double mean = sum / paths;
    *deviation = sqrt(fmax(squares / paths - mean * mean, 0.0) / paths);
    return mean;
}

#endif
