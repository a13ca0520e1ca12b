/* scene.h - a model as plain arrays: the data that all renderers share.
 *
 * Everything in a scene lives in its arena and does not change after loading, except by the conversion of
 * its materials (legacy/convert.h), which replaces arrays. Indices are into the arrays of the scene;
 * SCENE_NONE: absent. */
#ifndef SCENE_SCENE_H
#define SCENE_SCENE_H

#include "base/file.h"
#include "base/memory.h"
#include "base/transform.h"
#include "facet/facet.h"

#define SCENE_NONE UINT32_MAX

/* Coordinates beyond this, m, are not drawn. A camera that frames everything within it stands within 1e18
 * m, and the squares of all these lengths are finite floats. */
#define SCENE_FARTHEST 1e17f

struct text; /* base/text.h */

/* Metadata of a file: JSON text as it was written, NULL: none. */
typedef struct scene_meta {
    const char *extras;     /* the value of "extras" */
    const char *extensions; /* an object of the metadata extensions (KHR_xmp_json_ld, ..) */
} scene_meta;

/* ---- geometry ---- */

typedef enum scene_mode { SCENE_POINTS, SCENE_LINES, SCENE_TRIANGLES } scene_mode;

/* Displacements of a primitive's vertices at weight 1; NULL: none of that attribute. Normals and tangents
 * are not unit. */
typedef struct scene_morph_target {
    const float *positions, *normals, *tangents; /* 3 per vertex, m, finite */
} scene_morph_target;

/* Values of a sea's vertices beside their normals: xx, zz, xz of the covariance of slopes that vertices
 * do not show; the share that foam hides. */
enum { SCENE_WATER_VALUES = 4 };

/* Vertices of one material. Strips, fans and loops are unrolled to lists. */
typedef struct scene_primitive {
    scene_mode mode;
    uint32_t vertex_count;
    uint32_t index_count;    /* a multiple of 1, 2 or 3 */
    const uint32_t *indices; /* always there; each < vertex_count */
    const float *positions;  /* 3 per vertex, m, finite */
    const float *normals;    /* 3 per vertex, unit; NULL for points and lines without normals only (unlit) */
    const float *tangents;   /* 4 per vertex, xyz unit, w +-1; NULL: none */
    uint32_t texcoord_count; /* sets */
    const float *const *texcoords; /* per set 2 per vertex; (0, 0) is the top left of an image */
    const float *colors;           /* 4 per vertex, linear, [0, 1]; NULL: white */
    /* SCENE_WATER_VALUES per vertex, of the surface of a sea; NULL: none. No file has it */
    const float *water;
    uint32_t material; /* SCENE_NONE: the default material */
    /* of positions in use, without triangles that have no area (unseen_tighten_bounds()); 0 if there are
     * none */
    float bounds_min[3], bounds_max[3];
    bool has_flat_triangles;  /* some without area lie outside of the bounds */
    bool is_flat;             /* none of its triangles has an area */
    bool has_flat_normals;    /* the file had no normals: vertices are not shared between triangles */
    uint32_t influence_count; /* joints per vertex: a multiple of 4; 0: no skin */
    const uint16_t *joints;   /* influence_count per vertex: indices into the node's skin */
    const float *weights;     /* the same; >= 0, finite, their sum 1 */
    uint32_t target_count;
    const scene_morph_target *targets;
    /* per variant of the scene; SCENE_NONE: material as above. NULL: none */
    const uint32_t *variant_materials;
    scene_meta meta;
} scene_primitive;

typedef struct scene_mesh {
    const char *name; /* never NULL, may be "" (as all names here); UTF-8 */
    uint32_t primitive_count;
    scene_primitive *primitives;
    uint32_t weight_count; /* of morph targets: the maximum of its primitives */
    const float *weights;  /* 0 if the file does not store them; NULL: none */
    double origin[3];      /* subtracted from the positions of its primitives, m: scene/origin.h */
    scene_meta meta;
} scene_mesh;

/* ---- materials ---- */

typedef enum scene_wrap { SCENE_WRAP_REPEAT, SCENE_WRAP_CLAMP, SCENE_WRAP_MIRROR } scene_wrap;
typedef enum scene_filter { SCENE_FILTER_LINEAR, SCENE_FILTER_NEAREST } scene_filter;
typedef enum scene_mip_filter { SCENE_MIP_LINEAR, SCENE_MIP_NEAREST, SCENE_MIP_NONE } scene_mip_filter;

/* An image of the file; renderers decode it when they need it. */
typedef struct scene_image {
    const char *name;           /* name, or URI, or "" */
    const char *mime_type;      /* detected, "image/png"; "" unknown */
    const unsigned char *bytes; /* NULL: it could not be read, which was reported */
    size_t size;
    uint32_t width, height; /* 0: unknown */
    const char *uri;        /* in the file's spelling; NULL: from a buffer or a data URI */
    scene_meta meta;
} scene_image;

typedef struct scene_texture {
    const char *name;
    uint32_t image; /* SCENE_NONE: not readable; sampled as white */
    scene_wrap wrap_u, wrap_v;
    scene_filter mag_filter, min_filter;
    scene_mip_filter mip_filter;
    scene_meta meta;
} scene_texture;

/* A reference to a texture (glTF textureInfo, KHR_texture_transform). */
typedef struct scene_texture_ref {
    uint32_t texture;  /* SCENE_NONE: no texture, the parameter is its factor */
    uint32_t texcoord; /* set */
    float offset[2], rotation_rad, scale[2];
    bool has_transform; /* set by scene_texture_ref_update(): not the identity */
    float transform[6]; /* u' = t0 u + t1 v + t2, v' = t3 u + t4 v + t5 */
} scene_texture_ref;

/* Sets has_transform and transform from offset, rotation and scale: uv' = translation rotation scale uv. A
 * positive angle turns counter-clockwise on the screen, where v points down. Values that are not finite
 * are ignored. */
void scene_texture_ref_update(scene_texture_ref *ref);

/* Uses of a material's textures. scene/material_table.h has their names and channels. */
typedef enum scene_texture_slot {
    SCENE_BASE_COLOR_TEXTURE, /* of pbrSpecularGlossiness: the diffuse color */
    SCENE_METALLIC_ROUGHNESS_TEXTURE,
    SCENE_NORMAL_TEXTURE,
    SCENE_OCCLUSION_TEXTURE,
    SCENE_EMISSIVE_TEXTURE,
    SCENE_SPECULAR_TEXTURE,
    SCENE_SPECULAR_COLOR_TEXTURE,
    SCENE_CLEARCOAT_TEXTURE,
    SCENE_CLEARCOAT_ROUGHNESS_TEXTURE,
    SCENE_CLEARCOAT_NORMAL_TEXTURE,
    SCENE_SHEEN_COLOR_TEXTURE,
    SCENE_SHEEN_ROUGHNESS_TEXTURE,
    SCENE_TRANSMISSION_TEXTURE,
    SCENE_THICKNESS_TEXTURE,
    SCENE_IRIDESCENCE_TEXTURE,
    SCENE_IRIDESCENCE_THICKNESS_TEXTURE,
    SCENE_ANISOTROPY_TEXTURE,
    SCENE_DIFFUSE_TRANSMISSION_TEXTURE,
    SCENE_DIFFUSE_TRANSMISSION_COLOR_TEXTURE,
    SCENE_SPECULAR_GLOSSINESS_TEXTURE, /* sRGB RGB specular color, linear A glossiness */
    SCENE_DIFFUSE_ROUGHNESS_TEXTURE,
    SCENE_TEXTURE_SLOT_COUNT
} scene_texture_slot;

/* Extensions present in a material, whatever their values; or-ed. */
typedef enum scene_material_extension {
    SCENE_UNLIT = 1 << 0,                 /* KHR_materials_unlit */
    SCENE_EMISSIVE_STRENGTH = 1 << 1,     /* KHR_materials_emissive_strength */
    SCENE_IOR = 1 << 2,                   /* KHR_materials_ior */
    SCENE_SPECULAR = 1 << 3,              /* KHR_materials_specular */
    SCENE_CLEARCOAT = 1 << 4,             /* KHR_materials_clearcoat */
    SCENE_SHEEN = 1 << 5,                 /* KHR_materials_sheen */
    SCENE_TRANSMISSION = 1 << 6,          /* KHR_materials_transmission */
    SCENE_VOLUME = 1 << 7,                /* KHR_materials_volume */
    SCENE_IRIDESCENCE = 1 << 8,           /* KHR_materials_iridescence */
    SCENE_ANISOTROPY = 1 << 9,            /* KHR_materials_anisotropy */
    SCENE_DISPERSION = 1 << 10,           /* KHR_materials_dispersion */
    SCENE_DIFFUSE_TRANSMISSION = 1 << 11, /* KHR_materials_diffuse_transmission */
    SCENE_VOLUME_SCATTER = 1 << 12,       /* KHR_materials_volume_scatter */
    /* KHR_materials_pbrSpecularGlossiness: in place of metallic-roughness */
    SCENE_SPECULAR_GLOSSINESS = 1 << 13,
    SCENE_DIFFUSE_ROUGHNESS = 1 << 14 /* KHR_materials_diffuse_roughness */
} scene_material_extension;

typedef enum scene_alpha_mode { SCENE_ALPHA_OPAQUE, SCENE_ALPHA_MASK, SCENE_ALPHA_BLEND } scene_alpha_mode;

/* glTF 2.0 material with every extension. Colors linear Rec.709; units those of the extensions: thickness
 * and attenuation distance in m, film thickness in nm, angles in rad. scene_material_default() gives the
 * defaults. */
typedef struct scene_material {
    const char *name;
    uint32_t extensions; /* SCENE_UNLIT .. */
    float base_color[4]; /* diffuseFactor where SCENE_SPECULAR_GLOSSINESS */
    float metallic, perceptual_roughness;
    float normal_scale, occlusion_strength;
    float emissive[3], emissive_strength; /* radiance: their product, cd/m^2 */
    scene_alpha_mode alpha_mode;
    float alpha_cutoff;
    bool is_double_sided;

    float ior;                            /* 1.5; 0: F0 = 1 */
    float specular, specular_color[3];    /* 1; specularFactor of SCENE_SPECULAR_GLOSSINESS: specular_color */
    float glossiness;                     /* SCENE_SPECULAR_GLOSSINESS only; 1 */
    float clearcoat, clearcoat_roughness; /* 0 */
    float clearcoat_normal_scale;         /* 1 */
    float sheen_color[3], sheen_roughness;                              /* 0 */
    float transmission;                                                 /* 0 */
    float thickness;                                                    /* 0: thin-walled */
    float attenuation_distance;                                         /* INFINITY */
    float attenuation_color[3];                                         /* 1 */
    float iridescence, iridescence_ior;                                 /* 0, 1.3 */
    float iridescence_thickness_minimum, iridescence_thickness_maximum; /* 100, 400 */
    float anisotropy, anisotropy_rotation;                              /* 0 */
    float dispersion;                                                   /* 0; 20 / Abbe number */
    float diffuse_transmission, diffuse_transmission_color[3];          /* 0, 1 */
    float multiscatter_color[3], scatter_anisotropy;                    /* 0 */
    float diffuse_roughness;                                            /* 0 */

    scene_texture_ref textures[SCENE_TEXTURE_SLOT_COUNT];
    scene_meta meta;
} scene_material;

scene_material scene_material_default(void);
static inline bool scene_material_has(const scene_material *m, scene_texture_slot slot)
{
    return m->textures[slot].texture != SCENE_NONE;
}

/* ---- nodes, cameras, lights ---- */

typedef struct scene_camera {
    const char *name;
    bool is_orthographic;
    float fov_y_rad, aspect;         /* perspective; aspect 0: the image's */
    float ortho_height, ortho_width; /* full extent (twice ymag, xmag) */
    float near_m, far_m;             /* far 0: infinite */
    scene_meta meta;
} scene_camera;

typedef enum scene_light_type {
    SCENE_LIGHT_DIRECTIONAL,
    SCENE_LIGHT_POINT,
    SCENE_LIGHT_SPOT
} scene_light_type;

/* KHR_lights_punctual; emits along the node's -Z. */
typedef struct scene_light {
    const char *name;
    scene_light_type type;
    float color[3];                       /* linear */
    float intensity;                      /* cd, or lx for a directional one */
    float range;                          /* m; 0: no limit */
    float inner_cone_rad, outer_cone_rad; /* spot */
    scene_meta meta;
} scene_light;

/* EXT_lights_image_based: a cube map with its GGX mips, and irradiance as spherical harmonics. */
typedef struct scene_image_light {
    const char *name;
    float rotation[4]; /* unit quaternion x y z w */
    float intensity;
    float irradiance[9][3]; /* l = 0 .. 2, in the file's order */
    uint32_t specular_size; /* texels along an edge of a face of mip 0 */
    uint32_t mip_count;
    const uint32_t *images; /* 6 per mip, +X -X +Y -Y +Z -Z: indices of scene images */
    scene_meta meta;
} scene_image_light;

/* EXT_mesh_gpu_instancing: transforms of a node's instances, in the node's space. NULL: 0, identity, 1. */
typedef struct scene_instancing {
    uint32_t count;
    const float *translations, *rotations, *scales; /* 3, 4 (unit x y z w), 3 per instance */
} scene_instancing;

typedef struct scene_node {
    const char *name;
    uint32_t parent; /* SCENE_NONE: a root */
    uint32_t child_count;
    const uint32_t *children;
    bool is_hidden;  /* KHR_node_visibility; applies to descendants */
    bool has_matrix; /* matrix instead of translation, rotation, scale */
    dmat4 matrix;
    double translation[3];       /* m; in double, as a model may be far from the origin (scene/origin.h) */
    float rotation[4], scale[3]; /* rotation a unit quaternion x y z w */
    uint32_t mesh, camera, light, skin;
    const float *weights;               /* of morph targets, as many as the mesh has; NULL: the mesh's */
    const scene_instancing *instancing; /* NULL: drawn once */
    scene_meta meta;
} scene_node;

/* A root at the origin, without rotation and with nothing attached. */
scene_node scene_node_default(const char *name);

/* One of the file's scenes. */
typedef struct scene_root {
    const char *name;
    uint32_t node_count;
    const uint32_t *nodes;
    uint32_t image_light; /* SCENE_NONE: none */
    scene_meta meta;
} scene_root;

/* ---- motion ---- */

typedef struct scene_skin {
    const char *name;
    uint32_t joint_count;
    const uint32_t *joints;   /* nodes */
    const mat4 *inverse_bind; /* per joint; NULL: identities */
    uint32_t skeleton;        /* a node, or SCENE_NONE; has no effect */
    scene_meta meta;
} scene_skin;

typedef enum scene_interpolation { SCENE_STEP, SCENE_LINEAR, SCENE_CUBIC_SPLINE } scene_interpolation;

/* Keys over time. SCENE_CUBIC_SPLINE: an in-tangent, the value and an out-tangent per key. */
typedef struct scene_sampler {
    scene_interpolation interpolation;
    uint32_t key_count;  /* at least 1 */
    const float *times;  /* s, finite, strictly increasing */
    uint32_t width;      /* floats per value */
    const float *values; /* width per key, three times as many where SCENE_CUBIC_SPLINE; finite */
} scene_sampler;

/* The target of a channel. */
typedef enum scene_target_kind {
    SCENE_TARGET_NODE,     /* floats of a scene_node: translation, rotation, scale */
    SCENE_TARGET_VISIBLE,  /* is_hidden of a node: hidden where the value is below 0.5 */
    SCENE_TARGET_WEIGHTS,  /* weights of a node's mesh, from weight `offset` on */
    SCENE_TARGET_MATERIAL, /* floats of a scene_material or its texture refs */
    SCENE_TARGET_LIGHT,    /* floats of a scene_light */
    SCENE_TARGET_CAMERA    /* floats of a scene_camera */
} scene_target_kind;

typedef struct scene_channel {
    scene_target_kind kind;
    uint32_t index;      /* of the node, material, light, camera */
    size_t offset;       /* bytes to the first float in the struct; WEIGHTS: index of the first weight */
    float scale;         /* factor of the values (a camera's ymag is half the height); 1 */
    bool is_rotation;    /* a unit quaternion: linear keys are interpolated along the great circle */
    uint32_t sampler;    /* of the animation */
    const char *pointer; /* JSON pointer of KHR_animation_pointer; NULL: a target of the core */
} scene_channel;

typedef struct scene_animation {
    const char *name;
    uint32_t channel_count, sampler_count;
    const scene_channel *channels; /* later ones take precedence for the same target */
    const scene_sampler *samplers;
    float begin_s, end_s; /* first and last key of all */
    bool is_external;     /* of an external asset, which plays with the file's own */
    scene_meta meta;
} scene_animation;

typedef enum scene_support { SCENE_SUPPORTED, SCENE_APPROXIMATED, SCENE_IGNORED } scene_support;

typedef struct scene_extension {
    const char *name;
    bool is_required, is_present; /* present: used by some object of the file */
    scene_support support;
} scene_extension;

/* What messages name by the number that it has in its file. */
typedef enum scene_item {
    SCENE_ITEM_IMAGE,
    SCENE_ITEM_MATERIAL,
    SCENE_ITEM_IMAGE_LIGHT,
    SCENE_ITEM_COUNT
} scene_item;

/* What facet_scene_place() moves: a root of the default scene. */
typedef struct scene_part {
    uint32_t node;
    double origin[3];                 /* the part's origin before it was placed */
    const char *source;               /* the file that it was loaded from, for messages */
    uint32_t first[SCENE_ITEM_COUNT]; /* index in the scene of what has the number 0 in that file */
} scene_part;

/* An asset of another file whose roots are children of a node (glTF 2.1: externalAssets), with those inside it. */
typedef struct scene_external {
    const char *name; /* the path of nodes to it, "stage/lamp" */
    const char *file; /* its path, or where it is embedded */
    uint32_t node;
    uint32_t depth;      /* 0: of this file; 1: of an asset in it, .. */
    uint32_t node_count; /* with those of the assets inside it */
} scene_external;

/* An array that was joined, with space for what is appended next: in scene/parts.c. */
typedef struct scene_room {
    const void *array;
    size_t capacity; /* bytes */
} scene_room;
enum { SCENE_ROOM_COUNT = 17 };

typedef struct facet_scene {
    facet_allocator allocator;
    arena *arena;
    const char *source;    /* the path or name of the file, for messages; of several parts: of the files */
    const char *generator; /* asset.generator, asset.version, asset.copyright; "" */
    const char *version;
    const char *copyright;

    uint32_t mesh_count, material_count, texture_count, image_count, node_count, camera_count, light_count;
    uint32_t scene_count, extension_count, warning_count, skin_count, animation_count, variant_count;
    uint32_t image_light_count, note_count;
    scene_mesh *meshes;
    scene_material *materials;
    scene_texture *textures;
    scene_image *images;
    scene_node *nodes;
    scene_camera *cameras;
    scene_light *lights;
    scene_image_light *image_lights;
    scene_skin *skins;
    scene_animation *animations;
    const char **variants; /* KHR_materials_variants: names */
    scene_root *scenes;
    scene_meta meta, asset_meta; /* of the root object: xmp packets; of "asset" */
    /* scene/origin.h: the point of the file's world to which everything posed is relative, m; 0 unless the
     * model is far from it. is_far: worlds of nodes are composed in double. */
    double origin[3];
    bool is_far;
    bool is_appended; /* it belongs to another scene: scene_keep_scene() */
    /* Raised by every change after loading, so that renderers drop what they have made of an earlier state:
     * by the place of a part or the values of a material; by anything else. */
    uint64_t place_revision, content_revision;
    uint32_t external_count;
    scene_external *externals;
    uint32_t part_count; /* 0: the scene was neither placed nor joined with another */
    scene_part *parts;
    scene_room rooms[SCENE_ROOM_COUNT];
    uint32_t default_scene; /* 0 where the file names none; SCENE_NONE: the file has no scene */
    scene_extension *extensions;
    const char **warnings; /* warnings sent to log during reading */
    const char **notes;    /* violations of the file format without effect */

    struct scene_legacy *legacy;         /* scene/legacy.h; NULL: materials of glTF only */
    struct scene_conversion *conversion; /* the last conversion; NULL: none */

    uint32_t max_texture_size; /* from the desc, for decoding later */
    uint32_t thread_count;     /* from the desc, for queries; 0: facet_thread_count() */
    uint32_t file_count;       /* files that arrays and images point into */
    file_bytes *files;
    size_t search_budget; /* limit of folder entries to examine in searches for files with alike names */
} facet_scene;

/* An empty scene with its arena. */
facet_result scene_create(const facet_allocator *allocator, const char *source, facet_scene **out,
                          facet_error *error);
void scene_destroy(facet_scene *scene); /* NULL is allowed */
/* Takes ownership of an open file (leaves {0} in *file), which is closed with the scene. path: as it was opened.
 * False: no memory, *file is unchanged. */
bool scene_keep_file(facet_scene *scene, file_bytes *file, const char *path);
/* Index in scene->files of an open file by device and inode; SCENE_NONE: none. */
uint32_t scene_find_file(const facet_scene *scene, uint64_t device, uint64_t number);
/* Records a file that will be closed, for scene_has_file(). False: no memory. */
bool scene_note_file(facet_scene *scene, const file_bytes *file, const char *path);
/* facet_scene_has_file(): one of scene->files. */
bool scene_has_file(const facet_scene *scene, const char *path);
/* facet_scene_get_file(): the path of one of scene->files. */
const char *scene_get_file(const facet_scene *scene, uint32_t index);
/* Appends to scene->warnings and sends the message to log; equal messages are kept once. */
void scene_warn(facet_scene *scene, const facet_log *log, const char *format, ...)
    __attribute__((format(printf, 3, 4)));
/* The same for scene->notes; log gets FACET_LOG_LEVEL_DETAIL. */
void scene_note(facet_scene *scene, const facet_log *log, const char *format, ...)
    __attribute__((format(printf, 3, 4)));
/* Looks up scene->materials[index], or the default material for SCENE_NONE. */
const scene_material *scene_get_material(const facet_scene *scene, uint32_t index);

/* The file that an item is of, and its number there: for messages. */
typedef struct scene_address {
    const char *source;
    uint32_t number;
} scene_address;
scene_address scene_get_address(const facet_scene *scene, scene_item item, uint32_t index);

/* facet_scene_place_part(), facet_scene_append(). */
facet_result scene_place(facet_scene *scene, uint32_t part, const float matrix[16], facet_error *error);
facet_result scene_append(facet_scene *scene, facet_scene *other, facet_error *error);
/* Takes ownership of a scene into whose arrays this one points, and adds its warnings and notes. */
void scene_keep_scene(facet_scene *scene, facet_scene *other);
/* facet_scene_create_builtin(), facet_scene_get_counts(), facet_scene_describe_json(). */
facet_result scene_create_builtin(const facet_scene_desc *desc, facet_scene **out, facet_error *error);
facet_scene_counts scene_count(const facet_scene *scene);
void scene_describe_json(const facet_scene *scene, struct text *out);

/* ---- a scene at one point in time, in world space relative to the scene's origin ---- */

/* One drawn primitive. */
typedef struct scene_instance {
    const scene_primitive *primitive;
    /* In local space: the primitive's, or the pose's own if is_deformed. */
    const float *positions, *normals, *tangents;
    float bounds_min[3], bounds_max[3]; /* of positions in use */
    /* By morph targets or a skin. A skin's vertices are in world space, and world is the identity, or a
     * reflection in x if most of the joints reflect. */
    bool is_deformed;
    /* EXT_mesh_gpu_instancing: a copy of the previous instance, with the same node and primitive. */
    bool is_copy;
    uint32_t copy;     /* its index among the copies of the node, including those that are not drawn */
    uint32_t material; /* in the selected variant; SCENE_NONE: the default material */
    mat4 world;
    float normal_matrix[9]; /* cofactor matrix, rows; normalise after use; sign already such that a mirrored
                                instance keeps outward normals */
    bool is_mirrored;       /* determinant < 0: winding is reversed */
    bool is_unseen;         /* invisible to every camera: scene/unseen.h */
    uint32_t node, mesh, primitive_index;
} scene_instance;

typedef struct scene_posed_light {
    scene_light light;
    float position[3];  /* m */
    float direction[3]; /* unit, the direction of emission */
    uint32_t node;
} scene_posed_light;

typedef struct scene_posed_camera {
    scene_camera camera;
    uint32_t index; /* into scene->cameras */
    mat4 world;
    uint32_t node;
} scene_posed_camera;

/* The visible contents of one scene of the file at one point in time. */
typedef struct scene_pose {
    uint32_t instance_count, light_count, camera_count;
    scene_instance *instances;
    scene_posed_light *lights;
    scene_posed_camera *cameras;
    const scene_material *materials; /* the scene's, or copies if an animation changes some */
    /* of all visible instances (of all if none is visible), world space, exact; 0: none */
    float bounds_min[3], bounds_max[3];
    bool has_bounds;
    bool is_unseen;                   /* all instances are unseen */
    void *deformed, *material_copies; /* memory of the pose */
} scene_pose;

/* Evaluates desc (NULL: {0}). A file without scenes has one, number 0, of all its roots. Instances with
 * singular matrices, or beyond SCENE_FARTHEST, are left out. Fails with FACET_ERROR_ARGUMENT for an
 * unknown scene, variant or animation and a time that is not finite, FACET_ERROR_LIMIT above 2^22
 * instances or 2^27 deformed vertices, FACET_ERROR_MEMORY. */
facet_result scene_pose_create(const facet_scene *scene, const facet_pose_desc *desc,
                               const facet_allocator *allocator, uint32_t thread_count, scene_pose *pose,
                               facet_error *error);
void scene_pose_destroy(scene_pose *pose); /* {0} is allowed */
/* The scene that desc selects; FACET_ERROR_ARGUMENT if that or the variant does not exist. */
facet_result scene_pose_check(const facet_scene *scene, const facet_pose_desc *desc, uint32_t *index,
                              facet_error *error);
/* The material of an instance at that time. */
const scene_material *scene_pose_material(const facet_scene *scene, const scene_pose *pose,
                                          const scene_instance *instance);

/* ---- cameras ---- */

/* facet_orbit_default(). */
facet_orbit scene_orbit_default(void);

/* facet_camera_from_orbit() for an existing pose, which may be empty; fits_all_times is ignored. The
 * distance is exact: at radius_scale 1 the outermost vertex is on the border of the image. Fails with
 * FACET_ERROR_ARGUMENT for invalid values. */
facet_result scene_fit_pose(const facet_scene *scene, const scene_pose *pose, const facet_orbit *orbit,
                            float aspect, uint32_t thread_count, facet_camera *camera, facet_error *error);
/* facet_camera_from_orbit(). If the orbit fits all times, the motion is sampled at every key of the
 * animations and 24 times per second, or at SCENE_FIT_TIMES even steps if there would be more. */
enum { SCENE_FIT_TIMES = 256 };
facet_result scene_fit_orbit(const facet_scene *scene, const facet_pose_desc *desc, const facet_orbit *orbit,
                             float aspect, facet_camera *camera, facet_error *error);

/* ---- derived attributes ---- */

/* Tangents for a triangle primitive with normals and texcoord set uv_set, compatible with MikkTSpace
 * (Mikkelsen 2008): one per index, so that out has 4 * index_count floats, corner by corner. */
facet_result scene_generate_tangents(const scene_primitive *primitive, uint32_t uv_set,
                                     const facet_allocator *allocator, float *out, facet_error *error);

#endif
