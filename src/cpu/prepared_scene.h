/* prepared_scene.h - the prepared data of a scene that are kept from one image to the next: pose, geometry,
 * BVH, tangents and decoded textures. Each stage makes what the desc needs and what is missing. The result
 * does not depend on what was there. (The environment keeps prepared light.)
 *
 * What a frame of an animation redoes follows from instancing.h: nothing for triangles that do not move,
 * a BVH over instances for rigid parts, and a BVH of the triangles that a skin or morph targets deform.
 * The latter is not refitted, which would take 9 to 18 ns per triangle where building takes 30 to 400: a
 * refitted tree keeps the shape of an earlier frame, and where a ray hits the common edge of two triangles
 * it may find the other one (3 to 26 % of rays through the vertices of a grid), so that an image would
 * depend on those before it. */
#ifndef CPU_PREPARED_SCENE_H
#define CPU_PREPARED_SCENE_H

#include "cpu/ray_scene.h"
#include "draw/render_geometry.h"
#include "draw/tangent_store.h"

struct texture_store; /* draw/texture_store.h */

/* Stays where it is between init and clear: its BVH keeps the address of the geometries. */
typedef struct prepared_scene {
    const facet_scene *scene;
    uint64_t content_revision; /* of the scene that everything here is of */
    facet_allocator allocator;
    bool has_geometry, has_tangents;
    pose_key key; /* of pose */
    scene_pose pose;
    scene_pose geometry_pose; /* of geometries, where that is not pose */
    camera_rays camera;       /* that points and lines face */
    uint64_t ray_count;       /* for which roles were chosen */
    bool is_within_reach;
    render_geometry_set geometries;
    facet_shading shading;          /* of the geometries */
    legacy_material default_legacy; /* of primitives without a material */
    render_likeness likeness;       /* of the geometries to those of the BVH */
    bool has_moved_sprites;
    ray_scene rays;
    uint32_t thread_count; /* of rays */
    facet_isa isa;         /* of rays */
    tangent_store tangents;
    struct texture_store *textures; /* NULL: not read yet */
    bool has_warned_occlusion;      /* which materials have no occlusion */
} prepared_scene;

/* For a scene that outlives it; NULL: {0}. Nothing is prepared yet. */
void prepared_scene_init(prepared_scene *p, const facet_scene *scene, const facet_allocator *allocator);
void prepared_scene_clear(prepared_scene *p); /* as after init; that of {0} is {0} */

/* The stages, in this order; BVH, tangents and textures touch different members and may run concurrently.
 * desc: resolved, as for preview_render(). camera: the image's. After a failed stage other than the
 * pose's, clear. Fail with FACET_ERROR_MEMORY, and as scene_pose_create(), ray_tracer.create(). */
facet_result prepared_scene_pose(prepared_scene *p, const facet_render_desc *desc, facet_error *error);
facet_result prepared_scene_geometry(prepared_scene *p, const facet_render_desc *desc,
                                     const camera_rays *camera, facet_error *error);
facet_result prepared_scene_hierarchy(prepared_scene *p, const facet_render_desc *desc, facet_error *error);
/* In place of prepared_scene_hierarchy() for an image that needs none: drops one of other geometries. */
void prepared_scene_skip_hierarchy(prepared_scene *p);
facet_result prepared_scene_tangents(prepared_scene *p, const facet_render_desc *desc, facet_error *error);
facet_result prepared_scene_textures(prepared_scene *p, facet_error *error);

#endif
