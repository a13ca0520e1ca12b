/* gltf_reader.h - what the files of the glTF reader share: its state, and typed access to the JSON with places in
 * messages.
 *
 * Errors are sticky: the first one stays in reader.result, getters then give their fallback, and who loops or
 * allocates asks io_is_ok(). So parsing code reads like the specification's tables. */
#ifndef IO_GLTF_READER_H
#define IO_GLTF_READER_H

#include "io/json_reader.h"

/* ---- parsed tables of the binary data ---- */

typedef struct gltf_buffer {
    size_t byte_length;
    size_t available; /* bytes of data, at most byte_length */
    io_problem problem;
    const char *uri;           /* NULL: the binary chunk of a .glb, or nothing */
    const unsigned char *data; /* NULL: not asked for yet */
    bool is_fallback;          /* of a compression extension: for readers without it */
} gltf_buffer;

typedef struct gltf_compressed_view gltf_compressed_view; /* gltf_meshopt.c */

typedef struct gltf_view {
    io_problem problem; /* the rest counts where there is none */
    uint32_t buffer;
    size_t offset, length;
    size_t stride;                    /* 0: tight */
    gltf_compressed_view *compressed; /* NULL: bytes are in buffer; else they are decoded from elsewhere */
} gltf_view;

typedef enum gltf_component {
    GLTF_I8 = 5120,
    GLTF_U8 = 5121,
    GLTF_I16 = 5122,
    GLTF_U16 = 5123,
    GLTF_U32 = 5125,
    GLTF_F32 = 5126
} gltf_component;

typedef enum gltf_type {
    GLTF_SCALAR,
    GLTF_VEC2,
    GLTF_VEC3,
    GLTF_VEC4,
    GLTF_MAT2,
    GLTF_MAT3,
    GLTF_MAT4,
    GLTF_TYPE_COUNT
} gltf_type;

typedef struct gltf_accessor {
    io_problem problem; /* the rest counts where there is none */
    uint32_t view;      /* SCENE_NONE: zeros */
    size_t offset;
    gltf_component component;
    gltf_type type;
    bool is_normalized;
    uint32_t count;
    uint32_t sparse_count; /* 0: not sparse */
    uint32_t sparse_index_view, sparse_value_view;
    size_t sparse_index_offset, sparse_value_offset;
    gltf_component sparse_index_component;
    /* Elements without gaps, in the accessor's own type, that stand for those of the view; NULL: none. gltf_draco.c
     * sets it, and which attribute of which bitstream they are. */
    const unsigned char *decoded;
    uint32_t draco_view, draco_attribute;

    /* What was made of it, so that primitives that share it share that too; NULL: not yet. */
    const float *floats;
    const uint32_t *indices;
    uint32_t largest_index;
    const float *positions; /* finite ones */
    const uint8_t *is_lost; /* per vertex: its position was not finite; NULL: none */
    const float *normals, *tangents, *colors;
    const float *finite;      /* of texture coordinates, and of changes of positions, normals and tangents */
    bool has_tangents;        /* false: tangents were looked at and are of no use */
    bool has_missing_normals; /* some have no direction and are 0 here */
} gltf_accessor;

/* What the reader knows of a mesh beside the scene's. */
typedef struct gltf_mesh {
    io_problem problem; /* it has one primitive that draws nothing */
    io_problem joints;  /* it has none */
} gltf_mesh;

/* ---- state ---- */

typedef struct gltf_draco_state gltf_draco_state; /* gltf_draco.c */

/* What the reader knows of the file beside the scene: io_reader.gltf. */
typedef struct gltf_tables {
    const unsigned char *bin; /* binary chunk of a .glb; NULL: none */
    size_t bin_size;

    uint32_t buffer_count, view_count, accessor_count;
    uint32_t backed_count; /* elements of the longest accessor that has a buffer view */
    gltf_buffer *buffers;
    gltf_view *views;
    gltf_accessor *accessors;
    uint32_t file_node_count;      /* nodes of the file, which are the first of the scene's */
    uint32_t *copy_of, *next_copy; /* gltf_hierarchy.c, per node; NULL: there are no copies */
    gltf_mesh *meshes;             /* as many as the scene's */
    gltf_mesh *mesh;               /* the one that is being read */
    io_problem
        *material_problems; /* as many as the scene's materials, which are defaults where there is one */
    const uint32_t *iota;   /* 0, 1, 2, .. */
    uint32_t iota_count;
    bool has_quantization;
    bool has_decoded_views;  /* compressed ones */
    gltf_draco_state *draco; /* NULL: no primitive has asked for it yet */
    /* of the primitive that is being read, from its bitstream: corners; NULL: it has none */
    const uint32_t *faces;
    uint32_t face_count;
} gltf_tables;

/* ---- the concerns, one file each ---- */

/* gltf_buffers.c: tables of buffers and views; bytes come when asked for. */
void gltf_read_buffers(io_reader *r, const json_place *root);
void gltf_read_views(io_reader *r, const json_place *root);
/* The bytes of a view or a whole buffer; NULL, with the error recorded, where they cannot be had. */
const unsigned char *gltf_get_view_bytes(io_reader *r, const json_place *at, uint32_t view);
/* end: how many of a buffer's bytes must be there. */
const unsigned char *gltf_get_buffer_bytes(io_reader *r, uint32_t buffer, size_t end);

/* Whether there is something that a buffer, a view or an accessor (with its sparse parts) could be read from. A buffer
 * with neither a uri nor the binary chunk behind it is valid, but empty. */
bool gltf_has_buffer_source(const io_reader *r, uint32_t buffer);
bool gltf_has_view_source(const io_reader *r, uint32_t view);
bool gltf_has_accessor_source(const io_reader *r, uint32_t accessor);
/* Whether all elements are 0 because the file gives none: neither a buffer view nor sparse values. */
bool gltf_is_zero_accessor(const io_reader *r, uint32_t accessor);
/* Refuses (FACET_ERROR_LIMIT) an accessor without a buffer view that has many more elements than any array in the file
 * and than its sparse values: a few bytes of JSON must not take gigabytes. */
bool gltf_check_claim(io_reader *r, const json_place *at, const gltf_accessor *a);
/* Warns about parts that have a problem that came up nowhere, as nothing uses them. */
void gltf_check_unused_parts(io_reader *r);

/* gltf_meshopt.c: EXT_meshopt_compression and KHR_meshopt_compression. */
bool gltf_is_meshopt_fallback(io_reader *r, const json_place *buffer);
/* Sets view->compressed where the view has the extension. Needs its length and the table of buffers. */
void gltf_read_meshopt(io_reader *r, const json_place *place, gltf_view *view);
/* Where the stream is. */
uint32_t gltf_get_meshopt_buffer(const gltf_compressed_view *view);
/* gltf_get_view_bytes() of a compressed view. */
const unsigned char *gltf_get_meshopt_bytes(io_reader *r, const json_place *at, uint32_t view);

/* gltf_accessors.c: the table. */
void gltf_read_accessors(io_reader *r, const json_place *root);
/* io_get_index() of accessors; one that has a problem is an error. */
uint32_t gltf_get_accessor(io_reader *r, const json_place *object, const char *key);
uint32_t gltf_get_required_accessor(io_reader *r, const json_place *object, const char *key);
extern const uint32_t gltf_component_counts[GLTF_TYPE_COUNT];
size_t gltf_component_size(gltf_component component); /* bytes */
size_t gltf_column_count(gltf_type type);             /* of a matrix; 1 for all else */
/* Bytes from one column of a matrix to the next, which begin at multiples of 4; of all else the whole element. */
size_t gltf_column_size(gltf_component component, gltf_type type);
size_t gltf_element_size(gltf_component component, gltf_type type);
/* Bytes from one dense element to the next. */
size_t gltf_accessor_stride(const io_reader *r, const gltf_accessor *accessor);

/* gltf_draco.c, or gltf_draco_none.c where the Draco library is missing: KHR_draco_mesh_compression. Before a
 * primitive's attributes and indices are read: its accessors get what its bitstream holds, and r->faces is set. True
 * also where it has none; false: an error is recorded. */
bool gltf_prepare_draco(io_reader *r, const json_place *primitive);
/* When all primitives are read. */
void gltf_release_draco(io_reader *r);

/* gltf_elements.c: the arrays, made once for each accessor. */
/* All elements as floats, gltf_component_counts[type] each, normalised integers in [-1, 1] or [0, 1]. Points into
 * the file where the bytes are such floats already. NULL: an error is recorded. */
const float *gltf_get_accessor_floats(io_reader *r, const json_place *at, uint32_t accessor);
/* A scalar accessor of unsigned integers; *largest: the largest one. */
const uint32_t *gltf_get_accessor_indices(io_reader *r, const json_place *at, uint32_t accessor,
                                          uint32_t *largest);

/* gltf_formats.c */
typedef enum gltf_attribute {
    GLTF_POSITION,
    GLTF_NORMAL,
    GLTF_TANGENT,
    GLTF_TEXCOORD,
    GLTF_COLOR,
    GLTF_JOINTS,
    GLTF_WEIGHTS,
    GLTF_POSITION_DELTA, /* of a morph target */
    GLTF_NORMAL_DELTA,
    GLTF_TANGENT_DELTA
} gltf_attribute;
/* The accessor of an attribute, checked to have a format that it may have and vertex_count elements; SCENE_NONE: it has
 * none, or an error is recorded. */
uint32_t gltf_get_attribute(io_reader *r, const json_place *attributes, const char *name,
                            gltf_attribute attribute, uint32_t vertex_count);
/* How many of PREFIX0, PREFIX1, .. are there; at most 64. */
uint32_t gltf_count_sets(const json_place *attributes, const char *prefix);
/* Whether a primitive is drawn by the attribute of that name. */
bool gltf_is_read_attribute(const char *name);
/* Names that glTF reserves must be ones it knows, without gaps in their numbers, and all must name accessors. */
void gltf_check_attribute_names(io_reader *r, const json_place *attributes);

/* gltf_attributes.c: vertex attributes as scene_primitive wants them; NULL: an error is recorded, or (tangents)
 * there are none of use. */
const float *gltf_get_positions(io_reader *r, const json_place *at, uint32_t accessor,
                                const uint8_t **is_lost);
const float *gltf_get_normals(io_reader *r, const json_place *at, uint32_t accessor, bool *has_missing);
const float *gltf_get_tangents(io_reader *r, const json_place *at, uint32_t accessor);
const float *gltf_get_colors(io_reader *r, const json_place *at, uint32_t accessor);
/* Texture coordinates, or changes of a morph target: what is not finite is 0. what: their name, for a warning. */
const float *gltf_get_finite(io_reader *r, const json_place *at, uint32_t accessor, const char *what);

/* gltf_influences.c: joints and their weights, of any number of sets JOINTS_n, WEIGHTS_n. */
bool gltf_read_influences(io_reader *r, const json_place *attributes, scene_primitive *primitive);

/* gltf_morph.c: the targets of a primitive whose attributes are read, and the weights of a mesh or a node. */
bool gltf_read_targets(io_reader *r, const json_place *at, scene_primitive *primitive);
/* count numbers, 0 where the file has fewer; NULL: it has none, or count is 0. */
const float *gltf_read_weights(io_reader *r, const json_place *object, uint32_t count);

/* gltf_indices.c: the index list of a primitive, modes unrolled. */
bool gltf_read_primitive_indices(io_reader *r, const json_place *at, scene_primitive *primitive,
                                 const uint8_t *is_lost);

/* gltf_flat.c */
/* Gives every triangle vertices of its own with the triangle's normal; drops tangents, also those of morph targets. */
bool gltf_make_flat(io_reader *r, const json_place *at, scene_primitive *primitive);
/* Fills in normals of length 0 with those of the triangles around, in a copy. */
bool gltf_fill_missing_normals(io_reader *r, const json_place *at, scene_primitive *primitive);

/* gltf_variants.c: KHR_materials_variants. */
void gltf_read_variants(io_reader *r, const json_place *root);
/* The materials of a primitive, by variant; NULL: it has its own in all of them, or an error is recorded. */
const uint32_t *gltf_read_mappings(io_reader *r, const json_place *primitive);

/* gltf_meshes.c, gltf_materials.c, gltf_textures.c, gltf_nodes.c, ..: arrays of the scene, in this order. */
void gltf_read_images(io_reader *r, const json_place *root);
void gltf_read_textures(io_reader *r, const json_place *root);
void gltf_read_materials(io_reader *r, const json_place *root);
void gltf_read_meshes(io_reader *r, const json_place *root);
/* Filters and ways to wrap; one material. at: the object of the JSON. */
void gltf_read_texture_sampler(io_reader *r, const json_place *at, scene_texture *out);
void gltf_read_material(io_reader *r, const json_place *at, scene_material *out);
void gltf_read_cameras(io_reader *r, const json_place *root);
void gltf_read_lights(io_reader *r, const json_place *root);
void gltf_read_image_lights(io_reader *r,
                            const json_place *root); /* gltf_image_lights.c: EXT_lights_image_based */
void gltf_read_nodes(io_reader *r, const json_place *root);
void gltf_read_scenes(io_reader *r, const json_place *root);
void gltf_read_skins(io_reader *r, const json_place *root); /* also checks the meshes that use them */
void gltf_read_animations(io_reader *r, const json_place *root);

/* gltf_hierarchy.c */
/* The children of node number index; its place is not asked for yet. */
void gltf_read_children(io_reader *r, const json_place *at, uint32_t index, uint32_t node_count);
/* When all nodes are read: gives each its parent. A node with several is copied for each but the first. */
void gltf_settle_hierarchy(io_reader *r, const json_place *array);
/* The copies of a node of the file, one after the other; node: the file's or the last one. SCENE_NONE: no more. */
uint32_t gltf_next_node_copy(const io_reader *r, uint32_t node);
void gltf_read_center(io_reader *r, const json_place *root); /* CESIUM_RTC; after the scenes */

/* gltf_instancing.c: EXT_mesh_gpu_instancing of a node; NULL: it has none, or an error is recorded. */
const scene_instancing *gltf_read_instancing(io_reader *r, const json_place *node);

/* Makes a quaternion unit, in double; one without direction becomes the identity. Returns the length that it had. */
double gltf_normalize_rotation(float rotation[4]);

/* gltf_animation_samplers.c */
/* What does not depend on what the sampler moves; for those that nothing asks for too. */
void gltf_check_animation_sampler(io_reader *r, const json_place *at);
/* Keys as scene_sampler wants them; is_rotation: values of 4 floats become unit. False: an error is recorded, or a
 * warning says why nothing can move by them. */
bool gltf_read_animation_sampler(io_reader *r, const json_place *at, bool is_rotation, scene_sampler *out);

/* gltf_animation_pointer.c: what a JSON pointer of KHR_animation_pointer moves. */
typedef struct gltf_target {
    scene_channel channel; /* kind, index, offset, scale, is_rotation, pointer */
    uint32_t width;        /* floats of a value that it takes */
    bool needs_steps;      /* of truth values */
    bool is_of_mesh;       /* weights of mesh number channel.index: of all nodes that have it */
} gltf_target;
/* NULL: *out is set, with a copy of the pointer. Else what is wrong with it, as the end of a sentence. */
const char *gltf_resolve_pointer(io_reader *r, const char *pointer, gltf_target *out);

/* gltf_meta.c: extras and metadata of an object. */
scene_meta gltf_get_meta(io_reader *r, const json_place *object);
/* Of the root, the asset, images and textures. */
void gltf_read_meta(io_reader *r, const json_place *root);

/* gltf_legacy_extras.c: scene->legacy by extras.facet_legacy, which a conversion wrote; NULL where none counts. */
void gltf_read_legacy_extras(io_reader *r, const json_place *root);

/* gltf_extensions.c: what the file says it uses; fails on a required one that facet lacks. */
void gltf_read_extensions(io_reader *r, const json_place *root);
bool gltf_is_extension_listed(const io_reader *r, const char *name);

/* glb.c: splits a .glb; json and bin point into bytes. False: an error is recorded. */
bool gltf_split_glb(io_reader *r, const unsigned char *bytes, size_t size, const char **json,
                    size_t *json_size);

#endif
