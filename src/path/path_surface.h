/* path_surface.h - the interface of a boundary that is no mesh's material, and of the medium below it: the
 * path tracer calls these functions wherever a ray hits a primitive of the boundary or travels through its
 * medium. Water implements it (water/water_path.h).
 *
 * V: unit, towards where the path comes from; L: unit, where it goes on. All functions are thread-safe
 * and only read `self`. */
#ifndef PATH_SURFACE_H
#define PATH_SURFACE_H

#include "cpu/surface_point.h"

typedef vec3 path_vec3; /* vec3 before a parenthesis is a constructor */

enum { PATH_SURFACE_VALUES = 4 };

/* A point of the boundary. */
typedef struct path_surface_point {
    vec3 N, Ng;   /* unit, towards +Y: shading normal, bent to where V sees it; of the triangle */
    float side;   /* 1: V is above the boundary; -1: in its medium */
    float albedo; /* for the denoiser, [0, 1] */
    /* interpolated parameters, which the implementation alone interprets */
    float values[PATH_SURFACE_VALUES];
} path_surface_point;

/* A sampled direction of a BSDF. */
typedef struct bsdf_sample {
    vec3 L;
    vec3 weight;      /* BSDF |N.L| / pdf */
    float pdf;        /* per sr; undefined for a specular lobe */
    bool is_specular; /* a delta lobe, or one that eval() leaves out: no light was sampled for it */
    bool is_transmission;
    /* is_specular: scattered by a second microfacet. The sun is seldom hit that way, and would be a bright
     * outlier. */
    bool excludes_sun;
} bsdf_sample;

typedef struct path_surface {
    const void *self; /* for all functions */

    /* False: the hit is none of the boundary. */
    bool (*intersect)(const void *self, const shading_hit *hit, const float triangle_normal[3], vec3 V,
                      path_surface_point *out);
    /* BSDF |N.L| in 1/sr for light from L, and the pdf (per sr) of sample(); both without is_specular.
     * Radiance is carried as it is on either side: through the boundary it changes by the square of the
     * relative ior. */
    path_vec3 (*eval)(const void *self, const path_surface_point *p, vec3 V, vec3 L, float *pdf);
    /* False: the path ends. */
    bool (*sample)(const void *self, const path_surface_point *p, vec3 V, float u_lobe, vec2 u,
                   bsdf_sample *out);

    /* ---- the medium below ---- */
    bool has_camera; /* the camera is in it */
    /* Share of light left after distance_m, up to INFINITY. */
    path_vec3 (*transmittance)(const void *self, float distance_m);
    /* The share of the sun's radiance in it that has not been scattered either: the rest is in emission(). */
    path_vec3 (*sun_transmittance)(const void *self, float distance_m);
    /* In-scattered radiance (cd/m^2) along distance_m from P in direction D (unit). is_indirect: the path
     * has left a surface in the medium, whose lighting includes the scattered light already; only what
     * comes from below is new there. */
    path_vec3 (*emission)(const void *self, vec3 P, vec3 D, float distance_m, bool is_indirect);
    /* Directions from inside of the medium to where the sun is refracted to, and their pdf per sr:
     * surfaces in it mix them with their own samples. */
    bool has_sun;
    path_vec3 (*sun_sample)(const void *self, vec2 u);
    float (*sun_pdf)(const void *self, vec3 L);

    /* ---- what the camera sees ---- */
    /* Background radiance (cd/m^2) in direction D. */
    path_vec3 (*background)(const void *self, vec3 D);
    /* Radiance from a distance in direction D, and at a height, as it arrives through the air. */
    path_vec3 (*through_air)(const void *self, vec3 D, float distance_m, float height_m, vec3 radiance);
} path_surface;

#endif
