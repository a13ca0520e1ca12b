/* water_setup.h - everything that is prepared for one image of a sea before rays are traced. */
#ifndef WATER_WATER_SETUP_H
#define WATER_WATER_SETUP_H

#include "draw/camera_rays.h"
#include "ocean/caustic_map.h"
#include "ocean/sea.h"
#include "ocean/waves_foam.h"
#include "water/bed_shadow.h"
#include "water/water_light.h"
#include "water/water_model.h"
#include "water/water_profile.h"

typedef struct water_setup {
    const facet_sea *sea;
    const facet_render_desc *desc;
    camera_rays camera;
    float footprint;    /* of a sample, relative to its pixel */
    bool is_below;      /* the eye is in the water */
    water_cache *cache; /* owns what sky points to */
    water_march march;
    water_profile profile;
    waves_foam foam; /* of crests that broke */
    water_sky sky;   /* the cache's */
    water_model model;
    water_table table; /* of means over microfacets; the cache's */
    Water water;
    WaterLight light;
    vec3 beam;            /* irradiance across the sun's beam just below the surface, lx */
    vec3 sunward;         /* unit direction to the sun, below the surface */
    caustic_map caustics; /* of the bed */
    bed_shadow shadow;    /* of the model on the bed */
    /* slope covariance in place of the waves finer than all tiles; xx < 0: by their spectrum */
    vec3 roughness;
    WaterCrest crest; /* sunlight through waves */
    /* per WATER_OBJECT_ constant that the sea has; NULL: not needed by any layer */
    struct scene_identity *identities;
    float exposure;  /* 2^exposure_ev */
    float shutter_s; /* exposure time of glints */
} water_setup;

/* What not every renderer needs. */
enum {
    WATER_SETUP_PROFILE = 1u << 0,   /* bounds of waves for the rays of the camera */
    WATER_SETUP_BED_LIGHT = 1u << 1, /* caustics and the model's shadow on the bed; path tracing finds them */
    WATER_SETUP_MODEL_LIGHT =
        1u << 2, /* the environment of the model; without it the model can only be hit */
    WATER_SETUP_ALL = WATER_SETUP_PROFILE | WATER_SETUP_BED_LIGHT | WATER_SETUP_MODEL_LIGHT
};

/* Not to be moved between create and destroy, which is due even after a failure. scene NULL: water only.
 * Nothing else may use the cache meanwhile. Adds the model's preparation to stats. Fails as water_render(). */
facet_result water_setup_create(water_cache *cache, const facet_scene *scene, const facet_render_desc *desc,
                                uint32_t needs, water_setup *out, facet_render_stats *stats,
                                facet_error *error);
void water_setup_destroy(water_setup *s);

/* Slopes that a footprint (m) does not resolve, with SLOPE_VARIANCE_MIN; curvature, rate: of their waves
 * (slope_filter). */
typedef struct water_slopes {
    vec3 covariance; /* xx, zz, xz */
    vec3 resolved;   /* of all others */
    float curvature, rate;
} water_slopes;
water_slopes water_slopes_at(const water_setup *s, float footprint_m);
static inline vec3 water_slopes_of(const slope_covariance *c)
{
    return vec3(c->xx, c->zz, c->xz);
}
/* Standard deviation of the slope along one axis, the parameter of water_table_at(). */
static inline float water_sigma_of(vec3 covariance)
{
    return sqrt(max(0.5f * (covariance[0] + covariance[1]), 0.0f));
}

/* What the surface reflects of light from all directions behind N.V = cosine > 0: by Fresnel's equations,
 * and by foam. */
static inline float water_albedo(Water w, float cosine, float foam, bool is_below)
{
    float c = min(cosine, 1.0f);
    return mix(is_below ? water_fresnel_inside(w, c) : water_fresnel(w, c), w.foam_albedo, foam);
}

/* ---- the bed ---- */

static inline bool water_has_bed(const water_setup *s)
{
    return sea_has_bed(&s->sea->desc.bed);
}
/* Whether the light on it varies. */
static inline bool water_has_light_on_bed(const water_setup *s)
{
    return s->caustics.is_there || s->shadow.is_there;
}
/* Its height at (X, Z), and its rise along d. */
static inline double water_bed_height(const facet_sea_bed *bed, double X, double Z)
{
    double along = X * (double)cos(bed->direction_rad) + Z * (double)sin(bed->direction_rad);
    return (double)bed->slope * along - (double)bed->depth_m;
}
static inline double water_bed_rise(const facet_sea_bed *bed, vec3 d)
{
    return (double)bed->slope * (double)(d[0] * cos(bed->direction_rad) + d[2] * sin(bed->direction_rad));
}
static inline vec3 water_bed_albedo(const facet_sea_bed *bed)
{
    return vec3(bed->albedo[0], bed->albedo[1], bed->albedo[2]);
}
static inline vec3 water_bed_normal(const facet_sea_bed *bed)
{
    return normalize(
        vec3(-bed->slope * cos(bed->direction_rad), 1.0f, -bed->slope * sin(bed->direction_rad)));
}

#endif
