/* ply_reader.h - what the files of the PLY reader share. */
#ifndef IO_PLY_READER_H
#define IO_PLY_READER_H

#include "io/obj/obj_soup.h"

typedef enum ply_type {
    PLY_NONE,
    PLY_INT8,
    PLY_UINT8,
    PLY_INT16,
    PLY_UINT16,
    PLY_INT32,
    PLY_UINT32,
    PLY_FLOAT,
    PLY_DOUBLE
} ply_type;

typedef struct ply_property {
    const char *name; /* in the scene's arena */
    ply_type type;
    ply_type count_type; /* of a list; PLY_NONE: a single number */
} ply_property;

typedef struct ply_element {
    const char *name;
    uint64_t count;
    ply_property *properties; /* block of mem_alloc() */
    size_t property_count, property_capacity;
} ply_element;

typedef enum ply_form { PLY_TEXT, PLY_LITTLE, PLY_BIG } ply_form;

typedef struct ply_reader {
    facet_scene *scene;
    const facet_scene_desc *desc;
    facet_error *error;
    facet_result result;
    const unsigned char *begin, *at, *end;
    ply_form form;
    ply_element *elements; /* block of mem_alloc() */
    size_t element_count, element_capacity;
    const char *texture_file; /* NULL: none */
    size_t texture_line;
    obj_soup soup;
} ply_reader;

/* Records a failure unless there is one; returns false. */
bool ply_fail(ply_reader *r, facet_result result, const char *format, ...)
    __attribute__((format(printf, 3, 4)));
bool ply_fail_memory(ply_reader *r, const char *what);

/* The size of a type in a binary file. */
size_t ply_type_size(ply_type type);

/* ply_vertices.c: the next value of a type. False: the file ends before. */
bool ply_read_value(ply_reader *r, ply_type type, double *value);
/* An upper bound on how many of count elements the remaining bytes hold: each has at least one value per
 * property. */
uint64_t ply_max_elements(const ply_reader *r, const ply_element *e);

/* ply_vertices.c: positions and their attributes. False: a failure is recorded. */
bool ply_read_vertices(ply_reader *r, const ply_element *e);

/* ply_faces.c: faces and strips of triangles. False: a failure is recorded. */
bool ply_read_faces(ply_reader *r, const ply_element *e, bool are_strips);
/* Skips any other element. */
bool ply_skip_element(ply_reader *r, const ply_element *e);

#endif
