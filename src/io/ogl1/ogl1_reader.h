/* ogl1_reader.h - what the files of the reader of rgl's parameters share, on top of json_reader.h. The
 * parameters are first read into an ogl1_document, which then becomes a scene or is applied to one. */
#ifndef IO_OGL1_READER_H
#define IO_OGL1_READER_H

#include "io/json_reader.h"
#include "scene/legacy.h"

/* An element of "materials". ogl1_find_textures() sets the texture of its map. */
typedef struct ogl1_entry {
    const char *name; /* NULL: not stated */
    uint32_t object_count;
    const char **objects;
    legacy_material material;
    scene_texture sampler; /* of the texture; repeats, as rgl's do */
} ogl1_entry;

typedef struct ogl1_document {
    io_reader r;
    uint32_t entry_count;
    ogl1_entry *entries;
    bool has_lights, has_fog; /* false: absent from the document */
    uint32_t light_count;
    legacy_light *lights;
    legacy_fog fog;
    facet_legacy_colors colors; /* FACET_LEGACY_COLORS_DEFAULT: not stated */
    const char *generator;      /* "" */
} ogl1_document;

/* ---- values as R's toJSON() writes them (ogl1_values.c) ----
 *
 * A value may be wrapped in an array. It counts as absent if there is no such member, or null, [] and {} (R's empty
 * vectors and NULL), or "NA". The first value of a longer vector is used, with a warning. Where a getter returns
 * false, *out is unchanged: the value is absent, or an error is recorded. */
json_place ogl1_member(const json_place *object, const char *key);               /* value NULL: absent */
json_place ogl1_object(io_reader *r, const json_place *object, const char *key); /* the same, or an error */
bool ogl1_number(io_reader *r, const json_place *object, const char *key, double *out);
/* Clamped, with a warning. */
bool ogl1_number_in(io_reader *r, const json_place *object, const char *key, double minimum, double maximum,
                    float *out);
bool ogl1_bool(io_reader *r, const json_place *object, const char *key,
               bool *out); /* 0 and 1 are accepted, too */
bool ogl1_string(io_reader *r, const json_place *object, const char *key,
                 const char **out); /* owned by the JSON */
bool ogl1_string_value(io_reader *r, const json_place *at, const char **out);
/* Three numbers, at most SCENE_FARTHEST: an array, or a matrix of one row. */
bool ogl1_vector(io_reader *r, const json_place *object, const char *key, float out[3]);
/* A name of R, "#rrggbb", an index of R's palette, or 3 to 4 numbers >= 0. */
bool ogl1_color(io_reader *r, const json_place *object, const char *key, float rgba[4]);
bool ogl1_color_value(io_reader *r, const json_place *at, float rgba[4]);
/* The index of one of names, which end with NULL. */
bool ogl1_choice(io_reader *r, const json_place *object, const char *key, const char *const *names, int *out);

/* R writes a list of lists as an array of objects, as an object of objects if they had names, or as the
 * bare object if there was no list (is_element() decides). */
typedef struct ogl1_list {
    json_place at;
    size_t count, next;
    void *iterator;
    bool is_single;
} ogl1_list;
/* count 0: absent, empty, or an error is recorded. */
ogl1_list ogl1_list_begin(io_reader *r, const json_place *object, const char *key,
                          bool (*is_element)(const json_t *));
/* The next object, whose parent is list->at; false: there is none, or an error is recorded. */
bool ogl1_list_next(io_reader *r, ogl1_list *list, json_place *element);

/* ---- parts of a document ---- */

/* ogl1_materials.c: one of "materials". */
void ogl1_read_material(io_reader *r, const json_place *at, ogl1_entry *out);

/* ogl1_lights.c: "lights", "fog", "background". */
void ogl1_read_lights(ogl1_document *d, const json_place *root);
void ogl1_read_fog(ogl1_document *d, const json_place *root);

/* ogl1_json.c: parses the bytes and reads the document into the arena of scene; d->r.result is the result.
 * folder: of the document; NULL: from memory. */
void ogl1_document_read(ogl1_document *d, facet_scene *scene, const char *bytes, size_t size,
                        const char *folder, const facet_scene_desc *desc, facet_error *error);

/* ogl1_materials.c: locates the images of the entries, appends them and their textures to the scene and
 * sets the maps of the entries. Missing images are reported. */
void ogl1_find_textures(ogl1_document *d);

/* ogl1_json.c: copies lights, fog and the encoding of colors to scene->legacy, which must exist. */
void ogl1_set_lights_and_fog(const ogl1_document *d, const facet_legacy_desc *desc);

#endif
