/* sky_luts.h - the tables that shade/sky.h asks for, and rays marched with them. Light is kept as the share of six wavelengths
 * in two halves; sky_color() adds them up. */
#ifndef IBL_SKY_LUTS_H
#define IBL_SKY_LUTS_H

#include "facet/facet.h"

#include "shade/shade.h"

enum { SKY_HALVES = 2 };

typedef struct sky_luts {
    Atmosphere air[SKY_HALVES];
    vec3 *columns; /* COLUMN_TABLE_HEIGHT rows of COLUMN_TABLE_WIDTH: air_column() */
    vec3 skies
        [SKY_HALVES]
        [BOUNCE_TABLE_SIZE]; /* illuminance of the ground by the sky, about; over the sun as in bounces */
    AirField *bounces[SKY_HALVES]; /* BOUNCE_TABLE_SIZE rows of as many: air_bounce_field() */
} sky_luts;

/* A ray of the eye and the sun. */
typedef struct sky_ray {
    float height_km, mu;     /* where it begins, where it goes */
    float mu_sun, cos_angle; /* of the sun from straight up at the beginning, and from the ray */
} sky_ray;

/* For an atmosphere (atmosphere_earth() of both halves, or more haze). thread_count 0: facet_thread_count(). FACET_ERROR_MEMORY. */
facet_result sky_luts_create(const Atmosphere air[SKY_HALVES], const facet_allocator *allocator,
                             uint32_t thread_count, sky_luts *out, facet_error *error);
void sky_luts_destroy(sky_luts *t); /* {0} is allowed */

/* The Earth's atmosphere of turbidity [1, 10] over a ground. */
void sky_atmosphere(float turbidity, const float ground_albedo[3], Atmosphere air[SKY_HALVES]);

/* Share of sunlight that arrives at a height, sun_visibility() included. */
void sky_sun(const sky_luts *t, float height_km, float mu_sun, vec3 out[SKY_HALVES]);

/* Light scattered towards the beginning of a ray over its first length_km. */
void sky_march(const sky_luts *t, const sky_ray *ray, float length_km, int steps, AirLight out[SKY_HALVES]);

/* Irradiance of a level place on the ground by the sky without the sun, share of the sun's outside. */
void sky_irradiance(const sky_luts *t, float mu_sun, vec3 out[SKY_HALVES]);

/* Linear Rec.709 in lx or cd/m^2. */
static inline vec3 sky_color(const sky_luts *t, const vec3 share[SKY_HALVES])
{
    return atmosphere_color(t->air[0], share[0]) + atmosphere_color(t->air[1], share[1]);
}

#endif
