/* water_optics.h - optical properties of water, from spectra to linear Rec.709: absorption, scattering,
 * diffuse reflectance. Reference: docs/ocean.md, "What is computed". */
#ifndef OCEAN_WATER_OPTICS_H
#define OCEAN_WATER_OPTICS_H

#include "facet/facet.h"

typedef struct water_optics {
    float ior;               /* at 550 nm */
    float absorption[3];     /* a, 1/m */
    float scattering[3];     /* b */
    float backscattering[3]; /* b_b */
    float pure_share[3];     /* share of molecular scattering, [0, 1]; the rest is forward, g = 0.92 */
    float reflectance[3];    /* pi R_rs: of deep water, just above the surface, from the spectrum */
    float foam_albedo;
} water_optics;

/* From its spectrum, or the given coefficients. FACET_ERROR_ARGUMENT: a value outside of the range in
 * facet/sea.h. */
facet_result water_optics_create(const facet_water *water, water_optics *out, facet_error *error);

/* Quan and Fry 1995, equation 3; lambda in [400, 700] nm. */
double water_ior(double lambda_nm, double salinity, double temperature_C);

/* Transmittance of white light (D65) through pure water, per channel, from the full spectrum; it may leave
 * the gamut: below 0. */
void pure_water_transmittance(double distance_m, double out[3]);

/* ---- spectra ---- */

/* They span 380 to 720 nm in steps of 5; data tabulated every 10 or 25 nm are interpolated linearly. */
enum { SPECTRUM_FIRST_NM = 380, SPECTRUM_STEP_NM = 5, SPECTRUM_COUNT = 69 };

/* Absorption, scattering and backscattering, 1/m. */
typedef struct water_spectrum {
    double a[SPECTRUM_COUNT], b[SPECTRUM_COUNT], b_b[SPECTRUM_COUNT];
    double b_pure[SPECTRUM_COUNT]; /* molecular part of b */
} water_spectrum;

/* Of the open ocean ("case 1"), by its chlorophyll (mg/m^3), from pure sea water at 0:
 *   a = (a_w + 0.06 A_c C^0.65) (1 + 0.2 e^(-0.014 (lambda - 440))),  b_p = 0.30 C^0.62 (550 / lambda),
 *   b_b = b_w / 2 + (0.002 + 0.02 (1/2 - 1/4 log10 C) (550 / lambda)) b_p
 * Prieur and Sathyendranath 1981; Gordon and Morel 1983; Morel 1988, equations 8, 17 and 18. a_w is Pope
 * and Fry's (1997), b_w Morel's (1974); salinity (g/kg): fresh water scatters 1.3 times less than the
 * sea's 35. */
water_spectrum water_spectrum_case1(double chlorophyll, double salinity);

/* Of Jerlov's types 0 to 9, "I" to "9C": diffuse attenuation K_d (1/m). Jerlov 1976; I to III and 1C as
 * revised by Austin and Petzold
 * 1984. */
enum { JERLOV_COUNT = 10 };
void jerlov_attenuation(int type, double K_d[SPECTRUM_COUNT]);

/* Coefficients with that attenuation: a = 0.86 K_d - b_b, at least pure water's, with the scattering of the
 * open ocean whose K_d is nearest in green and blue. */
water_spectrum water_spectrum_jerlov(int type, double salinity);

/* Diffuse reflectance pi R_rs just above deep water, per wavelength, [0, 1]: u = b_b / (a + b_b), r_rs =
 * (0.0895 + 0.1247 u) u, R_rs = 0.52 r_rs / (1 - 1.7 r_rs). Gordon et al. 1988; Lee et al. 2002, equations
 * 2 and 4. They were fitted to seas; where hardly anything is absorbed, u > 0.92, a diffuser's is larger,
 * and nothing absorbed is all sent back: pi R_rs = 0.52 R / (1 - 0.48 R),
 *   R = 1 + K / S - sqrt((K / S)^2 + 2 K / S),  K / S = a / (2 pi 0.0895 b_b)
 * Kubelka and Munk 1931, with the K / S that meets Gordon's where little is scattered. */
double water_reflectance(double a, double b_b);

/* ---- linear Rec.709 ---- */

/* Color of daylight (D65) multiplied by a spectrum: 1 everywhere is (1, 1, 1). Out-of-gamut values are
 * below 0. */
void spectrum_color(const double spectrum[SPECTRUM_COUNT], double rgb[3]);
/* Color of daylight after a distance (m) in a medium with this attenuation (1/m). */
void spectrum_transmittance(const double attenuation[SPECTRUM_COUNT], double distance_m, double rgb[3]);
/* RGB coefficients (1/m) whose exponentials fit it best, by least squares over distances from 0.5 to 20 m, or
 * to 50 m; negative colors count as 0. */
void spectrum_attenuation(const double attenuation[SPECTRUM_COUNT], double longest_m, double rgb[3]);

#endif
