/* sky_luts.h - the LUTs of shade/sky.h, and ray marching with them. Spectra have six wavelengths in two
 * halves, relative to the sun; sky_color() adds them up. */
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

/* Transmittance from the sun to a height, including sun_visibility(). */
void sky_sun(const sky_luts *t, float height_km, float mu_sun, vec3 out[SKY_HALVES]);

/* In-scattering along the first length_km of a ray. */
void sky_march(const sky_luts *t, const sky_ray *ray, float length_km, int steps, AirLight out[SKY_HALVES]);

/* Irradiance of horizontal ground by the sky without the sun, relative to the sun outside of the atmosphere. */
void sky_irradiance(const sky_luts *t, float mu_sun, vec3 out[SKY_HALVES]);

/* Linear Rec.709 in lx or cd/m^2. */
static inline vec3 sky_color(const sky_luts *t, const vec3 share[SKY_HALVES])
{
    return atmosphere_color(t->air[0], share[0]) + atmosphere_color(t->air[1], share[1]);
}

#endif
