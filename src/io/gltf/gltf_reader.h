/* gltf_reader.h - what the files of the glTF reader share: its state, and typed access to the JSON with places in
 * messages.
 *
 * Errors are sticky: the first one stays in reader.result, getters then give their fallback, and who loops or
 * allocates asks reader_is_ok(). So parsing code reads like the specification's tables. */
#ifndef IO_GLTF_READER_H
#define IO_GLTF_READER_H

#include <jansson.h>

#include "io/uri.h"
#include "scene/scene.h"

/* ---- parsed tables of the binary data ---- */

/* Why a part of the file cannot be had, of which it is not known yet whether the image needs it. */
typedef struct reader_problem {
    const char *message; /* NULL: none */
    facet_result result;
    bool is_told; /* by an error or a warning */
} reader_problem;

typedef struct gltf_buffer {
    size_t byte_length;
    size_t available; /* bytes of data, at most byte_length */
    reader_problem problem;
    const char *uri;           /* NULL: the binary chunk of a .glb, or nothing */
    const unsigned char *data; /* NULL: not asked for yet */
    bool is_fallback;          /* of a compression extension: for readers without it */
} gltf_buffer;

typedef struct compressed_view compressed_view; /* gltf_meshopt.c */

typedef struct gltf_view {
    reader_problem problem; /* the rest counts where there is none */
    uint32_t buffer;
    size_t offset, length;
    size_t stride;               /* 0: tight */
    compressed_view *compressed; /* NULL: bytes are in buffer; else they are decoded from elsewhere */
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
    reader_problem problem; /* the rest counts where there is none */
    uint32_t view;          /* SCENE_NONE: zeros */
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
    reader_problem problem; /* it has one primitive that draws nothing */
    reader_problem joints;  /* it has none */
} gltf_mesh;

/* ---- state ---- */

typedef struct draco_state draco_state; /* gltf_draco.c */

typedef struct reader {
    facet_scene *scene;
    const facet_allocator *allocator;
    const facet_log *log;
    facet_error *error;
    facet_result result; /* FACET_OK, or the first error */
    uint32_t thread_count;
    uint64_t max_file_bytes;
    const char *folder; /* of the model; NULL: read from memory, there is none */
    const char *root;   /* folder that URIs may reach; NULL: folder */

    json_t *json;
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
    reader_problem
        *material_problems; /* as many as the scene's materials, which are defaults where there is one */
    const uint32_t *iota;   /* 0, 1, 2, .. */
    uint32_t iota_count;
    uint64_t work; /* elements read so far; see reader_spend() */
    bool has_quantization;
    bool has_decoded_views;         /* compressed ones */
    draco_state *draco;             /* NULL: no primitive has asked for it yet */
    struct reader_remarks *remarks; /* json_messages.c; NULL: each one is passed on at once */
    /* of the primitive that is being read, from its bitstream: corners; NULL: it has none */
    const uint32_t *faces;
    uint32_t face_count;
} reader;

/* ---- places ---- */

/* A value in the JSON and how it was reached. Lives on the stack of who reads it; value NULL: it is not there,
 * and every getter then gives its fallback. */
typedef struct json_place {
    const struct json_place *parent;
    const char *key; /* NULL: element index of an array, or the root */
    size_t index;
    const json_t *value;
} json_place;

bool reader_is_ok(const reader *r);
/* Records an error "SOURCE: PLACE.key: ..." (key NULL: of the place itself) unless there is one. Returns false. */
bool reader_fail(reader *r, const json_place *at, const char *key, facet_result result, const char *format,
                 ...) __attribute__((format(printf, 5, 6)));
bool reader_fail_memory(reader *r, const char *what, size_t size);

/* Remarks, of the same form. Those that one call makes about the same key are one line with a count, of the first place,
 * where the reader counts: between reader_begin_remarks() and reader_end_remarks(), which passes them on. format must be
 * a literal. A warning says that the image may not be what the file means; a note, that the file breaks a rule and
 * nothing comes of it. See scene_warn(), scene_note(). */
void reader_warn(reader *r, const json_place *at, const char *key, const char *format, ...)
    __attribute__((format(printf, 4, 5)));
void reader_note(reader *r, const json_place *at, const char *key, const char *format, ...)
    __attribute__((format(printf, 4, 5)));
/* A line for each: of files and extensions, of which the user wants to know all. */
void reader_warn_each(reader *r, const json_place *at, const char *key, const char *format, ...)
    __attribute__((format(printf, 4, 5)));
void reader_note_each(reader *r, const json_place *at, const char *key, const char *format, ...)
    __attribute__((format(printf, 4, 5)));
void reader_begin_remarks(reader *r);
void reader_end_remarks(reader *r);

/* ---- parts that an image may do without ----
 *
 * An error in one of them is taken back. That memory is short or a limit is reached remains an error. */

/* Makes a recorded error a warning, with what comes of it: "..; CONSEQUENCE". Those of one consequence, a literal, are
 * one line with a count. True: there was one, and the caller leaves out the part. */
bool reader_leave_out(reader *r, const char *consequence);
/* Keeps a recorded error as the problem of a part that may not be needed. True: there was one. */
bool reader_defer(reader *r, reader_problem *problem);
/* Records the problem as an error: the part is needed. Returns false. */
bool reader_fail_deferred(reader *r, reader_problem *problem);
/* Warns about a problem that no error and no warning has told. */
void reader_warn_deferred(reader *r, reader_problem *problem);

/* arena_zalloc() that records the error. count of 0 is allowed. */
void *reader_alloc(reader *r, const char *what, size_t count, size_t size);
/* The same without clearing. */
void *reader_alloc_raw(reader *r, const char *what, size_t count, size_t size);
/* Accounts for elements to be read. A file can refer to the same bytes any number of times: this bounds time and
 * memory. False, with FACET_ERROR_LIMIT recorded, beyond 2^28. */
bool reader_spend(reader *r, const json_place *at, uint64_t elements);

/* What the document takes that jansson makes of a text. jansson takes its memory from malloc. So that the caller's
 * allocator decides about that memory too, a block as large as the parsed document is taken from it while the document
 * lives; untouched, it costs address space only. Bytes per kind of token measured with jansson 2.14 on x86-64, rounded
 * up. */
size_t json_memory_estimate(const char *text, size_t size);
/* json_text.c: the tree of a text; NULL: an error is recorded. Bytes that are no UTF-8, as exporters in Latin-1, GBK and
 * Shift-JIS write them, are taken for Latin-1, with one warning: what they spelt is lost, but what differed still does. */
json_t *reader_parse(reader *r, const char *text, size_t size);

/* ---- typed members ---- */

/* An object or array member; value NULL where there is none or (recorded) it is something else. An empty array,
 * which glTF forbids, gets a warning. */
json_place get_object(reader *r, const json_place *object, const char *key);
json_place get_array(reader *r, const json_place *object, const char *key);
size_t get_count(const json_place *array);                                       /* 0 without value */
json_place get_element(const json_place *array, size_t index);                   /* of any type */
json_place get_element_object(reader *r, const json_place *array, size_t index); /* must be an object */
/* extensions.NAME */
json_place get_extension(reader *r, const json_place *object, const char *name);
bool has_member(const json_place *object, const char *key);

#define REQUIRED_UINT UINT64_MAX /* as fallback: absence is an error */
/* A whole number in [0, maximum]; 5.0 counts as 5. */
uint64_t get_uint(reader *r, const json_place *object, const char *key, uint64_t maximum, uint64_t fallback);
/* An index below count, what names the things; SCENE_NONE where it is absent. */
uint32_t get_index(reader *r, const json_place *object, const char *key, uint32_t count, const char *what);
uint32_t get_required_index(reader *r, const json_place *object, const char *key, uint32_t count,
                            const char *what);
/* The value of a place itself as an index, for elements of arrays. */
uint32_t get_index_value(reader *r, const json_place *at, uint32_t count, const char *what);
/* get_index() of accessors; one that has a problem is an error. */
uint32_t get_accessor(reader *r, const json_place *object, const char *key);
uint32_t get_required_accessor(reader *r, const json_place *object, const char *key);
/* An index below count; SCENE_NONE where it is absent, or (not recorded) wrong. */
uint32_t peek_index(const json_place *object, const char *key, uint32_t count);
float get_float(reader *r, const json_place *object, const char *key, float fallback);
/* The same; outside [minimum, maximum] it is clamped with a warning. */
float get_float_in(reader *r, const json_place *object, const char *key, float minimum, float maximum,
                   float fallback);
/* Fills out with exactly count numbers. False: absent (out stays) or (recorded) wrong. */
bool get_floats(reader *r, const json_place *object, const char *key, float *out, size_t count);
/* get_floats() to the precision that the text has; at most 16 numbers. */
bool get_doubles(reader *r, const json_place *object, const char *key, double *out, size_t count);
/* get_floats() of a place itself, which must be an array. */
bool get_floats_value(reader *r, const json_place *at, float *out, size_t count);
void get_floats_in(reader *r, const json_place *object, const char *key, float minimum, float maximum,
                   float *out, size_t count);
bool get_bool(reader *r, const json_place *object, const char *key, bool fallback);
/* Owned by the JSON; fallback where absent. */
const char *get_string(reader *r, const json_place *object, const char *key, const char *fallback);
/* "name", copied to the scene; "" where there is none. Never fails but for memory. */
const char *get_name(reader *r, const json_place *object);

/* ---- the concerns, one file each ---- */

/* gltf_buffers.c: tables of buffers and views; bytes come when asked for. */
void read_buffers(reader *r, const json_place *root);
void read_views(reader *r, const json_place *root);
/* The bytes of a view or a whole buffer; NULL, with the error recorded, where they cannot be had. */
const unsigned char *get_view_bytes(reader *r, const json_place *at, uint32_t view);
/* end: how many of a buffer's bytes must be there. */
const unsigned char *get_buffer_bytes(reader *r, uint32_t buffer, size_t end);

/* Whether there is something that a buffer, a view or an accessor (with its sparse parts) could be read from. A buffer
 * with neither a uri nor the binary chunk behind it is valid, but empty. */
bool has_buffer_source(const reader *r, uint32_t buffer);
bool has_view_source(const reader *r, uint32_t view);
bool has_accessor_source(const reader *r, uint32_t accessor);
/* Whether all elements are 0 because the file gives none: neither a buffer view nor sparse values. */
bool is_zero_accessor(const reader *r, uint32_t accessor);
/* Refuses (FACET_ERROR_LIMIT) an accessor without a buffer view that has many more elements than any array in the file
 * and than its sparse values: a few bytes of JSON must not take gigabytes. */
bool check_claim(reader *r, const json_place *at, const gltf_accessor *a);
/* Warns about parts that have a problem that came up nowhere, as nothing uses them. */
void check_unused_parts(reader *r);

/* gltf_meshopt.c: EXT_meshopt_compression and KHR_meshopt_compression. */
bool is_meshopt_fallback(reader *r, const json_place *buffer);
/* Sets view->compressed where the view has the extension. Needs its length and the table of buffers. */
void read_meshopt(reader *r, const json_place *place, gltf_view *view);
/* Where the stream is. */
uint32_t get_meshopt_buffer(const compressed_view *view);
/* get_view_bytes() of a compressed view. */
const unsigned char *get_meshopt_bytes(reader *r, const json_place *at, uint32_t view);

/* gltf_accessors.c: the table. */
void read_accessors(reader *r, const json_place *root);
extern const uint32_t gltf_component_counts[GLTF_TYPE_COUNT];
size_t gltf_component_size(gltf_component component); /* bytes */
size_t gltf_column_count(gltf_type type);             /* of a matrix; 1 for all else */
/* Bytes from one column of a matrix to the next, which begin at multiples of 4; of all else the whole element. */
size_t gltf_column_size(gltf_component component, gltf_type type);
size_t gltf_element_size(gltf_component component, gltf_type type);
/* Bytes from one dense element to the next. */
size_t gltf_accessor_stride(const reader *r, const gltf_accessor *accessor);

/* gltf_draco.c, or gltf_draco_none.c where the Draco library is missing: KHR_draco_mesh_compression. Before a
 * primitive's attributes and indices are read: its accessors get what its bitstream holds, and r->faces is set. True
 * also where it has none; false: an error is recorded. */
bool prepare_draco(reader *r, const json_place *primitive);
/* When all primitives are read. */
void release_draco(reader *r);

/* gltf_elements.c: the arrays, made once for each accessor. */
/* All elements as floats, gltf_component_counts[type] each, normalised integers in [-1, 1] or [0, 1]. Points into
 * the file where the bytes are such floats already. NULL: an error is recorded. */
const float *get_accessor_floats(reader *r, const json_place *at, uint32_t accessor);
/* A scalar accessor of unsigned integers; *largest: the largest one. */
const uint32_t *get_accessor_indices(reader *r, const json_place *at, uint32_t accessor, uint32_t *largest);

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
uint32_t get_attribute(reader *r, const json_place *attributes, const char *name, gltf_attribute attribute,
                       uint32_t vertex_count);
/* How many of PREFIX0, PREFIX1, .. are there; at most 64. */
uint32_t count_sets(const json_place *attributes, const char *prefix);
/* Whether a primitive is drawn by the attribute of that name. */
bool is_read_attribute(const char *name);
/* Names that glTF reserves must be ones it knows, without gaps in their numbers, and all must name accessors. */
void check_attribute_names(reader *r, const json_place *attributes);

/* gltf_attributes.c: vertex attributes as scene_primitive wants them; NULL: an error is recorded, or (tangents)
 * there are none of use. */
const float *get_positions(reader *r, const json_place *at, uint32_t accessor, const uint8_t **is_lost);
const float *get_normals(reader *r, const json_place *at, uint32_t accessor, bool *has_missing);
const float *get_tangents(reader *r, const json_place *at, uint32_t accessor);
const float *get_colors(reader *r, const json_place *at, uint32_t accessor);
/* Texture coordinates, or changes of a morph target: what is not finite is 0. what: their name, for a warning. */
const float *get_finite(reader *r, const json_place *at, uint32_t accessor, const char *what);

/* gltf_influences.c: joints and their weights, of any number of sets JOINTS_n, WEIGHTS_n. */
bool read_influences(reader *r, const json_place *attributes, scene_primitive *primitive);

/* gltf_morph.c: the targets of a primitive whose attributes are read, and the weights of a mesh or a node. */
bool read_targets(reader *r, const json_place *at, scene_primitive *primitive);
/* count numbers, 0 where the file has fewer; NULL: it has none, or count is 0. */
const float *read_weights(reader *r, const json_place *object, uint32_t count);

/* gltf_indices.c: the index list of a primitive, modes unrolled. */
bool read_primitive_indices(reader *r, const json_place *at, scene_primitive *primitive,
                            const uint8_t *is_lost);

/* gltf_flat.c */
/* Gives every triangle vertices of its own with the triangle's normal; drops tangents, also those of morph targets. */
bool make_flat(reader *r, const json_place *at, scene_primitive *primitive);
/* Fills in normals of length 0 with those of the triangles around, in a copy. */
bool fill_missing_normals(reader *r, const json_place *at, scene_primitive *primitive);

/* gltf_variants.c: KHR_materials_variants. */
void read_variants(reader *r, const json_place *root);
/* The materials of a primitive, by variant; NULL: it has its own in all of them, or an error is recorded. */
const uint32_t *read_mappings(reader *r, const json_place *primitive);

/* gltf_meshes.c, gltf_materials.c, gltf_textures.c, gltf_nodes.c, ..: arrays of the scene, in this order. */
void read_images(reader *r, const json_place *root);
void read_textures(reader *r, const json_place *root);
void read_materials(reader *r, const json_place *root);
void read_meshes(reader *r, const json_place *root);
/* Filters and ways to wrap; one material. at: the object of the JSON. */
void read_texture_sampler(reader *r, const json_place *at, scene_texture *out);
void read_material(reader *r, const json_place *at, scene_material *out);
void read_cameras(reader *r, const json_place *root);
void read_lights(reader *r, const json_place *root);
void read_image_lights(reader *r, const json_place *root); /* gltf_image_lights.c: EXT_lights_image_based */
void read_nodes(reader *r, const json_place *root);
void read_scenes(reader *r, const json_place *root);
void read_skins(reader *r, const json_place *root); /* also checks the meshes that use them */
void read_animations(reader *r, const json_place *root);

/* gltf_hierarchy.c */
/* The children of node number index; its place is not asked for yet. */
void read_children(reader *r, const json_place *at, uint32_t index, uint32_t node_count);
/* When all nodes are read: gives each its parent. A node with several is copied for each but the first. */
void settle_hierarchy(reader *r, const json_place *array);
/* The copies of a node of the file, one after the other; node: the file's or the last one. SCENE_NONE: no more. */
uint32_t next_node_copy(const reader *r, uint32_t node);
void read_center(reader *r, const json_place *root); /* CESIUM_RTC; after the scenes */

/* gltf_instancing.c: EXT_mesh_gpu_instancing of a node; NULL: it has none, or an error is recorded. */
const scene_instancing *read_instancing(reader *r, const json_place *node);

/* Makes a quaternion unit, in double; one without direction becomes the identity. Returns the length that it had. */
double normalise_rotation(float rotation[4]);

/* gltf_animation_samplers.c */
/* What does not depend on what the sampler moves; for those that nothing asks for too. */
void check_animation_sampler(reader *r, const json_place *at);
/* Keys as scene_sampler wants them; is_rotation: values of 4 floats become unit. False: an error is recorded, or a
 * warning says why nothing can move by them. */
bool read_animation_sampler(reader *r, const json_place *at, bool is_rotation, scene_sampler *out);

/* gltf_animation_pointer.c: what a JSON pointer of KHR_animation_pointer moves. */
typedef struct gltf_target {
    scene_channel channel; /* kind, index, offset, scale, is_rotation, pointer */
    uint32_t width;        /* floats of a value that it takes */
    bool needs_steps;      /* of truth values */
    bool is_of_mesh;       /* weights of mesh number channel.index: of all nodes that have it */
} gltf_target;
/* NULL: *out is set, with a copy of the pointer. Else what is wrong with it, as the end of a sentence. */
const char *resolve_pointer(reader *r, const char *pointer, gltf_target *out);

/* gltf_meta.c: extras and metadata of an object. */
scene_meta get_meta(reader *r, const json_place *object);
/* Of the root, the asset, images and textures. */
void read_meta(reader *r, const json_place *root);

/* gltf_legacy_extras.c: scene->legacy by extras.facet_legacy, which a conversion wrote; NULL where none counts. */
void read_legacy_extras(reader *r, const json_place *root);

/* gltf_extensions.c: what the file says it uses; fails on a required one that facet lacks. */
void read_extensions(reader *r, const json_place *root);
bool is_extension_listed(const reader *r, const char *name);

/* uri.c: the bytes that a URI stands for: decoded into the arena (data:) or mapped (a file; closed with the scene).
 * False: *message says why, and *result. Never touches the network. */
bool load_uri(reader *r, const char *uri, uri_bytes *out);

/* glb.c: splits a .glb; json and bin point into bytes. False: an error is recorded. */
bool split_glb(reader *r, const unsigned char *bytes, size_t size, const char **json, size_t *json_size);

#endif
