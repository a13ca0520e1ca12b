/* water_caustics.h - sunlight that waves focus on the bed: rays of the sun through a regular grid of the surface, refracted, and laid
 * down where they meet the bed. */
#ifndef WATER_WATER_CAUSTICS_H
#define WATER_WATER_CAUSTICS_H

#include "ocean/caustic_map.h"
#include "ocean/waves.h"
#include "water/water_model.h"

#include "shade/shade.h"

/* What rays go through. */
typedef struct caustic_source {
    const waves *waves;
    Water water;
    vec3 L;            /* to the sun, L.y > 0 */
    double bed_height; /* of the bed at the origin, m, and its rise along X and Z */
    double bed_rise[2];
    const water_model *model; /* which keeps light out of the water, and from the bed; NULL: none */
    uint32_t thread_count;
    facet_allocator allocator;
} caustic_source;

/* How one layer is made. */
typedef struct caustic_plan {
    double middle[2];
    float texel_m;
    float sigma_m
        [2]; /* along the map's axes: by how much the sun's disc, and slopes that the grid does not resolve, spread light */
    float margin_m; /* from where beyond the layer light may come */
} caustic_plan;

/* Fills a map along `axis` (unit) by its plans, the finest first. The mean over a wide layer is 1, on still water the factor is 1
 * everywhere, but for what the model takes away. Same bytes for every number of threads. FACET_ERROR_MEMORY. */
facet_result water_caustics_fill(const caustic_source *source, const float axis[2],
                                 const caustic_plan plans[CAUSTIC_LAYERS], caustic_map *map,
                                 facet_error *error);

/* How far light on the bed moves (m, along the axes) where the surface has the slope (x, z) and lies `depth` m over it. */
vec2 water_caustics_shift(const caustic_source *source, const float axis[2], vec3 L, vec2 slope, float depth);

#endif
