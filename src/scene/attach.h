/* attach.h - a scene below a node of another: assets that a file refers to. */
#ifndef SCENE_ATTACH_H
#define SCENE_ATTACH_H

#include "scene/scene.h"

/* Where the meshes, materials and textures of a scene are after it was attached once; {0} before. */
typedef struct scene_attachment {
    bool is_there;
    uint32_t first_image, first_texture, first_material, first_mesh;
} scene_attachment;

/* Makes the roots of the default scene of `from` children of external->node, after those that it has, with all that
 * belongs to them; names of nodes, cameras, lights, skins and animations begin with external->name and "/" ("": they
 * stay). A copy of *external joins the list of the scene.
 * Called again with the same scene and attachment it shares meshes and materials with the first, unless an animation
 * changes these. `to` must keep `from` afterwards (scene_keep_scene()). FACET_ERROR_MEMORY leaves both as they were. */
facet_result scene_attach(facet_scene *to, const facet_scene *from, const scene_external *external,
                          scene_attachment *attachment, facet_error *error);

#endif
