/* water_caustics.h - sunlight that waves focus on the bed: sun rays through a regular grid on the surface are
 * refracted and splatted where they hit the bed. */
#ifndef WATER_WATER_CAUSTICS_H
#define WATER_WATER_CAUSTICS_H

#include "ocean/caustic_map.h"
#include "ocean/waves.h"
#include "water/water_model.h"

#include "shade/shade.h"

struct water_setup;

/* Makes the caustics of an image, from the light, camera and waves in s: layers centered on the nearest
 * visible part of the bed, as fine as pixels are, and no finer than light is focused (caustic_plan.c). The
 * map is empty without a bed or a sun, on still water without a model's shadow in view, where too little
 * focused light would reach the eye, or where the shading omits caustics. FACET_ERROR_MEMORY; *map is to be
 * destroyed, even then. */
facet_result caustic_map_of_image(const struct water_setup *s, caustic_map *map, facet_error *error);

/* ---- one map ---- */

/* The scene that rays pass through. */
typedef struct caustic_source {
    const waves *waves;
    Water water;
    vec3 L;            /* towards the sun, L.y > 0 */
    double bed_height; /* of the bed at the origin, m, and its rise along X and Z */
    double bed_rise[2];
    const water_model *model; /* occludes light above the water and below; NULL: none */
    uint32_t thread_count;
    facet_allocator allocator;
} caustic_source;

/* How one layer is made. */
typedef struct caustic_plan {
    double middle[2];
    float texel_m;
    /* along the map's axes: standard deviation of the blur by the sun's disc and by slopes that the grid
     * does not resolve */
    float sigma_m[2];
    float margin_m; /* width of the border outside of the layer from which light may enter */
} caustic_plan;

/* Fills a map along `axis` (unit) by its plans, the finest first. The mean over a wide layer is 1, and on
 * still water the factor is 1 everywhere, except for the light that the model blocks. Same bytes for any
 * thread count. FACET_ERROR_MEMORY. */
facet_result water_caustics_fill(const caustic_source *source, const float axis[2],
                                 const caustic_plan plans[CAUSTIC_LAYERS], caustic_map *map,
                                 facet_error *error);

/* Displacement (m, along the axes) of refracted light on the bed, for a surface slope (x, z) `depth` m above
 * it. */
vec2 water_caustics_shift(const caustic_source *source, const float axis[2], vec3 L, vec2 slope, float depth);

#endif
