/* gltf_writer.h - what the files of the glTF writer share: its state, and JSON without members that have
 * glTF's defaults.
 *
 * Errors are sticky: the first one stays in gltf_writer.result; later calls are safe and have no effect
 * that counts. Objects of the scene keep their indices, so that those in metadata stay valid. */
#ifndef IO_GLTF_WRITER_H
#define IO_GLTF_WRITER_H

#include <jansson.h>

#include "base/index_table.h"
#include "scene/scene.h"

/* OpenGL's constants, which glTF uses. */
enum { WRITE_NO_TARGET = 0, WRITE_VERTICES = 34962, WRITE_INDICES = 34963 };

/* An array of the scene that has an accessor. */
typedef struct gltf_written_array {
    const void *data;
    size_t size;
    uint32_t kind; /* type, component and target of the accessor */
    uint32_t accessor;
} gltf_written_array;

typedef struct gltf_writer {
    const facet_scene *scene;
    const char *generator;
    const facet_allocator *allocator;
    const facet_log *log;
    const facet_scene_save_desc *desc;
    facet_error *error;
    facet_result result; /* FACET_OK, or the first error */
    uint32_t thread_count;

    json_t *root, *accessors, *views;
    json_t *extensions_used; /* an object: names in the order of first use; true: required */
    bool needs_all_digits;   /* some number of the metadata has more than 15 digits */
    bool has_other_text;     /* text that is not UTF-8 was reported */
    unsigned char *bin;
    size_t bin_size, bin_capacity;

    gltf_written_array *written; /* block of mem_alloc() */
    size_t written_capacity;
    index_table written_table; /* by hash of data, size and kind */

    bool names_images;              /* textures refer to files of images by name, not by index */
    const char *const *image_names; /* by image; NULL, or a NULL element: the file is not written */
    const char *stem; /* images become files STEM_image0.png ..; NULL: they go into the binary chunk */
    struct gltf_written_file *files;
    size_t file_count, file_capacity;
} gltf_writer;

/* A file beside a .gltf file. */
typedef struct gltf_written_file {
    char *name; /* block of mem_alloc() */
    const unsigned char *bytes;
    size_t size;
    unsigned char *made; /* bytes that the writer made; block of mem_alloc() */
} gltf_written_file;

bool gltf_writer_is_ok(const gltf_writer *w);
void gltf_writer_fail_memory(gltf_writer *w, size_t size); /* 0: an allocation of a library, size unknown */

/* ---- JSON: takes ownership of value, whose NULL means out of memory ---- */

void gltf_put(gltf_writer *w, json_t *object, const char *key, json_t *value);
void gltf_append(gltf_writer *w, json_t *array, json_t *value);
/* A string of the scene or a file name. Bytes that are not UTF-8 are taken as Latin-1, with one warning
 * per file. */
json_t *gltf_json_text(gltf_writer *w, const char *words);
json_t *gltf_put_object(gltf_writer *w, json_t *object,
                        const char *key); /* borrowed; created where it is missing */
json_t *gltf_put_array(gltf_writer *w, json_t *object, const char *key);
/* The shortest number that reads back as the same float. */
json_t *gltf_json_float(float value);
json_t *gltf_json_floats(const float *values, size_t count);
json_t *gltf_json_doubles(const double *values, size_t count); /* with 15 digits or more */
json_t *gltf_json_indices(const uint32_t *indices, size_t count);
void gltf_put_name(gltf_writer *w, json_t *object, const char *name); /* unless it is "" */
void gltf_put_index(gltf_writer *w, json_t *object, const char *key, uint32_t index);
/* Unless all values are those of defaults (NULL: 0). */
void gltf_put_floats(gltf_writer *w, json_t *object, const char *key, const float *values,
                     const float *defaults, size_t count);
void gltf_put_float(gltf_writer *w, json_t *object, const char *key, float value, float default_value);
/* extensions.NAME of object, listed in extensionsUsed; borrowed. */
json_t *gltf_put_extension(gltf_writer *w, json_t *object, const char *name);
/* Lists it in extensionsRequired as well. */
void gltf_require_extension(gltf_writer *w, const char *name);
void gltf_put_uri(gltf_writer *w, json_t *object,
                  const char *name); /* "uri": a file's name, percent-encoded */
/* extras and the extensions that are metadata. */
void gltf_put_meta(gltf_writer *w, json_t *object, const scene_meta *meta);

/* ---- binary data ---- */

typedef enum write_type { WRITE_SCALAR, WRITE_VEC2, WRITE_VEC3, WRITE_VEC4, WRITE_MAT4 } write_type;

/* Writes count elements of floats and returns the index of their accessor; an array that has one shares
 * it. bounds: with min and max. */
uint32_t gltf_write_floats(gltf_writer *w, const float *values, size_t count, write_type type, int target,
                           bool bounds);
/* Positions of a mesh in the coordinates of the file, with min and max. */
uint32_t gltf_write_positions(gltf_writer *w, const float *values, size_t count, const double origin[3]);
/* gltf_write_floats() of zeros, which take no bytes, with min and max. */
uint32_t gltf_write_zeros(gltf_writer *w, size_t count, write_type type);
/* Indices, stored in 16 or 32 bits as the largest needs. */
uint32_t gltf_write_indices(gltf_writer *w, const uint32_t *values, size_t count);
/* count elements of 4 joints, of 8 bits where all fit. stride: values from one element to the next. */
uint32_t gltf_write_joints(gltf_writer *w, const uint16_t *joints, size_t count, size_t stride);
uint32_t gltf_write_weights(gltf_writer *w, const float *weights, size_t count,
                            size_t stride); /* the same, floats */
uint32_t gltf_write_bytes(gltf_writer *w, const unsigned char *values,
                          size_t count); /* SCALAR UNSIGNED_BYTE */
/* Writes bytes without an accessor and returns the index of their buffer view. */
uint32_t gltf_write_view(gltf_writer *w, const void *bytes, size_t size, int target);

/* ---- the concerns, one file each ---- */

/* gltf_write_materials.c */
void gltf_write_images(gltf_writer *w);
void gltf_write_textures(gltf_writer *w);
void gltf_write_materials(gltf_writer *w);
json_t *gltf_new_material(gltf_writer *w, const scene_material *material); /* NULL: no memory */
/* gltf_write_scene.c */
void gltf_write_meshes(gltf_writer *w);
void gltf_write_cameras(gltf_writer *w);
void gltf_write_lights(gltf_writer *w);
void gltf_write_nodes(gltf_writer *w);
void gltf_write_scenes(gltf_writer *w);
void gltf_write_skins(gltf_writer *w);
void gltf_write_animations(gltf_writer *w);

#endif
