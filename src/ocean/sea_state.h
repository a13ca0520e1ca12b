/* sea_state.h - the statistics of the waves: how the variance of elevation is distributed over frequency and
 * direction. Nothing here is random; waves.h samples a sea from it.
 *
 * SI units. Angles from +X towards +Z, in which waves travel. Double precision, as spectral tails span many
 * decades. */
#ifndef OCEAN_SEA_STATE_H
#define OCEAN_SEA_STATE_H

#include <math.h>

#include "facet/facet.h"

#define GRAVITY 9.81                        /* m/s^2 */
#define SURFACE_TENSION_OVER_DENSITY 7.2e-5 /* m^3/s^2, sea water */
#define ENDLESS ((double)INFINITY)          /* an infinite depth or wavenumber */
#define SHORTEST_WAVE_K 3000.0              /* rad/m: 2 mm; viscosity damps shorter waves */

enum { SEA_SYSTEMS = 2, SEA_MAX_BANDS = 4 };

/* A wave system: wind sea or swell. Without wind or height, peak_omega is 0 and there are no waves. */
typedef struct wave_system {
    facet_sea_spectrum spectrum;
    facet_sea_spreading spreading;
    double peak_omega;  /* rad/s */
    double alpha;       /* Phillips' constant */
    double gamma;       /* peakedness */
    double direction;   /* rad */
    double wind_mps;    /* of a wind sea; 0 for swell */
    double inverse_age; /* U omega_p / g; Elfouhaily's Omega */
    double elongation;  /* of crests, [0, 1] */
    double scale;       /* of the density: 1, less where waves would exceed the water depth */
} wave_system;

/* Tiles, the longest first, and their wavenumbers: k_from <= k < k_to, without gap or overlap. */
typedef struct sea_bands {
    uint32_t count; /* 0: there are no waves */
    double length_m[SEA_MAX_BANDS];
    double k_from[SEA_MAX_BANDS], k_to[SEA_MAX_BANDS]; /* rad/m */
} sea_bands;

typedef struct sea_state {
    wave_system systems[SEA_SYSTEMS]; /* wind sea, swell */
    double depth_m;                   /* INFINITY: deep */
    double wind_mps, wind_direction;
    /* Beyond taper_k the wind sea's density is multiplied by taper, [0, 1]: in light airs, where the
     * formulas give steeper tails than Cox and Munk measured. */
    double taper_k, taper;
    sea_bands bands;
} sea_state;

/* FACET_ERROR_ARGUMENT: a value outside of the range in facet/sea.h; the message names it. */
facet_result sea_state_create(const facet_sea_desc *desc, sea_state *out, facet_error *error);

/* Tiles for waves whose longest peak is at peak_k: the first is eight peak wavelengths long; each next one
 * takes over where the previous one has fewer than four samples per wave. */
sea_bands sea_bands_make(double peak_k, uint32_t resolution, uint32_t count);

/* ---- dispersion ---- */

/* omega^2 = (g k + tau k^3 / rho) tanh(k depth); k in rad/m. */
double wave_omega(double k, double depth_m);
double wave_domega_dk(double k, double depth_m);
double wave_k(double omega, double depth_m); /* the inverse, by Newton's method */
/* Ratio of horizontal to vertical orbital motion at the surface: coth(k depth), 1 in deep water. */
double wave_stretch(double k, double depth_m);

/* ---- spectra ---- */

/* Variance density of elevation over omega, m^2 s. */
double wave_spectrum(const wave_system *w, double omega, double depth_m);

/* Directional distribution at one frequency; kept, as its norm is expensive. */
typedef struct wave_directions {
    facet_sea_spreading spreading;
    double norm;  /* normalization */
    double power; /* Hasselmann: s; Donelan and Banner: beta; Elfouhaily: Delta */
} wave_directions;
wave_directions wave_directions_at(const wave_system *w, double omega);
/* Density over theta relative to the system's direction, 1/rad: the integral over [-pi, pi] is 1. */
double wave_directions_density(const wave_directions *d, double theta);
/* Both steps in one. */
double wave_spreading(const wave_system *w, double omega, double theta);

/* All systems at one wavenumber, k > 0. */
typedef struct sea_ring {
    double density[SEA_SYSTEMS]; /* over the wave vector plane, m^4, without the directional factor */
    wave_directions directions[SEA_SYSTEMS];
    double direction[SEA_SYSTEMS];
} sea_ring;
sea_ring sea_ring_at(const sea_state *s, double k);
double sea_ring_density(const sea_ring *r, double theta); /* theta in world axes */

/* Variance density over wave vectors, m^4: its integral over the plane is the variance of elevation. k > 0. */
double sea_density(const sea_state *s, double kx, double kz);

/* Integrals of sea_density over from <= k < to (rad/m), to at most SHORTEST_WAVE_K. */
typedef struct sea_moments {
    double height;      /* variance, m^2 */
    double k;           /* of k times wave_stretch(): by which choppiness lowers the mean level */
    double slope[3];    /* of k_x^2, k_z^2, k_x k_z: slope variances, in world axes */
    double k4;          /* of k^4 (1/m^2): curvature, for glints */
    double omega2_k2;   /* of omega^2 k^2 (1/s^2) */
    double convergence; /* of (k wave_stretch())^2: variance of the convergence of a sea of choppiness 1 */
} sea_moments;
sea_moments sea_state_moments(const sea_state *s, double from, double to);
/* Of one system. */
sea_moments sea_system_moments(const sea_state *s, uint32_t system, double from, double to);
/* Peak wavenumber (rad/m) of the higher system; 0: no waves. */
double sea_state_peak_k(const sea_state *s);

/* ---- measured seas ---- */

/* Slope variance of a clean sea along and across the wind, whose sum is 0.003 + 0.00512 U (Cox and Munk
 * 1954). Below 1 m/s, where they have no data, the 0.003 falls to 0: without wind the sea is a mirror. */
void cox_munk_slopes(double wind_mps, double out[2]);
/* Whitecap coverage, [0, 0.9], as some water is visible in any wind: 3.84e-6 U^3.41 (Monahan and
 * O'Muircheartaigh 1980) from 5 m/s on. Below 3.7 m/s no crest breaks (Callaghan et al. 2008, whose law
 * begins there); smooth in between. */
double whitecap_coverage(double wind_mps);

/* Whether there is a bed; one that is infinitely deep is none. */
static inline bool sea_has_bed(const facet_sea_bed *bed)
{
    return bed->depth_m > 0.0f && isfinite(bed->depth_m);
}

#endif
