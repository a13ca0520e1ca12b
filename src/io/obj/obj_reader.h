/* obj_reader.h - what the files of the OBJ reader share. They are called in this order:
 *
 *     obj_cut_chunks      cuts the text into chunks of whole lines
 *     obj_parse_chunk     numbers and statements of one chunk, independent of the others; repeated if the positions
 *                         turn out to be far from the origin
 *     obj_join_chunks     lists of positions, texture coordinates, normals for the whole file
 *     obj_check_chunk     keeps elements with valid indices, which become zero-based
 *     obj_make_runs       names of objects and materials, and their primitives
 *     obj_make_corners    triangles, lines and points, sorted by primitive
 *     obj_make_normals    normals, if the file has none
 *     obj_make_vertices   merges equal corners
 *     obj_make_scene      nodes and meshes
 *
 * Chunks, and blocks of work within the later steps, are cut by size alone, independent of the number of
 * threads. */
#ifndef IO_OBJ_READER_H
#define IO_OBJ_READER_H

#include <stdatomic.h>

#include "base/index_table.h"
#include "io/obj/mtl.h"
#include "io/obj/obj.h"

/* Indices into the lists of the file. The parser stores indices that count back from the end as
 * OBJ_RELATIVE + OBJ_MAX + the index in the chunk's own list, which may be negative. */
#define OBJ_ABSENT UINT32_MAX
#define OBJ_WRONG (UINT32_MAX - 1)
#define OBJ_MAX ((uint32_t)1 << 30) /* elements of a list */
#define OBJ_RELATIVE ((uint32_t)1 << 31)

/* Flaws of a file that is read nevertheless. */
typedef enum obj_remark {
    OBJ_VERTEX_NOT_FINITE,
    OBJ_VERTEX_SHORT,
    OBJ_TEXCOORD_NOT_FINITE,
    OBJ_NOT_A_NUMBER,
    OBJ_UNKNOWN_STATEMENT,
    OBJ_FACE_WRONG,      /* the index of a position is 0, not a number, or out of range */
    OBJ_ATTRIBUTE_WRONG, /* the same for a texture coordinate or normal */
    OBJ_FACE_SHORT,      /* fewer than 3 corners of a face, or 2 of a line */
    OBJ_FACE_NOT_FINITE,
    OBJ_NORMAL_ZERO,
    OBJ_TEXCOORD_MISSING,
    OBJ_POLYGON_ROUGH,
    OBJ_REMARK_COUNT
} obj_remark;

/* Counts of remarks, and the byte of the file (or, while it is unknown, the element of the chunk) of the
 * first. */
typedef struct obj_remarks {
    size_t counts[OBJ_REMARK_COUNT], first[OBJ_REMARK_COUNT];
} obj_remarks;

void obj_note(obj_remarks *remarks, obj_remark remark, size_t offset);

/* Statements that apply to the elements behind them. */
typedef enum obj_event_kind {
    OBJ_OBJECT,
    OBJ_GROUP,
    OBJ_MATERIAL,
    OBJ_SMOOTHING,
    OBJ_LIBRARY,
    OBJ_MODE /* the kind of elements */
} obj_event_kind;

typedef struct obj_event {
    obj_event_kind kind;
    uint32_t value;          /* OBJ_SMOOTHING: the group; OBJ_MODE: a scene_mode */
    const char *text;        /* the arguments, without blanks around them */
    uint32_t length;         /* of text */
    uint32_t element;        /* the first element of the chunk behind it .. */
    uint32_t corner;         /* .. its first corner .. */
    uint32_t triangle_count; /* .. and the number of triangles, after obj_check_chunk(), before it */
} obj_event;

/* Growing lists. */
typedef struct obj_floats {
    float *data;
    size_t count, capacity; /* elements */
} obj_floats;
typedef struct obj_indices {
    uint32_t *data;
    size_t count, capacity;
} obj_indices;

/* A chunk of the text and its contents. */
typedef struct obj_chunk {
    const char *text; /* ends with a line end */
    size_t size, offset;
    const double *origin;                     /* subtracted from positions; NULL: (0, 0, 0) */
    obj_floats positions, texcoords, normals; /* 3, 2, 3 per element */
    obj_floats colors;                        /* 4 per position, < 0: none; empty if no position has one */
    obj_indices mrgb;                         /* ZBrush: 0xMMRRGGBB per position of the file */
    obj_indices sizes;                        /* corners per element: face, line, point */
    obj_indices v, t, n;                      /* per corner; t and n are empty if no corner has any */
    obj_event *events;
    size_t event_count, event_capacity;
    size_t position_base, texcoord_base, normal_base, mrgb_base; /* elements of earlier chunks */
    uint64_t other_statements;                                   /* bits of obj_statement_name() */
    size_t first_other;                                          /* offset of the first of them */
    float color_maximum;                                         /* of colors */
    bool has_color_fractions;                                    /* some color is not an integer */
    bool has_object, has_smoothing, has_statement;
    bool has_zero_normals, has_lost_positions; /* some are unusable */
    bool has_failed;                           /* no memory */
    int mode;                                  /* of the last element; -1: none */
    size_t wanted_element, found_offset;       /* obj_find_element() */
    uint32_t triangle_count;                   /* or lines or points, set by obj_check_chunk() */
    size_t run_begin, run_end;                 /* in the reader's runs */
    obj_remarks remarks;
} obj_chunk;

/* Consecutive elements of a chunk that go to one primitive. */
typedef struct obj_run {
    uint32_t element, element_end, corner; /* of the chunk */
    uint32_t primitive, smoothing;
    uint32_t v_minimum, v_maximum; /* range of positions used */
    size_t out;                    /* the first corner in the reader's arrays */
} obj_run;

typedef struct obj_primitive {
    uint32_t object, material; /* index of a name; SCENE_NONE: no material (points of a cloud) */
    scene_mode mode;
    size_t begin, count; /* corners */
    uint32_t v_minimum, v_maximum;
    /* Set by obj_make_vertices(): */
    uint32_t vertex_count;
    unsigned shift;           /* of the partition, if it has one */
    size_t part;              /* the first */
    size_t missing_texcoords; /* corners without texture coordinates */
    bool has_texcoords, has_colors, has_flat_normals;
    float *positions, *normals, *texcoords, *colors; /* NULL: none */
    float bounds_min[3], bounds_max[3];
} obj_primitive;

/* Names and other keys, numbered in order of appearance. */
typedef struct obj_names {
    facet_allocator allocator;
    struct obj_name *names;
    size_t count, capacity;
    char *bytes;
    size_t size, byte_capacity;
    index_table table; /* by hash */
} obj_names;

typedef struct obj_reader {
    const facet_scene_desc *desc;
    const facet_allocator *allocator;
    facet_scene *scene;
    mtl_reader *materials;
    facet_error *error;
    facet_result result;
    uint32_t thread_count;
    atomic_bool has_failed; /* no memory, set by parallel loops */

    obj_chunk *chunks;
    size_t chunk_count;
    char *tail; /* text of the last chunk, with padding */

    double origin[3]; /* subtracted from positions before they are floats; scene/origin.h */
    float *positions, *texcoords, *normals, *colors; /* colors NULL: none; linear */
    size_t position_count, texcoord_count, normal_count;
    bool has_object, has_smoothing, has_zero_normals, has_lost_positions;

    obj_run *runs;
    size_t run_count, run_capacity;
    obj_names objects, material_names;
    obj_primitive *primitives; /* triangles first, then lines, then points */
    uint32_t primitive_count;
    uint32_t *material_indices; /* of the scene, per name */

    /* Corners of all primitives: three per triangle, two per line. */
    size_t corner_count, triangle_corner_count;
    uint32_t *v, *t,
        *n;           /* t NULL: no texture coordinates; n NULL: all triangles are flat. OBJ_ABSENT: none */
    uint32_t *groups; /* smoothing group per triangle; NULL: not needed */
    float *more_normals; /* indices from normal_count on */
    size_t more_normal_count;
    uint32_t *indices; /* per corner: vertex of its primitive; in the scene's arena */
} obj_reader;

static inline bool obj_is_ok(const obj_reader *r)
{
    return r->result == FACET_OK;
}
/* Record a failure unless there is one; return false. */
bool obj_fail_memory(obj_reader *r, const char *what, size_t size);
bool obj_fail_limit(obj_reader *r, const char *what);
/* Records the failure of a parallel loop. */
bool obj_check_memory(obj_reader *r, const char *what);

/* obj_chunk.c */
void obj_cut_chunks(obj_reader *r, const char *text, size_t size);
void obj_join_chunks(obj_reader *r);
void obj_chunk_release(obj_chunk *c);

/* obj_parse.c */
void obj_parse_chunk(obj_chunk *c, const facet_allocator *allocator);
/* The byte of the file at which an element of the chunk begins, by the parser's numbering. */
size_t obj_find_element(const obj_chunk *c, size_t element, const facet_allocator *allocator);

/* obj_statements.c */
/* Reads a statement other than vertices and elements: text points to its name. Returns the end of what was
 * read. */
const char *obj_parse_statement(obj_chunk *c, const char *text, const facet_allocator *allocator);
/* Names of the bits of other_statements; NULL: no more. is_geometry: free-form curves and surfaces. */
const char *obj_statement_name(unsigned bit, bool *is_geometry);

/* obj_chunk.c */
void obj_check_chunk(obj_reader *r, obj_chunk *c);

/* obj_scene.c */
void obj_make_runs(obj_reader *r);

/* obj_corners.c */
void obj_make_corners(obj_reader *r);
/* For files without elements: all positions as points. */
void obj_make_cloud(obj_reader *r);

/* obj_normals.c */
void obj_make_normals(obj_reader *r);

/* obj_vertices.c */
void obj_make_vertices(obj_reader *r);

/* obj_scene.c */
/* A name in the scene's arena, up to its first 0, as UTF-8; other bytes are taken as Latin-1. NULL: no
 * memory. */
char *obj_copy_name(obj_reader *r, const char *bytes, size_t size);
void obj_make_scene(obj_reader *r);

/* obj_scene.c */
/* The index of a name; UINT32_MAX: no memory. *is_new: it was added. */
uint32_t obj_names_add(obj_names *names, const void *bytes, size_t size, bool *is_new);
void obj_names_release(obj_names *names);

/* obj_corners.c */
/* Corners sorted by blocks of 2^shift positions from v_minimum on, in their original order within each. */
typedef struct obj_partition {
    const uint32_t *v; /* positions of corners begin .. end */
    size_t begin, end;
    uint32_t v_minimum, block_count;
    unsigned shift;
    const uint32_t *taken_n,
        *groups;          /* not NULL: skips corners that have a normal, or whose triangle's group is 0 */
    uint32_t *order;      /* out: indices of corners */
    size_t *block_begins; /* out: block_count + 1, into order; the caller sets the first */
} obj_partition;
/* Chooses blocks of about BLOCK_CORNERS corners each. */
void obj_partition_plan(obj_partition *p, uint32_t v_minimum, uint32_t v_maximum);
bool obj_partition_run(obj_partition *p, uint32_t thread_count, const facet_allocator *allocator);

#endif
