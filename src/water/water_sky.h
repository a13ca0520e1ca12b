/* water_sky.h - the light of a sea: the sky around it or an image in its place, the sun, and the air between
 * sea and eye.
 *
 * The sky is the atmosphere of ibl/sky_luts.h. Reflections use the prefiltered sky (ibl/ibl.h) with its upper
 * half mirrored below the horizon: where a lobe dips below the horizon, it finds the radiance just above.
 * Interreflection between waves is modelled by the surface. */
#ifndef WATER_WATER_SKY_H
#define WATER_WATER_SKY_H

#include "ibl/ibl.h"
#include "ibl/sky_image.h"
#include "ibl/sky_luts.h"

#include "shade/shade.h"

enum { WATER_SKY_DISTANCES = 257 };

typedef struct water_sky {
    bool has_views; /* the sky is the atmosphere; else an image */
    Atmosphere air[SKY_HALVES];
    sky_luts tables;      /* has_views */
    sky_view eye;         /* seen from the eye; below the horizon, the input of water_sky_air_light() */
    vec3 *air_light;      /* has_views: water_sky_air_light() */
    sky_view low;         /* seen from the surface, where the eye is far above it; else {0} */
    sky_sun_light disc;   /* has_views: seen from the eye */
    vec3 disc_radiance;   /* of other suns */
    float disc_radius;    /* rad; 0: not visible */
    double sun_longitude; /* from +X towards +Z */
    facet_environment *mirrored;
    const ibl_light *reflected, *background; /* background: of an image as environment, else NULL */
    float rotation_cos, rotation_sin;        /* of the image */
    float scale;                             /* of all radiance */
    float eye_km;                            /* height of the eye view */
    float horizon_mu, horizon_rad;           /* of the horizon from there: cosine and zenith angle */
    vec3 transmittance[WATER_SKY_DISTANCES]; /* transmittance of the air between eye and sea, by distance */
    vec3 white;                              /* color of sunlight outside the air, lx */
    vec3 L;                                  /* towards the sun, unit */
    vec3 sun_irradiance;                     /* lx, facing it, at the sea */
    vec3 sky_irradiance;                     /* lx, on a horizontal plane */
} water_sky;

/* The view that lights the surface. */
static inline const sky_view *water_sky_low(const water_sky *s)
{
    return s->low.rows ? &s->low : &s->eye;
}

/* For a resolved desc, seen from a height; rows_per_rad: resolution of the image, in pixels. To be destroyed
 * even after a failure. FACET_ERROR_MEMORY, _ARGUMENT: a value of desc->sky. */
facet_result water_sky_create(const facet_render_desc *desc, float eye_height_m, float rows_per_rad,
                              water_sky *out, facet_error *error);
void water_sky_destroy(water_sky *s); /* {0} is allowed */

/* Radiance (cd/m^2) of the sky with the sun's disc in the unit direction d; below the horizon, that at the
 * horizon. */
vec3 water_sky_seen(const water_sky *s, vec3 d);
/* Radiance of the sun's disc alone. */
vec3 water_sky_disc(const water_sky *s, vec3 d);

/* Prefiltered radiance around the unit direction R (below the horizon: mirrored) for a perceptual roughness,
 * without the sun. */
vec3 water_sky_reflected(const water_sky *s, vec3 R, float perceptual_roughness);

/* Radiance of a view with the zenith angle clamped between two angles (rad), and of the prefiltered image. */
vec3 water_sky_view(const water_sky *s, const sky_view *v, vec3 d, float least_angle, float most_angle);
vec3 water_sky_prefiltered(const water_sky *s, vec3 d, float perceptual_roughness);

/* ---- water_air.c ---- */

/* Fill the LUTs of water_sky_air() and water_sky_air_light() for the eye view. FACET_ERROR_MEMORY. */
void water_sky_fill_transmittance(water_sky *s);
facet_result water_sky_fill_air(water_sky *s, const facet_allocator *allocator, uint32_t thread_count,
                                facet_error *error);

/* In-scattered radiance between eye and sea along d over (1 - transmittance), cd/m^2; above the horizon, that
 * at the horizon. */
vec3 water_sky_air_light(const water_sky *s, vec3 d);

/* The air between the eye and a point at distance_m along the unit direction d and height_m high. */
typedef struct water_air {
    vec3 transmittance; /* of white light */
    vec3 light;         /* in-scattered radiance, cd/m^2 */
} water_air;
water_air water_sky_air(const water_sky *s, vec3 d, float distance_m, float height_m);

#endif
