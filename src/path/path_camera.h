/* path_camera.h - where paths start: a point of the pixel's filter, a point of the lens. Holds shared shading text: include
 * it last. */
#ifndef PATH_CAMERA_H
#define PATH_CAMERA_H

#include "path/path_state.h"

/* Side of the square of pixels whose texels a sample reads: with 16 samples a pixel they cover it once. */
#define PATH_CAMERA_FOOTPRINT 0.25f

typedef struct path_camera_ray {
    shading_ray ray;   /* direction unit */
    ray_spread spread; /* of ray, to be pointed to */
    float weight;      /* of the sample, by the filter */
} path_camera_ray;

/* Draws two pairs of sampler, the pixel's and the lens's. */
void path_camera_ray_at(const path_scene *scene, path_sampler *sampler, uint32_t x, uint32_t y,
                        path_camera_ray *out);

#endif
