/* prepared_scene.h - what is made of a scene before rays are traced, kept from one image to the next: the pose,
 * geometry, bounding volume hierarchy, tangents and decoded textures. Each stage makes anew what the desc asks for and
 * what is there is not. What comes out does not depend on what was there. (Prepared light is kept by the environment.)
 *
 * What a frame of an animation has to do again follows from instancing.h: nothing for triangles that do not move, a
 * hierarchy over instances for rigid parts, and a hierarchy of those triangles that a skin or morph targets deform. The
 * latter is not refitted, which would take 9 to 18 ns a triangle where building takes 30 to 400: a refitted tree keeps
 * the shape that an earlier frame gave it, and of two triangles it finds another one where a ray meets their edge (3 to
 * 26 % of rays through the vertices of a grid), so that an image would depend on those before it. */
#ifndef CPU_PREPARED_SCENE_H
#define CPU_PREPARED_SCENE_H

#include "cpu/embree_scene.h"
#include "draw/render_geometry.h"
#include "draw/tangent_store.h"

struct texture_store; /* draw/texture_store.h */

/* Stays where it is between init and clear: Embree keeps its address. */
typedef struct prepared_scene {
    const facet_scene *scene;
    facet_allocator allocator;
    bool has_geometry, has_tangents;
    pose_key key; /* of pose */
    scene_pose pose;
    scene_pose geometry_pose; /* of geometries, where that is not pose */
    camera_rays camera;       /* of points and lines */
    uint64_t ray_count;       /* that roles were chosen for */
    bool is_within_reach;
    render_geometry_set geometries;
    facet_shading shading;          /* that geometries are drawn with */
    legacy_material default_legacy; /* of primitives without a material */
    render_likeness likeness;       /* of geometries to what the hierarchy was built over */
    bool has_moved_sprites;
    embree_scene embree;
    uint32_t thread_count; /* of embree */
    facet_isa isa;         /* of embree */
    tangent_store tangents;
    struct texture_store *textures; /* NULL: none was read yet */
    bool has_warned_occlusion;      /* which materials do without */
} prepared_scene;

/* Of a scene that outlives it; NULL: {0}. Nothing is prepared yet. */
void prepared_scene_init(prepared_scene *p, const facet_scene *scene, const facet_allocator *allocator);
void prepared_scene_clear(prepared_scene *p); /* as after init; that of {0} is {0} */

/* The stages, in this order; hierarchy, tangents and textures touch different members and may run at the same time.
 * desc: resolved, as for preview_render(). camera: the image's. A stage other than the pose's that fails leaves what
 * has to be cleared. Fail with FACET_ERROR_MEMORY, with what scene_pose_create(), embree_scene_create() fail with. */
facet_result prepared_scene_pose(prepared_scene *p, const facet_render_desc *desc, facet_error *error);
facet_result prepared_scene_geometry(prepared_scene *p, const facet_render_desc *desc,
                                     const camera_rays *camera, facet_error *error);
facet_result prepared_scene_hierarchy(prepared_scene *p, const facet_render_desc *desc, facet_error *error);
facet_result prepared_scene_tangents(prepared_scene *p, const facet_render_desc *desc, facet_error *error);
facet_result prepared_scene_textures(prepared_scene *p, facet_error *error);

#endif
