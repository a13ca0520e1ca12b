/* json_reader.h - what the readers of JSON formats (glTF, rgl's parameters) share: typed access to the document whose
 * messages name the place, and memory for the scene.
 *
 * Errors are sticky: the first one stays in io_reader.result and getters then return their fallback, so that parsing code
 * reads like the tables of a specification. Code that loops or allocates tests io_is_ok(). */
#ifndef IO_JSON_READER_H
#define IO_JSON_READER_H

#include <jansson.h>

#include "io/uri.h"
#include "scene/scene.h"

typedef struct io_reader {
    facet_scene *scene;
    const facet_allocator *allocator;
    const facet_log *log;
    facet_error *error;
    facet_result result; /* FACET_OK, or the first error */
    uint32_t thread_count;
    uint64_t max_file_bytes;
    const char *folder; /* of the model; NULL: the model is read from memory */
    const char *root;   /* folder that URIs may reach; NULL: folder */
    json_t *json;
    uint64_t work;              /* elements read so far; see io_spend() */
    struct io_remarks *remarks; /* json_messages.c; NULL: remarks are passed on at once */
    struct gltf_tables *gltf;   /* gltf_reader.h; NULL: another format */
} io_reader;

/* ---- places ---- */

/* A value in the JSON and how it was reached. Lives on the stack of who reads it; value NULL: it is not there,
 * and every getter then gives its fallback. */
typedef struct json_place {
    const struct json_place *parent;
    const char *key; /* NULL: element index of an array, or the root */
    size_t index;
    const json_t *value;
} json_place;

bool io_is_ok(const io_reader *r);
/* Records an error "SOURCE: PLACE.key: ..." (key NULL: of the place itself) unless there is one. Returns false. */
bool io_fail(io_reader *r, const json_place *at, const char *key, facet_result result, const char *format,
             ...) __attribute__((format(printf, 5, 6)));
bool io_fail_memory(io_reader *r, const char *what, size_t size);

/* Remarks, of the same form. Those that one call makes about the same key are one line with a count, of the first place,
 * where the reader counts: between io_begin_remarks() and io_end_remarks(), which passes them on. format must be
 * a literal. A warning says that the image may not be what the file means; a note, that the file breaks a rule and
 * nothing comes of it. See scene_warn(), scene_note(). */
void io_warn(io_reader *r, const json_place *at, const char *key, const char *format, ...)
    __attribute__((format(printf, 4, 5)));
void io_note(io_reader *r, const json_place *at, const char *key, const char *format, ...)
    __attribute__((format(printf, 4, 5)));
/* A line for each: of files and extensions, of which the user wants to know all. */
void io_warn_each(io_reader *r, const json_place *at, const char *key, const char *format, ...)
    __attribute__((format(printf, 4, 5)));
void io_note_each(io_reader *r, const json_place *at, const char *key, const char *format, ...)
    __attribute__((format(printf, 4, 5)));
void io_begin_remarks(io_reader *r);
void io_end_remarks(io_reader *r);

/* Why a part of the file cannot be had, of which it is not known yet whether the image needs it. */
typedef struct io_problem {
    const char *message; /* NULL: none */
    facet_result result;
    bool is_reported; /* by an error or a warning */
} io_problem;

/* ---- parts that an image may do without ----
 *
 * An error in one of them is taken back. That memory is short or a limit is reached remains an error. */

/* Makes a recorded error a warning, with what comes of it: "..; CONSEQUENCE". Those of one consequence, a literal, are
 * one line with a count. True: there was one, and the caller leaves out the part. */
bool io_leave_out(io_reader *r, const char *consequence);
/* Keeps a recorded error as the problem of a part that may not be needed. True: there was one. */
bool io_defer(io_reader *r, io_problem *problem);
/* Records the problem as an error: the part is needed. Returns false. */
bool io_fail_deferred(io_reader *r, io_problem *problem);
/* Warns about a problem that no error and no warning has told. */
void io_warn_deferred(io_reader *r, io_problem *problem);

/* arena_zalloc() that records the error. count of 0 is allowed. */
void *io_alloc(io_reader *r, const char *what, size_t count, size_t size);
/* The same without clearing. */
void *io_alloc_raw(io_reader *r, const char *what, size_t count, size_t size);
/* Accounts for elements to be read. A file can refer to the same bytes any number of times: this bounds time and
 * memory. False, with FACET_ERROR_LIMIT recorded, beyond 2^28. */
bool io_spend(io_reader *r, const json_place *at, uint64_t elements);

/* What the document takes that jansson makes of a text. jansson takes its memory from malloc. So that the caller's
 * allocator decides about that memory too, a block as large as the parsed document is taken from it while the document
 * lives; untouched, it costs address space only. Bytes per kind of token measured with jansson 2.14 on x86-64, rounded
 * up. */
size_t io_json_memory_estimate(const char *text, size_t size);
/* json_reader.c: the tree of a text; NULL: an error is recorded. Bytes that are no UTF-8, as exporters in Latin-1, GBK and
 * Shift-JIS write them, are taken for Latin-1, with one warning: what they spelt is lost, but what differed still does. */
json_t *io_parse_json(io_reader *r, const char *text, size_t size);

/* ---- typed members ---- */

/* An object or array member; value NULL where there is none or (recorded) it is something else. An empty array,
 * which glTF forbids, gets a warning. */
json_place io_get_object(io_reader *r, const json_place *object, const char *key);
json_place io_get_array(io_reader *r, const json_place *object, const char *key);
size_t io_get_count(const json_place *array);                                          /* 0 without value */
json_place io_get_element(const json_place *array, size_t index);                      /* of any type */
json_place io_get_element_object(io_reader *r, const json_place *array, size_t index); /* must be an object */
/* extensions.NAME */
json_place io_get_extension(io_reader *r, const json_place *object, const char *name);
bool io_has_member(const json_place *object, const char *key);

#define IO_REQUIRED_UINT UINT64_MAX /* as fallback: absence is an error */
/* A whole number in [0, maximum]; 5.0 counts as 5. */
uint64_t io_get_uint(io_reader *r, const json_place *object, const char *key, uint64_t maximum,
                     uint64_t fallback);
/* An index below count, what names the things; SCENE_NONE where it is absent. */
uint32_t io_get_index(io_reader *r, const json_place *object, const char *key, uint32_t count,
                      const char *what);
uint32_t io_get_required_index(io_reader *r, const json_place *object, const char *key, uint32_t count,
                               const char *what);
/* The value of a place itself as an index, for elements of arrays. */
uint32_t io_get_index_value(io_reader *r, const json_place *at, uint32_t count, const char *what);
/* An index below count; SCENE_NONE where it is absent, or (not recorded) wrong. */
uint32_t io_peek_index(const json_place *object, const char *key, uint32_t count);
float io_get_float(io_reader *r, const json_place *object, const char *key, float fallback);
/* The same; outside [minimum, maximum] it is clamped with a warning. */
float io_get_float_in(io_reader *r, const json_place *object, const char *key, float minimum, float maximum,
                      float fallback);
/* Fills out with exactly count numbers. False: absent (out stays) or (recorded) wrong. */
bool io_get_floats(io_reader *r, const json_place *object, const char *key, float *out, size_t count);
/* io_get_floats() to the precision that the text has; at most 16 numbers. */
bool io_get_doubles(io_reader *r, const json_place *object, const char *key, double *out, size_t count);
/* io_get_floats() of a place itself, which must be an array. */
bool io_get_floats_value(io_reader *r, const json_place *at, float *out, size_t count);
void io_get_floats_in(io_reader *r, const json_place *object, const char *key, float minimum, float maximum,
                      float *out, size_t count);
bool io_get_bool(io_reader *r, const json_place *object, const char *key, bool fallback);
/* Owned by the JSON; fallback where absent. */
const char *io_get_string(io_reader *r, const json_place *object, const char *key, const char *fallback);
/* "name", copied to the scene; "" where there is none. Never fails but for memory. */
const char *io_get_name(io_reader *r, const json_place *object);

/* uri_load() for the files of the model. */
bool io_load_uri(io_reader *r, const char *uri, uri_bytes *out);

#endif
