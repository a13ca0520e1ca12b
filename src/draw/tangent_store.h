/* tangent_store.h - tangents where the material needs them and the file has none: made once for each
 * primitive and set of texture coordinates, kept from image to image. */
#ifndef DRAW_TANGENT_STORE_H
#define DRAW_TANGENT_STORE_H

#include "draw/render_geometry.h"

/* Of a primitive with these positions. */
typedef struct tangent_entry {
    const scene_primitive *primitive;
    const float *positions, *normals;
    uint32_t texcoord;
    float *tangents; /* 4 per index */
} tangent_entry;

typedef struct tangent_store {
    tangent_entry *entries; /* sorted */
    size_t count, capacity;
} tangent_store;

/* Gives tangents to those geometries that have none and a material whose texels or lobes depend on them.
 * Deformed ones get those of the deformed vertices, as glTF 2.0, 3.7.2.2 has it for morph targets:
 * deformed tangents of the rest pose would not match the normals. Fails with FACET_ERROR_MEMORY: the store
 * keeps what it has. */
facet_result tangent_store_fill(tangent_store *store, render_geometry_set *set,
                                const facet_allocator *allocator, uint32_t thread_count, facet_error *error);
/* Drops the entries of deformed vertices, which are released with their pose. */
void tangent_store_forget_deformed(tangent_store *store);
void tangent_store_destroy(tangent_store *store); /* {0} is allowed; leaves {0} */

#endif
