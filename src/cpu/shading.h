/* shading.h - from a hit to light: attributes, textures and the shared surface. */
#ifndef CPU_SHADING_H
#define CPU_SHADING_H

#include "draw/light_setup.h"
#include "draw/material_plan.h"
#include "cpu/shading_ray.h"
#include "draw/texture.h"
#include "cpu/visibility.h"

struct ogl1_setup; /* draw/ogl1_setup.h */

/* All that shading reads; nothing of it changes while a picture is drawn. */
typedef struct shading_scene {
    const render_geometry_set *geometries;
    const embree_scene *embree;
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
} shading_scene;

/* Sets camera_spread, from camera, and all members behind it. */
void shading_scene_set_options(shading_scene *scene, const facet_render_desc *desc);

/* A hit and the ray that made it. */
typedef struct shading_point {
    const visibility_hit *hit;
    const shading_ray *ray;
    uint32_t x, y; /* pixel */
    /* Of glass: which of how many shades of the pixel. What is drawn at random depends on these and the pixel. */
    uint32_t shade, shade_count;
} shading_point;

typedef struct shading_result {
    float radiance[3]; /* cd/m^2 towards the camera; with ogl1 what it computes with */
    float opacity;     /* [0, 1] */
    uint64_t rays;     /* that were traced for it */
} shading_result;

/* What is known of a surface without light. */
typedef struct shading_description {
    float normal[3]; /* unit shading normal, world space, on the side of the camera */
    float base_color[3];
    float occlusion;
    float uv[2]; /* TEXCOORD_0 */
} shading_description;

/* Whether the hit shows a side that is drawn: the front, or any of a double-sided surface. direction is the ray's. */
bool shading_is_visible_side(const shading_scene *scene, const visibility_hit *hit, const float direction[3]);
/* Whether light passes the surface: 0 not there, 1 opaque. MASK gives 0 or 1. Cheaper than a shade. */
float shading_opacity(const shading_scene *scene, const shading_point *point);
void shading_shade(const shading_scene *scene, const shading_point *point, shading_result *out);
void shading_describe(const shading_scene *scene, const shading_point *point, shading_description *out);

#endif
