/* path_state.h - a path on its way: where it is, what it carries, and by which chance it got there. Holds shared shading
 * text: include it last. */
#ifndef PATH_STATE_H
#define PATH_STATE_H

#include "cpu/media.h"
#include "path/path_lights.h"
#include "path/path_trace.h"
#include "path/sampler.h"

/* The place from which the path went on by chance: light that it meets was within reach of path_lights_sample() there. */
typedef struct path_origin {
    vec3 P;    /* m */
    vec3 N;    /* as path_lights_sample() was given */
    float pdf; /* per sr, of the direction that was taken */
    /* false: by a mirror or from the camera: no light was, or could have been, aimed at that way */
    bool is_chosen;
} path_origin;

typedef struct path {
    const path_scene *scene;
    const shading_scene *shading;
    path_sampler sampler;
    vec3 throughput;      /* of the radiance that comes from ahead */
    vec3 P, D;            /* where it goes on, m, and the way, unit */
    float width_m, angle; /* of the cone of directions that it stands for: radius at P, half-angle in rad */
    float passed_m;       /* since from.P, where the path went straight on through something */
    float skipped_m;      /* of the way from the surface that it left, before P */
    path_origin from;
    media media;          /* what P is in */
    float wavelength_nm;  /* 0: all */
    float at_first;       /* largest channel of throughput behind the first surface; 0: not there yet */
    uint32_t depth;       /* surfaces and scattering events behind it */
    uint32_t vertex;      /* the same with those that light passes straight: number for the sampler */
    bool has_crossed;     /* what transmits, since from: straight shadows find the light behind it */
    bool follows_mirrors; /* nothing but mirrors and clear glass so far: albedo, normal are to come */
    bool is_in_medium;    /* P is in the medium below scene->surface */
    float
        seen_through_m; /* of that medium, between the camera and P, by specular lobes of the surface only */
    bool is_indirect;   /* the path has left a surface in that medium */
    bool excludes_sun;  /* bsdf_sample.excludes_sun */
    path_sample *out;
    vec3 radiance;
} path;

/* A ray that starts beside a surface, by offset along the normal, gets to the next one that much sooner than one from the
 * surface itself: what is absorbed on the way goes with the latter. D: unit. */
static inline float path_skipped(vec3 offset, vec3 D)
{
    float length_m = length(offset);
    return length_m > 0.0f ? length_m * length_m / max(abs(dot(offset, D)), 0.05f * length_m) : 0.0f;
}

/* Whether shadow rays pass what transmits, and paths leave that light to them. */
static inline bool path_has_straight_shadows(const path *p)
{
    const facet_path_desc *desc = &p->scene->setup->desc->path;
    return desc->has_straight_shadows && desc->light_sampling != FACET_LIGHT_SAMPLING_BSDF &&
           p->shading->plans->lets_rays_through;
}

/* Adds what came from ahead; indirect light is cut to desc->path.clamp where that is asked for. */
static inline void path_add(path *p, vec3 contribution)
{
    float most = p->scene->setup->desc->path.clamp;
    if (most > 0.0f && p->depth > 1) {
        float value = max3(contribution);
        contribution *= value > most ? most / value : 1.0f;
    }
    p->radiance += contribution;
}

/* The weight of one of two ways to find the same light; Veach 1997, the power heuristic. */
static inline float path_power(float pdf, float other_pdf)
{
    float q = other_pdf / pdf;
    return 1.0f / (1.0f + q * q);
}

/* Of light that was met; light_pdf: with which it would have been aimed at from p->from. */
static inline float path_met_weight(const path *p, float light_pdf)
{
    if (!p->from.is_chosen || !(light_pdf > 0.0f))
        return 1.0f;
    if (p->has_crossed)
        return 0.0f;
    switch (p->scene->setup->desc->path.light_sampling) {
    case FACET_LIGHT_SAMPLING_BSDF:
        return 1.0f;
    case FACET_LIGHT_SAMPLING_LIGHTS:
        return 0.0f;
    case FACET_LIGHT_SAMPLING_MIS:
        break;
    }
    return path_power(p->from.pdf, light_pdf);
}

/* Of light that was aimed at; pdf: with which the path would go that way. */
static inline float path_aimed_weight(const path_scene *scene, const path_light_sample *light, float pdf)
{
    facet_light_sampling sampling = scene->setup->desc->path.light_sampling;
    if (light->is_point || sampling == FACET_LIGHT_SAMPLING_LIGHTS)
        return 1.0f;
    return sampling == FACET_LIGHT_SAMPLING_BSDF ? 0.0f : path_power(light->pdf, pdf);
}

#endif
