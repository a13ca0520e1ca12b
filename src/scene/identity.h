/* identity.h - object, material and instance IDs of the parts of a pose: as numbers, and as Cryptomatte's
 * hashes of names (Friedman and Jones, "Fully automatic ID mattes with support for motion blur and
 * transparency", 2015; specification 1.2.0).
 *
 * An object is a node, an instance is one copy of it (EXT_mesh_gpu_instancing draws a node several times).
 * Numbers and names are independent of visibility, pose and renderer. */
#ifndef SCENE_IDENTITY_H
#define SCENE_IDENTITY_H

#include "scene/scene.h"

typedef enum scene_identity_kind {
    SCENE_IDENTITY_OBJECT,   /* number: index of the node plus 1 */
    SCENE_IDENTITY_MATERIAL, /* index of the material plus 1; 0: the default material */
    SCENE_IDENTITY_INSTANCE, /* copies of all nodes with a mesh, counted from 1 in the order of nodes */
    SCENE_IDENTITY_KINDS
} scene_identity_kind;

typedef struct scene_identity {
    float numbers[SCENE_IDENTITY_KINDS];
    float hashes[SCENE_IDENTITY_KINDS];
} scene_identity;

/* AOVs that need identities: facet_aov or-ed. */
enum {
    SCENE_IDENTITY_AOVS =
        FACET_AOV_MATERIAL_ID | FACET_AOV_OBJECT_ID | FACET_AOV_INSTANCE_ID | FACET_AOV_CRYPTOMATTE
};

/* One identity per instance of the pose: a block of mem_alloc(). FACET_ERROR_MEMORY. */
facet_result scene_identities_create(const facet_scene *scene, const scene_pose *pose,
                                     const facet_allocator *allocator, scene_identity **out,
                                     facet_error *error);

/* Cryptomatte's ID of a name: its MurmurHash3 as the bits of a float that is neither infinite, subnormal
 * nor NaN. */
float scene_identity_hash(const char *name);

/* Limit for a manifest: a file can repeat few instances in many nodes, which need not be shown. */
enum { SCENE_IDENTITY_MAX_NAMES = 1 << 20 };

/* Cryptomatte's manifest of everything that the scene may draw: a JSON object from names to IDs of 8
 * hexadecimal digits, in the order of the names. The name of an object is that of its node, else of its
 * mesh, else "node INDEX"; of a material its own, else "material INDEX", or "default material"; of an
 * instance the object's, "#" and the number. FACET_ERROR_MEMORY; text_destroy() *manifest in any case. */
facet_result scene_identity_manifest(const facet_scene *scene, scene_identity_kind kind,
                                     struct text *manifest, facet_error *error);

#endif
