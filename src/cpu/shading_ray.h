/* shading_ray.h - a ray through the scene and the bundle of directions that it stands for: a camera's, or one that a
 * surface let through. */
#ifndef CPU_SHADING_RAY_H
#define CPU_SHADING_RAY_H

#include "draw/camera_rays.h"

/* How a ray changes over what it stands for, along two axes (a camera ray's: the picture's x and y), after Igehy 1999,
 * "Tracing Ray Differentials". */
typedef struct ray_spread {
    float origin_dx[3], origin_dy[3];       /* m; not read unless moves */
    float direction_dx[3], direction_dy[3]; /* not read unless turns */
    bool moves, turns;
} ray_spread;

/* origin + t direction. */
typedef struct shading_ray {
    float origin[3], direction[3]; /* m; direction of any length, t counts in it */
    float near_t, far_t;
    const ray_spread *spread;
    float footprint; /* of the spread that the ray stands for */
} shading_ray;

/* The spread of a camera's rays for a pixel. */
static inline ray_spread ray_spread_of_camera(const camera_rays *camera)
{
    ray_spread spread = {.moves = camera->is_orthographic, .turns = !camera->is_orthographic};
    for (int i = 0; i < 3; i++) {
        spread.origin_dx[i] = camera->origin_dx[i];
        spread.origin_dy[i] = camera->origin_dy[i];
        spread.direction_dx[i] = camera->direction_dx[i];
        spread.direction_dy[i] = camera->direction_dy[i];
    }
    return spread;
}

/* The ray through (x, y) of the picture for a square of footprint pixels. */
static inline shading_ray shading_ray_of_camera(const camera_rays *camera, const ray_spread *spread, float x,
                                                float y, float footprint)
{
    shading_ray ray = {
        .near_t = camera->near_m, .far_t = camera->far_m, .spread = spread, .footprint = footprint};
    camera_rays_at(camera, x, y, ray.origin, ray.direction);
    return ray;
}

#endif
