/* sky_view.h - the sky-view LUT of an eye point: radiance of the atmosphere without the phase functions of
 * single scattering, which are sharp, and without the sun's disc. The rest is smooth except at the horizon,
 * where rows are densest. */
#ifndef IBL_SKY_VIEW_H
#define IBL_SKY_VIEW_H

#include "ibl/sky_luts.h"

enum {
    SKY_VIEW_UP = 128,     /* rows from the horizon to the zenith */
    SKY_VIEW_DOWN = 48,    /* rows from the horizon to the nadir */
    SKY_VIEW_AZIMUTHS = 33 /* from the sun's azimuth to the opposite one */
};

/* Linear Rec.709: cd/m^2, the first two per phase function. */
typedef struct sky_light {
    vec3 rayleigh, haze, rest;
} sky_light;

typedef struct sky_view {
    float height_km, mu_sun;
    float haze_g;
    sky_light *rows; /* SKY_VIEW_UP, then SKY_VIEW_DOWN; the first of each is the horizon */
} sky_view;

/* For an eye altitude_km above the ground. FACET_ERROR_MEMORY. */
facet_result sky_view_create(const sky_luts *tables, float altitude_km, float sun_elevation_rad,
                             const facet_allocator *allocator, uint32_t thread_count, sky_view *out,
                             facet_error *error);
void sky_view_destroy(sky_view *v); /* {0} is allowed */

/* A row at a zenith angle, for all azimuths. Interpolated by Catmull and Rom's cubic, never below 0. */
void sky_view_fetch_row(const sky_view *v, float zenith_angle, sky_light out[SKY_VIEW_AZIMUTHS]);

/* Position of an azimuth in a row. */
typedef struct sky_azimuth {
    int nodes[4];
    float weights[4];
    float cosine;
} sky_azimuth;
sky_azimuth sky_view_azimuth(double radians); /* from the sun's azimuth, any angle */

/* Radiance; cos_angle: between direction and sun. */
vec3 sky_view_radiance(const sky_view *v, const sky_light row[SKY_VIEW_AZIMUTHS], const sky_azimuth *azimuth,
                       float cos_angle);
/* The same for one direction without its row, at about a tenth of the cost of a row. */
vec3 sky_view_at(const sky_view *v, float zenith_angle, const sky_azimuth *azimuth, float cos_angle);

#endif
