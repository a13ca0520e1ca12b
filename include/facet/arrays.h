/* facet/arrays.h - scenes from arrays in memory: meshes, materials, textures, nodes, cameras and lights. What the
 * fields mean is what glTF 2.0 and its extensions say; a scene from arrays is the one that a .glb file of the same numbers
 * gives, to the last bit of an image. */
#ifndef FACET_ARRAYS_H
#define FACET_ARRAYS_H

#include "base.h"
#include "scene.h"

#ifdef __cplusplus
extern "C" {
#endif

/* ---- textures ---- */

typedef enum facet_wrap { FACET_WRAP_REPEAT, FACET_WRAP_CLAMP, FACET_WRAP_MIRROR } facet_wrap;
typedef enum facet_texture_filter {
    FACET_TEXTURE_FILTER_LINEAR,
    FACET_TEXTURE_FILTER_NEAREST
} facet_texture_filter;
typedef enum facet_mip_filter {
    FACET_MIP_FILTER_LINEAR,
    FACET_MIP_FILTER_NEAREST,
    FACET_MIP_FILTER_NONE
} facet_mip_filter;

/* The bytes of an image file, or pixels. */
typedef struct facet_texture_desc {
    const char *name;   /* NULL: "" */
    const void *bytes;  /* PNG, JPEG, WebP, AVIF, KTX2, TGA, BMP, GIF or DDS; NULL: pixels */
    size_t size;        /* of bytes */
    const void *pixels; /* 8 bits a channel, straight alpha, rows from the top; colors are sRGB */
    uint32_t width, height;
    uint32_t channel_count;  /* 1: grey, 2: grey and alpha, 3: RGB, 4: RGBA */
    size_t row_stride_bytes; /* 0: rows without padding */
    facet_wrap wrap_u, wrap_v;
    facet_texture_filter mag_filter, min_filter;
    facet_mip_filter mip_filter;
} facet_texture_desc;

/* ---- materials ---- */

/* Textures of a material; the channels are those of glTF. */
typedef enum facet_texture_slot {
    FACET_TEXTURE_SLOT_BASE_COLOR,         /* of specular-glossiness: the diffuse color */
    FACET_TEXTURE_SLOT_METALLIC_ROUGHNESS, /* G: roughness, B: metallic */
    FACET_TEXTURE_SLOT_NORMAL,
    FACET_TEXTURE_SLOT_OCCLUSION, /* R */
    FACET_TEXTURE_SLOT_EMISSIVE,
    FACET_TEXTURE_SLOT_SPECULAR, /* A */
    FACET_TEXTURE_SLOT_SPECULAR_COLOR,
    FACET_TEXTURE_SLOT_CLEARCOAT,           /* R */
    FACET_TEXTURE_SLOT_CLEARCOAT_ROUGHNESS, /* G */
    FACET_TEXTURE_SLOT_CLEARCOAT_NORMAL,
    FACET_TEXTURE_SLOT_SHEEN_COLOR,
    FACET_TEXTURE_SLOT_SHEEN_ROUGHNESS,       /* A */
    FACET_TEXTURE_SLOT_TRANSMISSION,          /* R */
    FACET_TEXTURE_SLOT_THICKNESS,             /* G */
    FACET_TEXTURE_SLOT_IRIDESCENCE,           /* R */
    FACET_TEXTURE_SLOT_IRIDESCENCE_THICKNESS, /* G */
    FACET_TEXTURE_SLOT_ANISOTROPY,            /* RG: direction, B: strength */
    FACET_TEXTURE_SLOT_DIFFUSE_TRANSMISSION,  /* A */
    FACET_TEXTURE_SLOT_DIFFUSE_TRANSMISSION_COLOR,
    FACET_TEXTURE_SLOT_SPECULAR_GLOSSINESS, /* RGB: specular color, A: glossiness */
    FACET_TEXTURE_SLOT_DIFFUSE_ROUGHNESS,   /* R */
    FACET_TEXTURE_SLOT_COUNT
} facet_texture_slot;

/* A texture as a material uses it: uv' = translation rotation scale uv (KHR_texture_transform). {0}: none. */
typedef struct facet_texture_use {
    bool is_used;
    uint32_t texture;  /* of facet_arrays_desc.textures */
    uint32_t texcoord; /* set of texture coordinates */
    float offset[2], rotation_rad;
    float scale[2]; /* {0}: 1 */
} facet_texture_use;

typedef enum facet_alpha_mode {
    FACET_ALPHA_MODE_OPAQUE,
    FACET_ALPHA_MODE_MASK,
    FACET_ALPHA_MODE_BLEND
} facet_alpha_mode;

/* Start from facet_material_default(), whose values are those of glTF, given below. Colors are linear Rec.709. */
typedef struct facet_material {
    const char *name; /* NULL: "" */
    bool is_unlit;
    bool
        is_specular_glossiness; /* base_color is diffuse, specular_color F0; instead of metallic and roughness */
    float base_color[4];        /* 1 */
    float metallic, perceptual_roughness;   /* 1 */
    float normal_scale, occlusion_strength; /* 1 */
    float emissive[3], emissive_strength;   /* 0; 1; their product is cd/m^2 */
    facet_alpha_mode alpha_mode;
    float alpha_cutoff; /* 0.5 */
    bool is_double_sided;
    float ior;                                                          /* 1.5 */
    float specular, specular_color[3];                                  /* 1 */
    float glossiness;                                                   /* 1; of specular-glossiness */
    float clearcoat, clearcoat_roughness;                               /* 0 */
    float clearcoat_normal_scale;                                       /* 1 */
    float sheen_color[3], sheen_roughness;                              /* 0 */
    float transmission;                                                 /* 0 */
    float thickness;                                                    /* m; 0: thin-walled */
    float attenuation_distance;                                         /* m; INFINITY */
    float attenuation_color[3];                                         /* 1 */
    float iridescence, iridescence_ior;                                 /* 0; 1.3 */
    float iridescence_thickness_minimum, iridescence_thickness_maximum; /* nm; 100; 400 */
    float anisotropy, anisotropy_rotation;                              /* 0; rad */
    float dispersion;                                                   /* 0; 20 / Abbe number */
    float diffuse_transmission, diffuse_transmission_color[3];          /* 0; 1 */
    float multiscatter_color[3], scatter_anisotropy;                    /* 0 */
    float diffuse_roughness;                                            /* 0: Lambert */
    facet_texture_use textures[FACET_TEXTURE_SLOT_COUNT];               /* by facet_texture_slot */
} facet_material;
FACET_API facet_material facet_material_default(void);

/* ---- meshes ---- */

typedef enum facet_primitive_mode {
    FACET_PRIMITIVE_MODE_TRIANGLES, /* counter-clockwise from outside */
    FACET_PRIMITIVE_MODE_LINES,
    FACET_PRIMITIVE_MODE_POINTS
} facet_primitive_mode;

enum { FACET_MAX_TEXCOORDS = 8 };

/* Vertices of one material. Numbers must be finite, positions at most 1e17 m from the origin. */
typedef struct facet_primitive_desc {
    facet_primitive_mode mode;
    uint32_t vertex_count;
    const float *positions; /* 3 per vertex, m */
    /* 3 per vertex, of any length; those of length 0 become those of the adjacent triangles. NULL: triangles are flat,
     * lines and points unlit */
    const float *normals;
    const float *tangents; /* 4 per vertex, w is 1 or -1; NULL: computed where a texture needs them */
    /* sets, 2 per vertex, (0, 0) is the top left of an image; NULL: no further set */
    const float *texcoords[FACET_MAX_TEXCOORDS];
    const float *colors;     /* 4 per vertex, linear, clamped to [0, 1]; NULL: white */
    uint32_t index_count;    /* a multiple of 3 for triangles, of 2 for lines */
    const uint32_t *indices; /* NULL: the vertices in their order */
    bool has_material;       /* false: the default material of glTF */
    uint32_t material;       /* of facet_arrays_desc.materials */
    /* one material per variant, UINT32_MAX: as without variants; NULL: all so */
    const uint32_t *variant_materials;
} facet_primitive_desc;

typedef struct facet_mesh_desc {
    const char *name; /* NULL: "" */
    uint32_t primitive_count;
    const facet_primitive_desc *primitives;
} facet_mesh_desc;

/* ---- nodes, cameras, lights ---- */

/* A camera of the scene; it looks along -Z of its node. */
typedef struct facet_camera_desc {
    const char *name;    /* NULL: "" */
    float fov_y_rad;     /* (0, 3.14); 0: orthographic with ortho_height */
    float ortho_height;  /* m, full height of the image */
    float aspect;        /* 0: that of the image; orthographic: 1 */
    float near_m, far_m; /* far_m 0: infinite */
} facet_camera_desc;

typedef enum facet_light_type {
    FACET_LIGHT_TYPE_DIRECTIONAL,
    FACET_LIGHT_TYPE_POINT,
    FACET_LIGHT_TYPE_SPOT
} facet_light_type;

/* A light of KHR_lights_punctual; it emits along -Z of its node. */
typedef struct facet_light_desc {
    const char *name; /* NULL: "" */
    facet_light_type type;
    float color[3];       /* linear; {0}: white */
    float intensity;      /* cd, or lx for a directional one */
    float range_m;        /* 0: no limit */
    float inner_cone_rad; /* spot, below outer_cone_rad */
    float outer_cone_rad; /* spot, at most pi/2; 0: pi/4 */
} facet_light_desc;

typedef struct facet_node_desc {
    const char *name; /* NULL: "" */
    bool has_parent;
    uint32_t parent; /* a node before this one */
    /* 16 numbers, column by column, last row 0 0 0 1; NULL: translation, rotation and scale */
    const double *matrix;
    double translation[3]; /* m */
    float rotation[4];     /* quaternion x y z w; {0}: none */
    float scale[3];        /* {0}: 1 */
    bool is_hidden;        /* with its descendants */
    bool has_mesh, has_camera, has_light;
    uint32_t mesh, camera, light;
    /* The mesh instance_count times, in the node's space, by translations (3 each), rotations (4) and scales (3); NULL: 0,
     * none, 1. 0: once, without them */
    uint32_t instance_count;
    const float *instance_translations, *instance_rotations, *instance_scales;
} facet_node_desc;

/* ---- the scene ---- */

/* {0}: nothing. */
typedef struct facet_arrays_desc {
    const char *name; /* in messages, as the name of a file; NULL: "arrays" */
    uint32_t texture_count, material_count, variant_count, mesh_count, camera_count, light_count, node_count;
    const facet_texture_desc *textures;
    const facet_material *materials;
    const char *const *variants; /* names of material variants */
    const facet_mesh_desc *meshes;
    const facet_camera_desc *cameras;
    const facet_light_desc *lights;
    const facet_node_desc *nodes; /* node_count 0: one node per mesh, at the origin */
} facet_arrays_desc;

/* Creates a scene from copies of all arrays, texts, pixels and bytes, which may be released or changed afterwards. Of desc
 * (NULL: {0}) it reads allocator, log, thread_count and max_texture_size. FACET_ERROR_ARGUMENT: a number is not finite or
 * out of range, an index is too large, an array is missing; FACET_ERROR_INVALID: an image file is broken; FACET_ERROR_LIMIT,
 * _MEMORY. */
FACET_API facet_result facet_scene_create(const facet_arrays_desc *arrays, const facet_scene_desc *desc,
                                          facet_scene **scene, facet_error *error);

#ifdef __cplusplus
}
#endif

#endif
