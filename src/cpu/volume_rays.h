/* volume_rays.h - where a ray meets the boundaries of bodies. Holds shared shading text: include it last. */
#ifndef CPU_VOLUME_RAYS_H
#define CPU_VOLUME_RAYS_H

#include "cpu/media.h"
#include "cpu/surface_point.h"

/* Lengths, m, below which positions on a triangle are the same: several times what rounding of the intersection is, which
 * goes with the largest of its corners' coordinates. */
static inline float volume_rays_tolerance_of(float coordinate_m)
{
    return 1e-6f * coordinate_m + 1e-12f;
}

typedef struct volume_exit {
    float distance_m;
    vec3 normal; /* unit, geometric, out of the body */
} volume_exit;

/* Where the body behind s, which is a boundary of it, ends along a unit direction into it. False: nowhere. */
bool volume_rays_find_exit(const shading_scene *scene, const surface_point *s, vec3 direction,
                           volume_exit *out);

/* Takes the ray that meets s across the boundary there, and across those of other bodies in the same place (a liquid
 * that touches its glass): within tolerance, m. */
void volume_rays_cross(const shading_scene *scene, const visibility_hit *hit, const surface_point *s,
                       float tolerance, media *m);

#endif
