/* water_optics.h - optical properties of water, from spectra to linear Rec.709: absorption, scattering,
 * diffuse reflectance. Reference: docs/ocean.md, "Water". */
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

/* From water_spectrum.h, or the given coefficients. FACET_ERROR_ARGUMENT: a value outside of the range in
 * facet/sea.h. */
facet_result water_optics_create(const facet_water *water, water_optics *out, facet_error *error);

/* Quan and Fry 1995, equation 3; lambda in [400, 700] nm. */
double water_ior(double lambda_nm, double salinity, double temperature_C);

/* Transmittance of white light (D65) through pure water, per channel, from the full spectrum; it may leave
 * the gamut: below 0. */
void pure_water_transmittance(double way_m, double out[3]);

#endif
