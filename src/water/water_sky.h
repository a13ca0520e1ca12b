/* water_sky.h - what lights a sea: the sky around it, or a picture in its place, the sun, and the air between the sea and the eye.
 *
 * The sky is the atmosphere of ibl/sky_tables.h. Reflections look it up filtered (ibl/ibl.h) with its upper half mirrored below the
 * horizon: a lobe that dips below it finds there what it would find just above, and which share of light comes from other waves
 * in fact is the surface's matter. Holds shared shading text: include it last. */
#ifndef WATER_WATER_SKY_H
#define WATER_WATER_SKY_H

#include "ibl/ibl.h"
#include "ibl/sky_sun.h"
#include "ibl/sky_view.h"

#include "shade/shade.h"

typedef struct water_sky {
    bool has_views; /* the sky is the atmosphere's; else a picture */
    Atmosphere air[SKY_HALVES];
    sky_tables tables;    /* has_views */
    sky_view eye;         /* as the eye sees it; below the horizon, what the air before the sea shines with */
    sky_view low;         /* as the surface does, where the eye is far above it; else {0} */
    sky_sun_light disc;   /* has_views: as the eye sees it */
    vec3 disc_radiance;   /* the other suns' */
    float disc_radius;    /* rad; 0: there is none to be seen */
    double sun_longitude; /* from +X towards +Z */
    facet_environment *mirrored;
    const ibl_light *reflected, *background; /* background: of a picture, else NULL */
    float rotation_cos, rotation_sin;        /* of the picture */
    float scale;                             /* of all light */
    float eye_km;                            /* height that eye is made for */
    float horizon_mu, horizon_rad;           /* where that eye sees it: cosine and angle from the zenith */
    vec2 density_to_sea;                     /* water_sky_density() from there down to the sea */
    vec3 white;                              /* color of sunlight outside the air, lx */
    vec3 L;                                  /* to the sun, unit */
    vec3 sun_irradiance;                     /* lx, facing it, at the sea */
    vec3 sky_irradiance;                     /* lx, on a horizontal plane */
} water_sky;

/* What lights the surface itself. */
static inline const sky_view *water_sky_low(const water_sky *s)
{
    return s->low.rows ? &s->low : &s->eye;
}

/* For a desc whose members are resolved, seen from a height; rows_per_rad: pixels, how fine a picture is seen. What comes back, even
 * after a failure, is to be destroyed. FACET_ERROR_MEMORY, _ARGUMENT: a number in desc->sky. */
facet_result water_sky_create(const facet_sea_render_desc *desc, float eye_height_m, float rows_per_rad,
                              water_sky *out, facet_error *error);
void water_sky_destroy(water_sky *s); /* {0} is allowed */

/* Radiance (cd/m^2) that the eye sees in the unit direction d, which does not meet the sea; below the horizon, that of the
 * horizon. With the sun's disc. */
vec3 water_sky_seen(const water_sky *s, vec3 d);
/* That of the sun's disc alone. */
vec3 water_sky_disc(const water_sky *s, vec3 d);

/* Radiance around the unit direction R (below the horizon: mirrored) over the lobe of a perceptual roughness, without the sun. */
vec3 water_sky_reflected(const water_sky *s, vec3 R, float perceptual_roughness);

/* Mean densities between two heights (km), over those at the sea: of air and of haze. */
vec2 water_sky_density(float a_km, float b_km);

/* The air on the way from the eye along the unit direction d to what is distance_m away, height_m high. */
typedef struct water_air {
    vec3 transmittance; /* share of white light */
    vec3 light;         /* cd/m^2 that it adds */
} water_air;
water_air water_sky_air(const water_sky *s, vec3 d, float distance_m, float height_m);
/* Share of white light that the way from the eye along d to the level of the sea loses; as far as the horizon where it does not meet it. For
 * an atmosphere's sky. */
vec3 water_sky_lost(const water_sky *s, vec3 d);

#endif
