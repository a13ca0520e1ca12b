/* water_optics.h - what water does to light, from spectra to linear Rec.709: absorption, scattering, color of the depth.
 * Reference: docs/ocean.md, "Water". */
#ifndef OCEAN_WATER_OPTICS_H
#define OCEAN_WATER_OPTICS_H

#include "facet/facet.h"

typedef struct water_optics {
    float ior;               /* at 550 nm */
    float absorption[3];     /* a, 1/m */
    float scattering[3];     /* b */
    float backscattering[3]; /* b_b */
    float pure_share[3];  /* of scattering that is the water's own, [0, 1]; the rest goes forward, g = 0.92 */
    float reflectance[3]; /* pi R_rs: of deep water, just above the surface, computed per wavelength */
    float foam_albedo;
} water_optics;

/* By water_spectrum.h, or coefficients as they are given. FACET_ERROR_ARGUMENT: a number outside of the range that facet.h gives. */
facet_result water_optics_create(const facet_water *water, water_optics *out, facet_error *error);

/* Quan and Fry 1995, equation 3; lambda in [400, 700] nm. */
double water_ior(double lambda_nm, double salinity, double temperature_C);

/* Share of white light (D65) left after a way through pure water, per channel, by the whole spectrum; it may leave the gamut: below 0. */
void pure_water_transmittance(double way_m, double out[3]);

#endif
