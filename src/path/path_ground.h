/* path_ground.h - the plane that catches shadows: seen by the camera alone, from above, and lit as a white surface is. Holds
 * shared shading text: include it last. */
#ifndef PATH_GROUND_H
#define PATH_GROUND_H

#include "path/path_state.h"

/* Whether the ray from P into the unit direction D meets the ground from above, and where. */
bool path_ground_is_met(const path_scene *scene, vec3 P, vec3 D, vec3 *out);

/* Adds share times the light on the ground at P to out: ground_lit, and ground_open as it would be if the environment, the
 * sun and lamps were all there is. Both come of the same directions, so that they are equal where no model is near. */
void path_ground_light(const path_scene *scene, path_sampler sampler, vec3 P, float share, path_sample *out);

#endif
