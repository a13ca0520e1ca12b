/* water_objects.h - the water and its bed as objects beside those of a model: their nodes, meshes and
 * materials, and the identities that layers have of them (docs/layers.md, "In a sea"). */
#ifndef WATER_WATER_OBJECTS_H
#define WATER_WATER_OBJECTS_H

#include "scene/identity.h"

/* Their order, after all nodes and materials of the model; a sea without a bed has the water only. */
enum { WATER_OBJECT_WATER, WATER_OBJECT_BED, WATER_OBJECTS };

/* Fills scene, which is empty, with everything visible in `with` (NULL: nothing), which outlives it, and
 * with copies of surface and bed (NULL: none) in all of its scenes. False: out of memory. */
bool water_objects_add(const facet_scene *with, const facet_sea *sea, const scene_primitive *surface,
                       const scene_primitive *bed, facet_scene *scene);

/* A scene of the same objects without triangles, for what follows from their names alone.
 * FACET_ERROR_MEMORY. */
facet_result water_objects_scene(const facet_scene *with, const facet_sea *sea,
                                 const facet_allocator *allocator, facet_scene **out, facet_error *error);

/* One identity per WATER_OBJECT_ constant that the sea has: a block of mem_alloc(). FACET_ERROR_MEMORY. */
facet_result water_objects_identify(const facet_scene *with, const facet_sea *sea,
                                    const facet_allocator *allocator, scene_identity **out,
                                    facet_error *error);

#endif
