/* see_through.h - all surfaces along one ray, as far as light passes them. */
#ifndef CPU_SEE_THROUGH_H
#define CPU_SEE_THROUGH_H

#include "cpu/shading.h"

/* More than SEE_THROUGH_LAYERS surfaces that let light pass lie one behind the other in no picture worth drawing;
 * what is farther is left out. */
enum { SEE_THROUGH_LAYERS = 64 };

/* Writes the hits of the ray, nearest first, and returns their number: surfaces with opacity between 0 and 1, and
 * behind them the nearest opaque one. Culled sides and masked texels are not among them. Hits at the same distance
 * are ordered by geometry and primitive; the result does not depend on the order in which Embree finds them. */
uint32_t see_through(const shading_scene *scene, const shading_ray *ray,
                     visibility_hit hits[SEE_THROUGH_LAYERS + 1]);

#endif
