/* gl_scene.h - what is prepared of a scene before it is uploaded, kept from image to image: the pose, its
 * geometries with their tangents, and what they take to shade. Another camera changes nothing of it. */
#ifndef GL_GL_SCENE_H
#define GL_GL_SCENE_H

#include "draw/material_plan.h"
#include "draw/render_geometry.h"
#include "draw/tangent_store.h"

typedef struct gl_scene {
    const facet_scene *scene;
    uint64_t content_revision; /* of the scene that everything here is of */
    facet_allocator allocator;
    pose_key key; /* of pose */
    scene_pose pose;
    render_geometry_set geometries; /* vertices in object space, each with its world matrix */
    facet_shading shading;          /* the shading that geometries are set up for */
    legacy_material default_legacy; /* of primitives without a material */
    tangent_store tangents;
    material_plan_set plans; /* per geometry */
    uint64_t revision;       /* changes whenever something of the above changes; 0: nothing prepared yet */
    uint64_t generation;     /* changes when arrays were freed: addresses may be reused */
} gl_scene;

/* scene outlives it; NULL leaves {0}. Prepares nothing yet. */
void gl_scene_init(gl_scene *s, const facet_scene *scene, const facet_allocator *allocator);
/* resets to the state after init, except for revision and generation; {0} stays {0} */
void gl_scene_clear(gl_scene *s);
/* Prepares what desc (resolved) needs and is missing; tangents of static geometry are computed once. On
 * failure nothing is prepared. Fails with FACET_ERROR_MEMORY, and as scene_pose_create(). */
facet_result gl_scene_update(gl_scene *s, const facet_render_desc *desc, facet_error *error);

#endif
