/* path_scene.h - what paths go through, and the radiance that one sample of a pixel finds. */
#ifndef PATH_PATH_SCENE_H
#define PATH_PATH_SCENE_H

#include "cpu/render_setup.h"

struct path_lights;  /* path_lights.h */
struct path_surface; /* path_surface.h */

/* The scene of paths; constant during a pass. */
typedef struct path_scene {
    const render_setup *setup; /* its desc has the options */
    const struct path_lights *lights;
    bool has_ground;
    float ground_y; /* m: the plane of FACET_GROUND_SHADOW (along the up axis of the scene: +Y) */
    bool draws_background;
    const struct path_surface *surface; /* NULL: meshes' materials only */
    bool finds_first;                   /* path_sample.first_geometry is needed, even where it costs a ray */
    float max_radiance; /* of a sample's channels, cd/m^2, biased: facet_sea_shading.clamp; 0: none */
} path_scene;

/* One sample of a pixel. */
typedef struct path_sample {
    float radiance[3]; /* cd/m^2, premultiplied with opacity; not yet checked for being finite */
    float opacity;     /* [0, 1]: 0: the background, where it is not drawn */
    /* excess of the filter's weight, which is in radiance and opacity, over 1; 0 unless the filter has
     * negative lobes */
    float filter_excess;
    /* of the first surface that is neither specular nor clear glass, times what passes to the camera, [0, 1];
     * of the environment 1; 0: none */
    float albedo[3];
    float normal[3]; /* its unit shading normal, world space; of the environment that of the first surface */
    /* On the shadow-catching ground: illuminance / pi with and without the model. 0: not hit */
    float ground_lit[3], ground_open[3];
    /* The first surface that the camera's ray hits, and the opacity of all alpha-blended ones there in a
     * row, times the filter's weight; 0: none */
    uint32_t first_geometry;
    float first_share;
    uint64_t rays; /* traced for the sample */
} path_sample;

/* Sample number `index` of pixel (x, y) of the whole image. Thread-safe. */
void path_trace(const path_scene *scene, uint32_t x, uint32_t y, uint32_t index, path_sample *out);

#endif
