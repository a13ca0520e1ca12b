/* scene.h - a model as plain arrays: what every renderer reads, and nothing that only one needs.
 *
 * Everything in a scene lives in its arena and does not change after it was loaded. Indices are into the arrays
 * of the scene; SCENE_NONE: absent. */
#ifndef SCENE_SCENE_H
#define SCENE_SCENE_H

#include "base/file.h"
#include "base/memory.h"
#include "base/transform.h"
#include "facet/facet.h"

#define SCENE_NONE UINT32_MAX

/* Coordinates beyond this, m, are not drawn. A camera that frames what lies within stands within 1e18 m, and the
 * squares of all these lengths are finite floats. */
#define SCENE_FARTHEST 1e17f

struct text; /* base/text.h */

/* ---- geometry ---- */

typedef enum scene_mode { SCENE_POINTS, SCENE_LINES, SCENE_TRIANGLES } scene_mode;

/* Vertices of one material. Strips, fans and loops are lists here. */
typedef struct scene_primitive {
    scene_mode mode;
    uint32_t vertex_count;
    uint32_t index_count;    /* a multiple of 1, 2 or 3 */
    const uint32_t *indices; /* always there; each < vertex_count */
    const float *positions;  /* 3 per vertex, m, finite */
    const float *normals;    /* 3 per vertex, unit; NULL only for points and lines without (then unlit) */
    const float *tangents;   /* 4 per vertex, xyz unit, w +-1; NULL: none */
    uint32_t texcoord_count; /* sets */
    const float *const *texcoords;      /* per set 2 per vertex; (0, 0) is the top left of an image */
    const float *colors;                /* 4 per vertex, linear, [0, 1]; NULL: white */
    uint32_t material;                  /* SCENE_NONE: the default material */
    float bounds_min[3], bounds_max[3]; /* of the positions that indices use; 0 where there are none */
    bool has_flat_normals;              /* the file had none: vertices are not shared between triangles */
} scene_primitive;

typedef struct scene_mesh {
    const char *name; /* never NULL, may be "" (as all names here); UTF-8 */
    uint32_t primitive_count;
    scene_primitive *primitives;
} scene_mesh;

/* ---- materials ---- */

typedef enum scene_wrap { SCENE_WRAP_REPEAT, SCENE_WRAP_CLAMP, SCENE_WRAP_MIRROR } scene_wrap;
typedef enum scene_filter { SCENE_FILTER_LINEAR, SCENE_FILTER_NEAREST } scene_filter;
typedef enum scene_mip_filter { SCENE_MIP_LINEAR, SCENE_MIP_NEAREST, SCENE_MIP_NONE } scene_mip_filter;

/* An image as the file has it; decoded when a renderer asks. */
typedef struct scene_image {
    const char *name;           /* name, or URI, or "" */
    const char *mime_type;      /* by content, "image/png"; "" unknown */
    const unsigned char *bytes; /* NULL: it could not be read; a warning said so */
    size_t size;
    uint32_t width, height; /* 0: unknown */
} scene_image;

typedef struct scene_texture {
    const char *name;
    uint32_t image; /* SCENE_NONE: none that facet can read; sampled as white */
    scene_wrap wrap_u, wrap_v;
    scene_filter mag_filter, min_filter;
    scene_mip_filter mip_filter;
} scene_texture;

/* Where a parameter reads a texture (glTF textureInfo). */
typedef struct scene_texture_ref {
    uint32_t texture;  /* SCENE_NONE: no texture, the parameter is its factor */
    uint32_t texcoord; /* set */
    bool has_transform;
    float transform[6]; /* KHR_texture_transform: u' = t0 u + t1 v + t2, v' = t3 u + t4 v + t5 */
} scene_texture_ref;

typedef enum scene_alpha_mode { SCENE_ALPHA_OPAQUE, SCENE_ALPHA_MASK, SCENE_ALPHA_BLEND } scene_alpha_mode;

/* glTF 2.0 material with the extensions that shade/ knows. Colors linear Rec.709. scene_material_default() gives
 * the specification's defaults. Extensions to come add members behind these. */
typedef struct scene_material {
    const char *name;
    float base_color[4];
    float metallic, perceptual_roughness;
    float normal_scale, occlusion_strength;
    float emissive[3]; /* cd/m^2 with emissive_strength multiplied in */
    scene_alpha_mode alpha_mode;
    float alpha_cutoff;
    bool is_double_sided;
    bool is_unlit;           /* KHR_materials_unlit */
    float ior;               /* KHR_materials_ior; 1.5; 0: F0 = 1 */
    float specular;          /* KHR_materials_specular: specularFactor, 1 */
    float specular_color[3]; /* specularColorFactor, 1 */

    scene_texture_ref base_color_texture;         /* sRGB RGBA */
    scene_texture_ref metallic_roughness_texture; /* linear G roughness, B metallic */
    scene_texture_ref normal_texture;             /* linear RGB, +Y up */
    scene_texture_ref occlusion_texture;          /* linear R */
    scene_texture_ref emissive_texture;           /* sRGB RGB */
    scene_texture_ref specular_texture;           /* linear A */
    scene_texture_ref specular_color_texture;     /* sRGB RGB */
} scene_material;

scene_material scene_material_default(void);

/* ---- nodes, cameras, lights ---- */

typedef struct scene_camera {
    const char *name;
    bool is_orthographic;
    float fov_y_rad, aspect;         /* perspective; aspect 0: the picture's */
    float ortho_height, ortho_width; /* full extent (twice ymag, xmag) */
    float near_m, far_m;             /* far 0: infinite */
} scene_camera;

typedef enum scene_light_type {
    SCENE_LIGHT_DIRECTIONAL,
    SCENE_LIGHT_POINT,
    SCENE_LIGHT_SPOT
} scene_light_type;

/* KHR_lights_punctual; shines along the node's -Z. */
typedef struct scene_light {
    const char *name;
    scene_light_type type;
    float color[3];                       /* linear */
    float intensity;                      /* cd, or lx for a directional one */
    float range;                          /* m; 0: no limit */
    float inner_cone_rad, outer_cone_rad; /* spot */
} scene_light;

typedef struct scene_node {
    const char *name;
    uint32_t parent; /* SCENE_NONE: a root */
    uint32_t child_count;
    const uint32_t *children;
    bool is_hidden;  /* KHR_node_visibility; with all below it */
    bool has_matrix; /* matrix instead of translation, rotation, scale */
    mat4 matrix;
    float translation[3], rotation[4], scale[3]; /* rotation a unit quaternion x y z w */
    uint32_t mesh, camera, light, skin;
} scene_node;

/* One of the file's scenes. */
typedef struct scene_root {
    const char *name;
    uint32_t node_count;
    const uint32_t *nodes;
} scene_root;

typedef enum scene_support { SCENE_SUPPORTED, SCENE_APPROXIMATED, SCENE_IGNORED } scene_support;

typedef struct scene_extension {
    const char *name;
    bool is_required;
    scene_support support;
} scene_extension;

typedef struct facet_scene {
    facet_allocator allocator;
    arena *arena;
    const char *source;    /* the path or name it was read from, for messages */
    const char *generator; /* asset.generator, asset.version, asset.copyright; "" */
    const char *version;
    const char *copyright;

    uint32_t mesh_count, material_count, texture_count, image_count, node_count, camera_count, light_count;
    uint32_t scene_count, extension_count, warning_count, skin_count, animation_count;
    scene_mesh *meshes;
    scene_material *materials;
    scene_texture *textures;
    scene_image *images;
    scene_node *nodes;
    scene_camera *cameras;
    scene_light *lights;
    scene_root *scenes;
    uint32_t default_scene; /* 0 where the file names none; SCENE_NONE: the file has no scene */
    scene_extension *extensions;
    const char **warnings; /* what log got while reading */

    uint32_t max_texture_size; /* from the desc, for the decoding to come */
    uint32_t thread_count;     /* from the desc, for questions about the scene; 0: facet_thread_count() */
    uint32_t file_count;       /* files that arrays and images point into */
    file_bytes *files;
} facet_scene;

/* An empty scene with its arena. */
facet_result scene_create(const facet_allocator *allocator, const char *source, facet_scene **out,
                          facet_error *error);
void scene_destroy(facet_scene *scene); /* NULL is allowed */
/* Takes over an open file (leaves {0} in *file): closed with the scene. False: no memory, *file is as it was. */
bool scene_keep_file(facet_scene *scene, file_bytes *file);
/* Appends to scene->warnings and tells log; the same text is kept once. */
void scene_warn(facet_scene *scene, const facet_log *log, const char *format, ...)
    __attribute__((format(printf, 3, 4)));
/* Looks up scene->materials[index], or the default material for SCENE_NONE. */
const scene_material *scene_get_material(const facet_scene *scene, uint32_t index);

/* facet_scene_create_builtin(), facet_scene_get_counts(), facet_scene_describe_json(). */
facet_result scene_create_builtin(const facet_scene_desc *desc, facet_scene **out, facet_error *error);
facet_scene_counts scene_count(const facet_scene *scene);
void scene_describe_json(const facet_scene *scene, struct text *out);

/* ---- a scene at rest in world space ---- */

typedef struct scene_instance {
    const scene_primitive *primitive;
    mat4 world;
    float normal_matrix[9]; /* cofactor matrix, rows; normalise after use; sign already such that a mirrored
                                instance keeps outward normals */
    bool is_mirrored;       /* determinant < 0: winding is reversed */
    uint32_t node, mesh, primitive_index;
} scene_instance;

typedef struct scene_posed_light {
    const scene_light *light;
    float position[3];  /* m */
    float direction[3]; /* unit, the way it shines */
    uint32_t node;
} scene_posed_light;

typedef struct scene_posed_camera {
    uint32_t camera; /* index into scene->cameras */
    mat4 world;
    uint32_t node;
} scene_posed_camera;

/* What one scene of the file draws. */
typedef struct scene_pose {
    uint32_t instance_count, light_count, camera_count;
    scene_instance *instances;
    scene_posed_light *lights;
    scene_posed_camera *cameras;
    float bounds_min[3], bounds_max[3]; /* of all instances, world space, from every used vertex; 0: none */
    bool has_bounds;
} scene_pose;

/* Evaluates scene number index (FACET_DEFAULT: the default one). A file without scenes has one, number 0, of all
 * its roots. Singular node matrices draw nothing, and what they would put farther out than SCENE_FARTHEST. Fails with
 * FACET_ERROR_ARGUMENT for an index that is not there, FACET_ERROR_LIMIT above 2^22 instances. */
facet_result scene_pose_create(const facet_scene *scene, uint32_t index, const facet_allocator *allocator,
                               uint32_t thread_count, scene_pose *pose, facet_error *error);
void scene_pose_destroy(scene_pose *pose); /* {0} is allowed */

/* ---- cameras ---- */

/* facet_camera_from_orbit() for a pose that is there (it may draw nothing). The distance is exact: at radius_scale 1
 * the outermost vertex is on the border of the picture. Fails with FACET_ERROR_ARGUMENT for numbers that are no
 * camera. */
facet_result scene_fit_pose(const scene_pose *pose, const facet_orbit *orbit, float aspect,
                            uint32_t thread_count, facet_camera *camera, facet_error *error);
/* facet_camera_from_orbit(). */
facet_result scene_fit_orbit(const facet_scene *scene, uint32_t scene_index, const facet_orbit *orbit,
                             float aspect, facet_camera *camera, facet_error *error);

/* ---- derived attributes ---- */

/* Tangents for a triangle primitive that has normals and texcoord set uv_set, compatible with MikkTSpace
 * (Mikkelsen 2008): one per index, so out has 4 * index_count floats, corner by corner. */
facet_result scene_generate_tangents(const scene_primitive *primitive, uint32_t uv_set,
                                     const facet_allocator *allocator, float *out, facet_error *error);

#endif
