/* sky_luts.h - the LUTs of shade/sky.h, ray marching with them, and the sky-view LUT of a point. Spectra have
 * six wavelengths in two halves, relative to the sun; sky_color() adds them up. */
#ifndef IBL_SKY_LUTS_H
#define IBL_SKY_LUTS_H

#include "facet/facet.h"

#include "shade/shade.h"

enum { SKY_HALVES = 2 };

typedef struct sky_luts {
    Atmosphere air[SKY_HALVES];
    vec3 *columns; /* COLUMN_TABLE_HEIGHT rows of COLUMN_TABLE_WIDTH: air_column() */
    /* Approximate illuminance of the ground by the sky, by the sun's angle as in bounces */
    vec3 skies[SKY_HALVES][BOUNCE_TABLE_SIZE];
    AirField *bounces[SKY_HALVES]; /* BOUNCE_TABLE_SIZE rows of as many: air_bounce_field() */
} sky_luts;

/* A view ray and the sun. */
typedef struct sky_ray {
    float height_km, mu;     /* origin height and direction */
    float mu_sun, cos_angle; /* cosines of the sun from the zenith at the origin, and from the ray */
} sky_ray;

/* LUTs of an atmosphere (both halves of atmosphere_earth(), or hazier). thread_count 0: facet_thread_count().
 * FACET_ERROR_MEMORY. */
facet_result sky_luts_create(const Atmosphere air[SKY_HALVES], const facet_allocator *allocator,
                             uint32_t thread_count, sky_luts *out, facet_error *error);
void sky_luts_destroy(sky_luts *t); /* {0} is allowed */

/* The Earth's atmosphere of turbidity [1, 10] over a ground. */
void sky_atmosphere(float turbidity, const float ground_albedo[3], Atmosphere air[SKY_HALVES]);

/* In-scattering along the first length_km of a ray. */
void sky_march(const sky_luts *t, const sky_ray *ray, float length_km, int steps, AirLight out[SKY_HALVES]);

/* Irradiance of horizontal ground by the sky without the sun, relative to the sun outside of the atmosphere. */
void sky_irradiance(const sky_luts *t, float mu_sun, vec3 out[SKY_HALVES]);

/* Linear Rec.709 in lx or cd/m^2. */
static inline vec3 sky_color(const sky_luts *t, const vec3 share[SKY_HALVES])
{
    return atmosphere_color(t->air[0], share[0]) + atmosphere_color(t->air[1], share[1]);
}

/* ---- the view from a point ----
 *
 * Radiance of the atmosphere without the phase functions of single scattering, which are sharp, and without
 * the sun's disc. The rest is smooth except at the horizon, where rows are densest. */

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
