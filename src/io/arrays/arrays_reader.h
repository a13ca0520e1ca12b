/* arrays_reader.h - what the files of the reader of arrays share. Places in messages are members of facet_arrays_desc:
 * "arrays: meshes[0].primitives[1].indices: ...". */
#ifndef IO_ARRAYS_READER_H
#define IO_ARRAYS_READER_H

#include "io/json_reader.h"

/* The place of element index of an array member, and of the array. */
#define ARRAYS_PLACE(array, element, parent_place, name, number)                                             \
    const json_place array = {.parent = (parent_place), .key = (name)};                                      \
    const json_place element = {.parent = &(array), .index = (number)}

/* A copy of text, "" for NULL. */
const char *arrays_copy_text(io_reader *r, const char *text);
/* A copy of count elements of size bytes; NULL: an error is recorded. */
void *arrays_copy(io_reader *r, const char *what, const void *in, size_t count, size_t size);
/* Copies floats and checks that they are finite and at most SCENE_FARTHEST. NULL: in is NULL, or an error is recorded. */
const float *arrays_copy_floats(io_reader *r, const json_place *at, const char *key, const float *in,
                                size_t count);
/* Whether numbers are finite; else an error is recorded. */
bool arrays_check_floats(io_reader *r, const json_place *at, const char *key, const float *in, size_t count);
bool arrays_check_doubles(io_reader *r, const json_place *at, const char *key, const double *in,
                          size_t count);
/* Whether an index is below count; else an error is recorded. what: "materials" */
bool arrays_check_index(io_reader *r, const json_place *at, const char *key, uint32_t index, uint32_t count,
                        const char *what);
/* Whether an array with a count is there; else an error is recorded. */
bool arrays_check_array(io_reader *r, const json_place *at, const char *key, const void *array,
                        uint32_t count);

/* The concerns, one file each. */
void arrays_read_textures(io_reader *r, const facet_arrays_desc *arrays);
void arrays_read_materials(io_reader *r, const facet_arrays_desc *arrays);
void arrays_read_meshes(io_reader *r, const facet_arrays_desc *arrays);

#endif
