/* path.h - the state of one light path, its walk through the scene and its shadow rays. Names are those of
 * pbrt (Pharr, Jakob and Humphreys 2023, "Physically Based Rendering", 4th edition, chapters 13 and 14). */
#ifndef PATH_PATH_H
#define PATH_PATH_H

#include "cpu/media.h"
#include "path/path_lights.h"
#include "path/path_scene.h"
#include "path/sampler.h"

typedef struct path {
    const path_scene *scene;
    path_sample *out;
    path_sampler sampler;

    /* the estimate */
    vec3 L;           /* radiance found so far, cd/m^2 */
    vec3 beta;        /* throughput of the radiance that comes from ahead */
    float beta_first; /* largest channel of beta after the first surface; 0: before it */
    uint32_t depth;   /* surfaces and scattering events so far */
    uint32_t vertex;  /* the same with null interfaces: number for the sampler */

    /* the ray to the next vertex */
    vec3 P, D;                       /* m; unit */
    float offset_m;                  /* length of the ray between the surface that it left and P */
    float cone_radius_m, cone_angle; /* footprint: radius at P, half-angle in rad */
    media media;                     /* closed volumes that P is in */
    float wavelength_nm;             /* 0: all */

    /* multiple importance sampling of the light that the ray hits: it could have been sampled as well at
     * the vertex at which the direction was sampled */
    path_lights_view *views; /* two: the lights as seen from there and from the next; unset if specular */
    uint32_t view;           /* which one is that vertex's */
    float p_bsdf;            /* per sr, of the direction */
    float previous_m;        /* from there to P, where null interfaces or straight transmission lie between */
    /* no light could have been sampled for the ray: specular lobe, or from the camera */
    bool specular_bounce;
    bool is_shadow_lit; /* the ray passed transmissive surfaces whose light the straight shadow rays found */
    bool excludes_sun;  /* bsdf_sample.excludes_sun */
    /* the path of the camera has only been transmitted by glass: it sees the backdrop where it meets nothing else */
    bool sees_backdrop;

    /* the medium below scene->surface */
    bool is_in_medium;    /* P is in it */
    bool is_indirect;     /* the path has left another surface in it */
    float seen_through_m; /* its length between camera and P, through specular lobes of the surface only */

    /* specular surfaces only so far: albedo and normal for the denoiser are still to come */
    bool seeks_features;
} path;

/* A ray of the camera: a point of the pixel's filter, a point of the lens. */
typedef struct path_camera_ray {
    shading_ray ray; /* direction unit; its spread is the one below */
    ray_spread spread;
    float weight; /* of the sample, by the filter */
} path_camera_ray;

/* u_pixel, u_lens: uniform in [0, 1)^2. */
void path_sample_camera_ray(const path_scene *scene, vec2 u_pixel, vec2 u_lens, uint32_t x, uint32_t y,
                            path_camera_ray *out);

/* Follows p from p->P in direction p->D until it ends; adds the radiance that it finds to p->L. hit and
 * ray: the first intersection where it is known, else NULL. */
void path_walk(path *p, const visibility_hit *hit, const shading_ray *ray);

/* The transmittance (share of radiance) towards a light that was sampled for the point `at`. P (m) is
 * where the ray starts: beside `at`, free of the surface that it lies on, and in the media `in`. Alpha
 * lets its share pass, and so do null interfaces and straight transmission; other transmissive surfaces
 * block it, unless facet_path_desc.has_straight_shadows is set. *rays counts it. */
vec3 path_shadow(const path_scene *scene, vec3 at, vec3 P, const path_light_sample *light, const media *in,
                 float wavelength_nm, uint64_t *rays);

/* ---- decisions at a vertex ---- */

/* Length of the ray in direction D (unit) that a start offset along the normal skips. Absorption counts
 * it. */
static inline float path_skipped(vec3 offset, vec3 D)
{
    float length_m = length(offset);
    return length_m > 0.0f ? length_m * length_m / max(abs(dot(offset, D)), 0.05f * length_m) : 0.0f;
}

/* Half-angle of the cone that a direction with pdf (per sr) stands for: that of 1/32 of a sample's solid
 * angle, so that the cones of a pixel's samples overlap little. */
static inline float path_cone_angle(float pdf)
{
    return 0.1f * inversesqrt(max(pdf, 1e-3f));
}

/* The power heuristic (Veach 1997) for a sample of density pdf that the other strategy finds with
 * other_pdf. */
static inline float path_power_heuristic(float pdf, float other_pdf)
{
    float q = other_pdf / pdf;
    return 1.0f / (1.0f + q * q);
}

/* The weight of BSDF-sampled light; p_light: its pdf (per sr) by light sampling at the previous vertex. */
static inline float path_weight_of_bsdf(const path *p, float p_light)
{
    if (p->specular_bounce || !(p_light > 0.0f))
        return 1.0f;
    if (p->is_shadow_lit)
        return 0.0f;
    switch (p->scene->setup->desc->path.light_sampling) {
    case FACET_LIGHT_SAMPLING_BSDF:
        return 1.0f;
    case FACET_LIGHT_SAMPLING_LIGHTS:
        return 0.0f;
    case FACET_LIGHT_SAMPLING_MIS:
        break;
    }
    return path_power_heuristic(p->p_bsdf, p_light);
}

/* The weight of a light sample; p_bsdf: its pdf (per sr) by BSDF sampling. */
static inline float path_weight_of_light(const path_scene *scene, const path_light_sample *light,
                                         float p_bsdf)
{
    facet_light_sampling sampling = scene->setup->desc->path.light_sampling;
    if (light->is_delta || sampling == FACET_LIGHT_SAMPLING_LIGHTS)
        return 1.0f;
    return sampling == FACET_LIGHT_SAMPLING_BSDF ? 0.0f : path_power_heuristic(light->pdf, p_bsdf);
}

/* Whether shadow rays pass transmissive surfaces, and paths leave that light to them. */
static inline bool path_has_straight_shadows(const path_scene *scene)
{
    const facet_path_desc *desc = &scene->setup->desc->path;
    return desc->has_straight_shadows && desc->light_sampling != FACET_LIGHT_SAMPLING_BSDF &&
           scene->setup->shading.plans->lets_rays_through;
}

/* Adds a contribution to L; indirect light is clamped to desc->path.clamp where that is set. */
static inline void path_add(path *p, vec3 contribution)
{
    float limit = p->scene->setup->desc->path.clamp;
    if (limit > 0.0f && p->depth > 1) {
        float value = max3(contribution);
        contribution *= value > limit ? limit / value : 1.0f;
    }
    p->L += contribution;
}

#endif
