/* gl_scene.h - what is made of a scene before anything of it is uploaded, kept from picture to picture: the pose, its
 * geometries with their tangents, and what they take to shade. A picture of the same pose from another camera finds all
 * of it as it was. */
#ifndef GL_GL_SCENE_H
#define GL_GL_SCENE_H

#include "draw/material_plan.h"
#include "draw/render_geometry.h"
#include "draw/tangent_store.h"

typedef struct gl_scene {
    const facet_scene *scene;
    facet_allocator allocator;
    pose_key key; /* of pose */
    scene_pose pose;
    render_geometry_set geometries; /* without world-space vertices: each has its world */
    facet_shading shading;          /* that geometries are drawn with */
    legacy_material default_legacy; /* of primitives without a material */
    tangent_store tangents;
    material_plan_set plans; /* per geometry */
    uint64_t revision;       /* another one whenever something of the above is; 0: there is nothing yet */
    uint64_t generation;     /* another one when what was kept is gone: arrays may stand where others stood */
} gl_scene;

/* Of a scene that outlives it; NULL: {0}. Nothing is prepared yet. */
void gl_scene_init(gl_scene *s, const facet_scene *scene, const facet_allocator *allocator);
void gl_scene_clear(gl_scene *s); /* as after init, but for revision and generation; that of {0} is {0} */
/* Makes what desc (resolved) asks for and is not there; tangents of what does not deform are made once. Where it fails there
 * is nothing. Fails with FACET_ERROR_MEMORY, and as scene_pose_create(). */
facet_result gl_scene_update(gl_scene *s, const facet_render_desc *desc, facet_error *error);

#endif
