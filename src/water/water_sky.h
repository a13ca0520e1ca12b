/* water_sky.h - what lights a sea: the sky around it, or a picture in its place, the sun, and the air between the sea and the eye.
 *
 * The sky is the atmosphere of ibl/sky_luts.h. Reflections look it up filtered (ibl/ibl.h) with its upper half mirrored below the
 * horizon: a lobe that dips below it finds there what it would find just above, and which share of light comes from other waves
 * in fact is the surface's matter. */
#ifndef WATER_WATER_SKY_H
#define WATER_WATER_SKY_H

#include "ibl/ibl.h"
#include "ibl/sky_image.h"
#include "ibl/sky_view.h"

#include "shade/shade.h"

enum { WATER_SKY_WAYS = 257 };

typedef struct water_sky {
    bool has_views; /* the sky is the atmosphere's; else a picture */
    Atmosphere air[SKY_HALVES];
    sky_luts tables;      /* has_views */
    sky_view eye;         /* as the eye sees it; below the horizon, what water_sky_air_light() is made of */
    vec3 *air_light;      /* has_views: water_sky_air_light() */
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
    vec3 left[WATER_SKY_WAYS];               /* share that the air leaves from there to the sea, by the way */
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
facet_result water_sky_create(const facet_render_desc *desc, float eye_height_m, float rows_per_rad,
                              water_sky *out, facet_error *error);
void water_sky_destroy(water_sky *s); /* {0} is allowed */

/* Radiance (cd/m^2) that the eye sees in the unit direction d, which does not meet the sea; below the horizon, that of the
 * horizon. With the sun's disc. */
vec3 water_sky_seen(const water_sky *s, vec3 d);
/* That of the sun's disc alone. */
vec3 water_sky_disc(const water_sky *s, vec3 d);

/* Radiance around the unit direction R (below the horizon: mirrored) over the lobe of a perceptual roughness, without the sun. */
vec3 water_sky_reflected(const water_sky *s, vec3 R, float perceptual_roughness);

/* Radiance of a view in a direction between two angles from the zenith (rad), and of the filtered picture. */
vec3 water_sky_view(const water_sky *s, const sky_view *v, vec3 d, float least_angle, float most_angle);
vec3 water_sky_picture(const water_sky *s, vec3 d, float perceptual_roughness);

/* ---- water_air.c ---- */

/* Make what water_sky_air() looks up, and water_sky_air_light(), of the eye's view. FACET_ERROR_MEMORY. */
void water_sky_fill_ways(water_sky *s);
facet_result water_sky_fill_air(water_sky *s, const facet_allocator *allocator, uint32_t thread_count,
                                facet_error *error);

/* Light of the air before the sea along d, over the share of light that is lost there: cd/m^2. Above the horizon, that of the horizon. */
vec3 water_sky_air_light(const water_sky *s, vec3 d);

/* The air on the way from the eye along the unit direction d to what is distance_m away, height_m high. */
typedef struct water_air {
    vec3 transmittance; /* share of white light */
    vec3 light;         /* cd/m^2 that it adds */
} water_air;
water_air water_sky_air(const water_sky *s, vec3 d, float distance_m, float height_m);

#endif
