/* gltf_reader.h - what the files of the glTF reader share: the tables of the file, and one function per
 * concern. Errors, places and typed access to the JSON: io/json_reader.h. */
#ifndef IO_GLTF_READER_H
#define IO_GLTF_READER_H

#include "io/json_reader.h"

/* ---- parsed tables of the binary data ---- */

typedef struct gltf_buffer {
    size_t byte_length;
    size_t available; /* bytes of data, at most byte_length */
    io_problem problem;
    const char *uri;           /* NULL: the binary chunk of a .glb, or no data */
    const unsigned char *data; /* NULL: not loaded yet */
    bool is_fallback;          /* holds uncompressed data for readers without the compression extension */
} gltf_buffer;

typedef struct gltf_compressed_view gltf_compressed_view; /* gltf_meshopt.c */

typedef struct gltf_view {
    io_problem problem; /* the other members are valid where there is none */
    uint32_t buffer;
    size_t offset, length;
    size_t stride;                    /* 0: tight */
    gltf_compressed_view *compressed; /* NULL: the bytes of the buffer are used as they are */
} gltf_view;

typedef enum gltf_component {
    GLTF_I8 = 5120,
    GLTF_U8 = 5121,
    GLTF_I16 = 5122,
    GLTF_U16 = 5123,
    GLTF_U32 = 5125,
    GLTF_F32 = 5126,
    GLTF_F64 = 5130, /* KHR_accessor_float64 */
    GLTF_F16 = 5131  /* KHR_accessor_float16 */
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
    io_problem problem; /* the other members are valid where there is none */
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
    /* Tightly packed elements of the accessor's type that replace those of the view; NULL: none.
     * gltf_draco.c sets them, with the bitstream and the attribute that they come from. */
    const unsigned char *decoded;
    uint32_t draco_view, draco_attribute;

    /* Converted arrays, shared by the primitives that use the accessor; NULL: not converted yet. */
    const float *floats;
    const uint32_t *indices;
    uint32_t largest_index;
    const float *positions; /* finite, relative to origin */
    double origin[3];       /* of positions in double that are far from 0, for scene_mesh.origin */
    const uint8_t *is_lost; /* per vertex: its position was not finite; NULL: none */
    const float *normals, *tangents, *colors;
    const float *finite;      /* texture coordinates, or displacements of a morph target */
    bool has_tangents;        /* false: `tangents` are not usable */
    bool has_missing_normals; /* some normals have no direction and are 0 */
} gltf_accessor;

/* What the reader keeps of a mesh beside scene_mesh. */
typedef struct gltf_mesh {
    io_problem problem; /* where there is one, the mesh is a single empty primitive */
    io_problem joints;  /* where there is one, the mesh has no joints */
} gltf_mesh;

/* ---- state ---- */

typedef struct gltf_draco_state gltf_draco_state; /* gltf_draco.c */

typedef struct gltf_outer gltf_outer; /* gltf_external.h */

/* State of the glTF reader: io_reader.gltf. */
typedef struct gltf_tables {
    const unsigned char *bin; /* binary chunk of a .glb; NULL: none */
    size_t bin_size;

    uint32_t buffer_count, view_count, accessor_count;
    uint32_t backed_count; /* elements of the longest accessor with a buffer view */
    gltf_buffer *buffers;
    gltf_view *views;
    gltf_accessor *accessors;
    uint32_t file_node_count;      /* nodes of the file; those of the scene beyond are copies */
    uint32_t *copy_of, *next_copy; /* gltf_hierarchy.c, per node; NULL: no copies */
    gltf_mesh *meshes;             /* one per mesh of the scene */
    gltf_mesh *mesh;               /* the mesh that is being read */
    io_problem *material_problems; /* one per material; a material with a problem has default values */
    const uint32_t *iota;          /* 0, 1, 2, .. */
    uint32_t iota_count;
    bool reads_images_only; /* gltf_load_images() */
    bool has_quantization;
    bool has_decoded_views;  /* some buffer view was decompressed */
    gltf_outer *outer;       /* the file that refers to this one; NULL: none */
    const char *path;        /* of this file, or where it is embedded */
    uint64_t device, number; /* identify the file under any name; number 0: none */
    bool has_externals;      /* it is glTF 2.1 */
    gltf_draco_state *draco; /* NULL: no primitive has used it yet */
    /* corners of the primitive that is being read, from its Draco bitstream; NULL: it has none */
    const uint32_t *faces;
    uint32_t face_count;
} gltf_tables;

/* ---- the concerns, one file each ---- */

/* gltf_buffers.c: tables of buffers and views; bytes are loaded on first use. */
void gltf_read_buffers(io_reader *r, const json_place *root);
void gltf_read_views(io_reader *r, const json_place *root);
/* The bytes of a view or a buffer; NULL: an error is recorded. */
const unsigned char *gltf_get_view_bytes(io_reader *r, const json_place *at, uint32_t view);
/* end: number of bytes of the buffer that are needed. */
const unsigned char *gltf_get_buffer_bytes(io_reader *r, uint32_t buffer, size_t end);

/* Whether a buffer, a view or an accessor (with its sparse parts) has a source of bytes. A buffer with
 * neither a uri nor the binary chunk behind it is valid, but empty. */
bool gltf_has_buffer_source(const io_reader *r, uint32_t buffer);
bool gltf_has_view_source(const io_reader *r, uint32_t view);
bool gltf_has_accessor_source(const io_reader *r, uint32_t accessor);
/* Whether all elements are 0 because the accessor has neither a buffer view nor sparse values. */
bool gltf_is_zero_accessor(const io_reader *r, uint32_t accessor);
/* Warns about the problems of unused parts, which no error has reported. */
void gltf_check_unused_parts(io_reader *r);

/* gltf_meshopt.c: EXT_meshopt_compression and KHR_meshopt_compression. */
bool gltf_is_meshopt_fallback(io_reader *r, const json_place *buffer);
/* Sets view->compressed where the view has the extension. Needs the view's length and the table of
 * buffers. */
void gltf_read_meshopt(io_reader *r, const json_place *place, gltf_view *view);
/* The buffer that holds the compressed stream. */
uint32_t gltf_get_meshopt_buffer(const gltf_compressed_view *view);
/* gltf_get_view_bytes() of a compressed view. */
const unsigned char *gltf_get_meshopt_bytes(io_reader *r, const json_place *at, uint32_t view);

/* gltf_accessors.c: the table, and the elements, converted once per accessor. */
void gltf_read_accessors(io_reader *r, const json_place *root);
/* io_get_index() of accessors; an accessor with a problem is an error. */
uint32_t gltf_get_accessor(io_reader *r, const json_place *object, const char *key);
uint32_t gltf_get_required_accessor(io_reader *r, const json_place *object, const char *key);
extern const uint32_t gltf_component_counts[GLTF_TYPE_COUNT];
/* Bytes of one element; the columns of a matrix begin at multiples of 4 bytes. */
size_t gltf_element_size(gltf_component component, gltf_type type);

/* Positions of doubles as floats relative to an origin near them: the accessor's origin. As gltf_get_accessor_floats(). */
const float *gltf_get_accessor_near(io_reader *r, const json_place *at, uint32_t accessor);

/* All elements as floats, gltf_component_counts[type] each; normalized integers become [-1, 1] or [0, 1].
 * Points into the file where it holds such floats. NULL: an error is recorded. */
const float *gltf_get_accessor_floats(io_reader *r, const json_place *at, uint32_t accessor);
/* Elements of a scalar accessor of unsigned integers, and the largest of them. */
const uint32_t *gltf_get_accessor_indices(io_reader *r, const json_place *at, uint32_t accessor,
                                          uint32_t *largest);

/* gltf_draco.c, or gltf_draco_none.c in builds without the Draco library: KHR_draco_mesh_compression.
 * Decodes the bitstream of a primitive, if it has one, into its accessors and tables.faces, before
 * attributes and indices are read. False: an error is recorded. */
bool gltf_prepare_draco(io_reader *r, const json_place *primitive);
/* After all primitives are read. */
void gltf_release_draco(io_reader *r);

/* gltf_attributes.c */
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
/* The accessor of an attribute, checked to have an allowed format and vertex_count elements; SCENE_NONE:
 * the primitive lacks the attribute, or an error is recorded. */
uint32_t gltf_get_attribute(io_reader *r, const json_place *attributes, const char *name,
                            gltf_attribute attribute, uint32_t vertex_count);
/* The number of attributes PREFIX0, PREFIX1, .. without a gap; at most 64. */
uint32_t gltf_count_sets(const json_place *attributes, const char *prefix);
/* Whether the attribute of that name is read for drawing. */
bool gltf_is_read_attribute(const char *name);
/* Reports names that glTF reserves but does not define, gaps in their numbers, and values that are no
 * accessors. */
void gltf_check_attribute_names(io_reader *r, const json_place *attributes);

/* Vertex attributes in the form of scene_primitive; NULL: an error is recorded, or (tangents) none are
 * usable. */
const float *gltf_get_positions(io_reader *r, const json_place *at, uint32_t accessor,
                                const uint8_t **is_lost);
const float *gltf_get_normals(io_reader *r, const json_place *at, uint32_t accessor, bool *has_missing);
const float *gltf_get_tangents(io_reader *r, const json_place *at, uint32_t accessor);
const float *gltf_get_colors(io_reader *r, const json_place *at, uint32_t accessor);
/* Texture coordinates, or displacements of a morph target, with 0 for values that are not finite. what:
 * their name in a warning. */
const float *gltf_get_finite(io_reader *r, const json_place *at, uint32_t accessor, const char *what);

/* gltf_skins.c: joints and weights, from any number of sets JOINTS_n, WEIGHTS_n. */
bool gltf_read_influences(io_reader *r, const json_place *attributes, scene_primitive *primitive);

/* gltf_meshes.c: the morph weights of a mesh or a node: count numbers, 0 where the file has fewer; NULL:
 * it has none, or count is 0. */
const float *gltf_read_weights(io_reader *r, const json_place *object, uint32_t count);

/* gltf_triangles.c: the index list of a primitive, with strips, fans and loops unrolled. */
bool gltf_read_primitive_indices(io_reader *r, const json_place *at, scene_primitive *primitive,
                                 const uint8_t *is_lost);

/* Flat shading: unshares the vertices of each triangle, sets their normals to its own, and drops tangents,
 * also those of morph targets. */
bool gltf_make_flat(io_reader *r, const json_place *at, scene_primitive *primitive);
/* Replaces normals of length 0 by those of the adjacent triangles, in a copy. */
bool gltf_fill_missing_normals(io_reader *r, const json_place *at, scene_primitive *primitive);

/* gltf_meshes.c: what a primitive with its attributes and indices lacks: normals, and bounds. */
bool gltf_complete_primitive(io_reader *r, const json_place *at, scene_primitive *primitive,
                             bool has_missing_normals);

/* KHR_materials_variants. */
void gltf_read_variants(io_reader *r, const json_place *root);

/* gltf_meshes.c, gltf_materials.c, gltf_textures.c, gltf_nodes.c, ..: arrays of the scene. */
void gltf_read_images(io_reader *r, const json_place *root);
void gltf_read_textures(io_reader *r, const json_place *root);
void gltf_read_materials(io_reader *r, const json_place *root);
void gltf_read_meshes(io_reader *r, const json_place *root);
/* Filters and wrap modes; one material. at: the JSON object. */
void gltf_read_texture_sampler(io_reader *r, const json_place *at, scene_texture *out);
void gltf_read_material(io_reader *r, const json_place *at, scene_material *out);
/* Reads the parameters and textures that are there; the others keep their values. */
void gltf_read_material_members(io_reader *r, const json_place *at, scene_material *m);
void gltf_read_cameras(io_reader *r, const json_place *root);
void gltf_read_lights(io_reader *r, const json_place *root);
void gltf_read_image_lights(io_reader *r, const json_place *root); /* EXT_lights_image_based */
void gltf_read_nodes(io_reader *r, const json_place *root);
void gltf_read_scenes(io_reader *r, const json_place *root);
void gltf_read_skins(io_reader *r, const json_place *root); /* also checks the meshes that use them */
void gltf_read_animations(io_reader *r, const json_place *root);

/* gltf_hierarchy.c */
/* The children of node `index`. */
void gltf_read_children(io_reader *r, const json_place *at, uint32_t index, uint32_t node_count);
/* gltf_external.c: io_load_uri() where the file that refers to this one may replace URIs (glTF 2.1: aliases). */
bool gltf_load_uri(io_reader *r, const char *uri, uri_bytes *out);
/* After everything else: reads the external assets of nodes (glTF 2.1) and attaches them. */
void gltf_read_externals(io_reader *r, const json_place *root);

/* After all nodes are read: sets their parents. A node with several parents is copied for each but the
 * first. */
void gltf_settle_hierarchy(io_reader *r, const json_place *array);
/* Iterates over the copies of a node; node: the node of the file, or the last copy. SCENE_NONE: no more. */
uint32_t gltf_next_node_copy(const io_reader *r, uint32_t node);
void gltf_read_center(io_reader *r, const json_place *root); /* CESIUM_RTC; after the scenes */

/* EXT_mesh_gpu_instancing of a node; NULL: it has none, or an error is recorded. */
const scene_instancing *gltf_read_instancing(io_reader *r, const json_place *node);

/* Normalizes a quaternion, in double; one of length 0 becomes the identity. Returns its length before. */
double gltf_normalize_rotation(float rotation[4]);

/* gltf_animation_pointer.c: the target of a JSON pointer of KHR_animation_pointer. */
typedef struct gltf_target {
    scene_channel channel; /* kind, index, offset, scale, is_rotation, pointer */
    uint32_t width;        /* floats per value */
    bool needs_steps;      /* a boolean: interpolation must be STEP */
    bool is_of_mesh;       /* morph weights of mesh channel.index: of all nodes that use it */
} gltf_target;
/* NULL: *out is set, with a copy of the pointer. Otherwise the reason for failure, as the end of a
 * sentence. */
const char *gltf_resolve_pointer(io_reader *r, const char *pointer, gltf_target *out);

/* gltf_extras.c: extras and metadata of an object. */
scene_meta gltf_get_meta(io_reader *r, const json_place *object);
/* Of the root, the asset, images and textures. */
void gltf_read_meta(io_reader *r, const json_place *root);

/* Sets scene->legacy from extras.facet_legacy, which a conversion wrote; it stays NULL where none is
 * valid. */
void gltf_read_legacy_extras(io_reader *r, const json_place *root);

/* gltf_extensions.c: extensionsUsed and extensionsRequired; fails on a required extension that facet does
 * not support. */
void gltf_read_extensions(io_reader *r, const json_place *root);
bool gltf_is_extension_listed(const io_reader *r, const char *name);

#endif
