/* boundary.h - a refracting surface: the normal by which it refracts, and the ray differentials of a
 * bundle that passes it. */
#ifndef CPU_BOUNDARY_H
#define CPU_BOUNDARY_H

#include "cpu/surface_point.h"

/* ---- the normal ---- */

/* Smooth normals are often wrong: a modeled rim averages them over its sharp edge, which turns the wall
 * below it into a prism with total reflection. Here the vertices' normals are limited to those of a curved
 * surface through them. */
typedef struct boundary_normal {
    vec3 N;            /* unit, on the side of V; with the offset of the normal texture */
    vec3 dN_dx, dN_dy; /* its change over the ray's footprint */
    vec3 Ng;           /* unit, geometric, on the side of V */
    float tolerance;   /* media_tolerance_at(), m */
} boundary_normal;

boundary_normal boundary_normal_at(const surface_point *s, const visibility_hit *hit);

/* ---- bundles of rays ---- */

/* The hit of a bundle on a surface. */
typedef struct bundle_hit {
    vec3 P;            /* m */
    vec3 D;            /* unit, of the bundle */
    vec3 dP_dx, dP_dy; /* m, in the plane of the surface */
    vec3 dD_dx, dD_dy;
    vec3 dN_dx, dN_dy; /* of the shading normal */
} bundle_hit;

bundle_hit ray_bundle_hit(const shading_ray *ray, const surface_point *s, const boundary_normal *normal);

/* A ray with its own spread, to which ray.spread is set where it is followed. */
typedef struct bundle_ray {
    shading_ray ray;
    ray_spread spread;
} bundle_ray;

/* Continues straight. N below: a unit normal on the side from which the bundle comes. */
bundle_ray ray_bundle_pass(const bundle_hit *hit);
/* Refracts; eta: ior before / ior behind. False: total reflection. */
bool ray_bundle_refract(const bundle_hit *hit, vec3 N, float eta, bundle_ray *out);
bundle_ray ray_bundle_reflect(const bundle_hit *hit, vec3 N);
/* Makes the bundle at least as wide as a cone of that half angle, rad. */
void ray_bundle_widen(bundle_ray *bundle, float angle_rad);

#endif
