/* shading_scene.h - input and output of shading: the scene, a ray with its footprint, a hit. */
#ifndef CPU_SHADING_SCENE_H
#define CPU_SHADING_SCENE_H

#include "cpu/ray_scene.h"
#include "draw/camera_rays.h"
#include "draw/light_setup.h"
#include "draw/material_plan.h"
#include "draw/texture.h"

/* ---- rays ---- */

/* Derivatives of a ray over its footprint, along two axes (a camera ray's: the image's x and y), after
 * Igehy 1999, "Tracing Ray Differentials". */
typedef struct ray_spread {
    float origin_dx[3], origin_dy[3];       /* m; not read unless moves */
    float direction_dx[3], direction_dy[3]; /* not read unless turns */
    bool moves, turns;
} ray_spread;

/* origin + t direction. */
typedef struct shading_ray {
    float origin[3], direction[3]; /* m; direction of any length, the unit of t */
    float near_t, far_t;
    const ray_spread *spread;
    float footprint; /* scale of the spread */
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

/* The ray through (x, y) of the image for a square of footprint pixels. */
static inline shading_ray shading_ray_of_camera(const camera_rays *camera, const ray_spread *spread, float x,
                                                float y, float footprint)
{
    shading_ray ray = {
        .near_t = camera->near_m, .far_t = camera->far_m, .spread = spread, .footprint = footprint};
    camera_rays_at(camera, x, y, ray.origin, ray.direction);
    return ray;
}

/* ---- the scene ---- */

struct ogl1_setup; /* draw/ogl1_setup.h */

/* What is seen through glass by light that it has only refracted and that meets nothing behind: the background of the
 * image, as compositing would show it. Reflections see the environment. */
typedef enum shading_backdrop {
    SHADING_BACKDROP_ENVIRONMENT,
    SHADING_BACKDROP_NONE, /* transparent */
    SHADING_BACKDROP_COLOR /* backdrop_color */
} shading_backdrop;

/* The scene as shading reads it; constant while an image is rendered. */
typedef struct shading_scene {
    const render_geometry_set *geometries;
    const ray_scene *rays;
    const material_plan_set *plans;
    const texture_set *textures;
    const light_setup *light;
    const struct ogl1_setup *ogl1; /* NULL: shaded as glTF */
    const camera_rays *camera;
    ray_spread camera_spread;
    facet_energy energy;
    facet_quality quality;
    bool has_specular_antialiasing;
    /* perceptual roughness of the environment where it is drawn; 0: sharp, or not drawn */
    float background_blur;
    shading_backdrop backdrop;
    float backdrop_color
        [3]; /* cd/m^2 that are displayed as the color of the background, but for the tone curve */
} shading_scene;

/* Adds backdrop_radiance() to radiance, and returns backdrop_passes(), of shade/transmission.h. */
float shading_show_backdrop(const shading_scene *scene, const float transmittance[3], const float unseen[3],
                            float radiance[3]);

/* A hit and its ray. */
typedef struct shading_point {
    const visibility_hit *hit;
    const shading_ray *ray;
    uint32_t x, y; /* pixel */
    /* Which of how many shades of the pixel; with the pixel, the seed of random numbers for glass. */
    uint32_t shade, shade_count;
    const struct ambient_image
        *ambient; /* cpu/ambient_occlusion.h, which has the pixel; NULL: no ambient occlusion */
} shading_point;

typedef struct shading_result {
    float radiance[3]; /* cd/m^2 towards the camera; with ogl1 its color values */
    float opacity;     /* [0, 1] */
    float behind;      /* share of the background that is seen through glass, [0, 1] */
    uint64_t rays;     /* traced for it */
} shading_result;

/* A surface without light. */
typedef struct shading_description {
    float normal[3]; /* unit shading normal, world space, on the side of the camera */
    float base_color[3];
    float occlusion;
    float uv[2]; /* TEXCOORD_0 */
} shading_description;

#endif
