/* boundary.h - a refracting surface: the normal by which it refracts, and how a bundle of rays goes on behind it: direction, and
 * its changes over the footprint. */
#ifndef CPU_BOUNDARY_H
#define CPU_BOUNDARY_H

#include "cpu/surface_point.h"

/* ---- the normal ---- */

/* Smooth normals often lie: a modeller's rim has them averaged over its sharp edge, which turns the wall below it into a
 * prism that reflects totally. Here the vertices' normals are limited to those of a curved surface through them. */
typedef struct boundary_normal {
    vec3 N;            /* unit, on the side of V; with what the normal texture adds */
    vec3 dN_dx, dN_dy; /* its change over the ray's footprint */
    vec3 Ng;           /* unit, geometric, on the side of V */
    float tolerance;   /* of volume_rays.h, m */
} boundary_normal;

boundary_normal boundary_normal_at(const surface_point *s, const visibility_hit *hit);

/* ---- bundles of rays ---- */

/* A surface as a bundle meets it. */
typedef struct bundle_hit {
    vec3 P;            /* m */
    vec3 D;            /* unit, the way the bundle goes */
    vec3 dP_dx, dP_dy; /* m, in the plane of the surface */
    vec3 dD_dx, dD_dy;
    vec3 dN_dx, dN_dy; /* of the shading normal */
} bundle_hit;

bundle_hit ray_bundle_hit(const shading_ray *ray, const surface_point *s, const boundary_normal *normal);

/* A ray with a spread of its own, which becomes that of the ray where it is followed. */
typedef struct bundle_ray {
    shading_ray ray;
    ray_spread spread;
} bundle_ray;

/* Goes on straight. N below: a unit normal on the side from which the bundle comes. */
bundle_ray ray_bundle_pass(const bundle_hit *hit);
/* Refracted; eta: ior before / ior behind. False: all is reflected. */
bool ray_bundle_refract(const bundle_hit *hit, vec3 N, float eta, bundle_ray *out);
bundle_ray ray_bundle_reflect(const bundle_hit *hit, vec3 N);
/* Makes the bundle at least as wide as a cone of that half angle, rad. */
void ray_bundle_widen(bundle_ray *bundle, float angle_rad);

#endif
