/* json_reader.h - what the readers of JSON formats (glTF, rgl's parameters) share: typed access to the
 * document whose messages name the place, and memory for the scene.
 *
 * Errors are sticky: the first one stays in io_reader.result and getters then return their fallback, so
 * that parsing code reads like the tables of a specification. Code that loops or allocates tests
 * io_is_ok(). */
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
    const char *folder;             /* of the model; NULL: the model is read from memory */
    const char *root;               /* folder that URIs may reach; NULL: folder */
    const facet_file_source *files; /* NULL, or {0}: the file system */
    json_t *json;
    uint64_t work;              /* elements read so far; see io_spend() */
    struct io_remarks *remarks; /* json_messages.c; NULL: remarks are passed on at once */
    struct gltf_tables *gltf;   /* gltf_reader.h; NULL: another format */
} io_reader;

/* ---- places ---- */

/* A value in the JSON and its path. Lives on the caller's stack; value NULL: absent, for which every
 * getter returns its fallback. */
typedef struct json_place {
    const struct json_place *parent;
    const char *key; /* NULL: element index of an array, or the root */
    size_t index;
    const json_t *value;
} json_place;

bool io_is_ok(const io_reader *r);
/* Records an error "SOURCE: PLACE.key: ..." (key NULL: about the place itself) unless there is one.
 * Returns false. */
bool io_fail(io_reader *r, const json_place *at, const char *key, facet_result result, const char *format,
             ...) __attribute__((format(printf, 5, 6)));
bool io_fail_memory(io_reader *r, const char *what, size_t size);

/* Remarks in the same form. Between io_begin_remarks() and io_end_remarks(), which passes them on, those
 * of one call about the same key become one line with the first place and a count; format must be a
 * literal. A warning means that the image may differ from what the file intends; a note, that the file
 * breaks a rule without effect. See scene_warn(), scene_note(). */
void io_warn(io_reader *r, const json_place *at, const char *key, const char *format, ...)
    __attribute__((format(printf, 4, 5)));
void io_note(io_reader *r, const json_place *at, const char *key, const char *format, ...)
    __attribute__((format(printf, 4, 5)));
/* One line each: about files and extensions, which users want to see completely. */
void io_warn_each(io_reader *r, const json_place *at, const char *key, const char *format, ...)
    __attribute__((format(printf, 4, 5)));
void io_note_each(io_reader *r, const json_place *at, const char *key, const char *format, ...)
    __attribute__((format(printf, 4, 5)));
void io_begin_remarks(io_reader *r);
void io_end_remarks(io_reader *r);

/* An error in a part of the file that the image may not need. */
typedef struct io_problem {
    const char *message; /* NULL: none */
    facet_result result;
    bool is_reported; /* as an error or a warning */
} io_problem;

/* ---- parts that an image may do without ----
 *
 * An error in such a part is withdrawn; lack of memory or an exceeded limit remains an error. */

/* Turns a recorded error into a warning "..; CONSEQUENCE"; those of one consequence, a literal, become one
 * line with a count. True: there was an error, and the caller leaves out the part. */
bool io_leave_out(io_reader *r, const char *consequence);
/* Stores a recorded error as the problem of a part that may not be needed. True: there was one. */
bool io_defer(io_reader *r, io_problem *problem);
/* Records the problem as an error, because the part is needed. Returns false. */
bool io_fail_deferred(io_reader *r, io_problem *problem);
/* Warns about a problem that has not been reported. */
void io_warn_deferred(io_reader *r, io_problem *problem);

/* arena_zalloc() that records the error; count may be 0. */
void *io_alloc(io_reader *r, const char *what, size_t count, size_t size);
/* The same without clearing. */
void *io_alloc_raw(io_reader *r, const char *what, size_t count, size_t size);
/* Accounts for elements to be read. A file can refer to the same bytes any number of times; this limits
 * time and memory. False, with FACET_ERROR_LIMIT recorded, beyond 2^28. */
bool io_spend(io_reader *r, const json_place *at, uint64_t elements);

/* An estimate of jansson's memory for a document. jansson uses malloc; to make that memory subject to the
 * caller's allocator, the readers allocate a block of this size for the lifetime of the document. It stays
 * untouched and costs address space only. Bytes per kind of token measured with jansson 2.14 on x86-64,
 * rounded up. */
size_t io_json_memory_estimate(const char *text, size_t size);
/* Parses JSON; NULL: an error is recorded. Bytes that are not UTF-8, as from exporters in Latin-1, GBK and
 * Shift-JIS, are taken as Latin-1, with one warning: such strings are misspelled but stay distinct. */
json_t *io_parse_json(io_reader *r, const char *text, size_t size);

/* ---- typed members ---- */

/* Fails with "must be WANTED, but is a string". */
bool io_fail_type(io_reader *r, const json_place *at, const char *wanted);
/* at; value NULL if it is absent or (recorded) no object. */
json_place io_as_object(io_reader *r, json_place at);
/* An object or array member; value NULL if it is absent or (recorded) something else. An empty array,
 * which glTF forbids, is noted. */
json_place io_get_object(io_reader *r, const json_place *object, const char *key);
json_place io_get_array(io_reader *r, const json_place *object, const char *key);
size_t io_get_count(const json_place *array);                                          /* 0 without value */
json_place io_get_element(const json_place *array, size_t index);                      /* of any type */
json_place io_get_element_object(io_reader *r, const json_place *array, size_t index); /* must be an object */
/* extensions.NAME */
json_place io_get_extension(io_reader *r, const json_place *object, const char *name);
bool io_has_member(const json_place *object, const char *key);

#define IO_REQUIRED_UINT UINT64_MAX /* fallback that makes absence an error */
/* An integer in [0, maximum]; 5.0 counts as 5. */
uint64_t io_get_uint(io_reader *r, const json_place *object, const char *key, uint64_t maximum,
                     uint64_t fallback);
/* An index below count; what: the kind of object, for messages; SCENE_NONE if absent. */
uint32_t io_get_index(io_reader *r, const json_place *object, const char *key, uint32_t count,
                      const char *what);
uint32_t io_get_required_index(io_reader *r, const json_place *object, const char *key, uint32_t count,
                               const char *what);
/* A place's own value as an index, for elements of arrays. */
uint32_t io_get_index_value(io_reader *r, const json_place *at, uint32_t count, const char *what);
/* An index below count; SCENE_NONE if absent or (not recorded) invalid. */
uint32_t io_peek_index(const json_place *object, const char *key, uint32_t count);
float io_get_float(io_reader *r, const json_place *object, const char *key, float fallback);
/* The same; outside [minimum, maximum] it is clamped with a warning. */
float io_get_float_in(io_reader *r, const json_place *object, const char *key, float minimum, float maximum,
                      float fallback);
/* Fills out with exactly count numbers. False: absent (out is unchanged) or (recorded) invalid. */
bool io_get_floats(io_reader *r, const json_place *object, const char *key, float *out, size_t count);
/* io_get_floats() in double precision; at most 16 numbers. */
bool io_get_doubles(io_reader *r, const json_place *object, const char *key, double *out, size_t count);
/* io_get_floats() of the place itself, which must be an array. */
bool io_get_floats_value(io_reader *r, const json_place *at, float *out, size_t count);
void io_get_floats_in(io_reader *r, const json_place *object, const char *key, float minimum, float maximum,
                      float *out, size_t count);
bool io_get_bool(io_reader *r, const json_place *object, const char *key, bool fallback);
/* Owned by the JSON; fallback if absent. */
const char *io_get_string(io_reader *r, const json_place *object, const char *key, const char *fallback);
/* "name", copied to the scene's arena; "" if absent. Fails for lack of memory only. */
const char *io_get_name(io_reader *r, const json_place *object);

/* uri_load() for the files of the model. */
bool io_load_uri(io_reader *r, const char *uri, uri_bytes *out);

#endif
