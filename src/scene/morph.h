/* morph.h - vertices moved by morph targets. */
#ifndef SCENE_MORPH_H
#define SCENE_MORPH_H

#include "scene/scene.h"

/* Which attributes some target with a weight other than 0 moves. */
typedef struct morph_use {
    bool positions, normals, tangents;
} morph_use;
morph_use morph_get_use(const scene_primitive *primitive, const float *weights, uint32_t weight_count);

/* Arrays of a whole primitive, laid out as its own; NULL: not wanted. */
typedef struct vertex_arrays {
    float *positions, *normals, *tangents;
} vertex_arrays;

/* The same to read from. */
typedef struct vertex_source {
    const float *positions, *normals, *tangents;
} vertex_source;

/* Writes vertices [begin, end): the primitive's plus weights times the targets' changes. Directions are not unit then;
 * w of tangents stays. weights: at least target_count, or weight_count and those beyond are 0. */
void morph_vertices(const scene_primitive *primitive, const float *weights, uint32_t weight_count,
                    size_t begin, size_t end, const vertex_arrays *out);

#endif
