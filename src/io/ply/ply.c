/* ply.c - reads a PLY file: the header, lines of text up to "end_header", then the elements in order, and
 * the scene made of them. */
#include "io/ply/ply.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "base/result.h"
#include "io/obj/mtl_parts.h"
#include "io/ply/ply_reader.h"

/* ---- the header ---- */

enum { MAX_ELEMENTS = 64, MAX_PROPERTIES = 1024, MAX_LINES = 100000 };

static const struct {
    const char *name;
    ply_type type;
} TYPES[] = {
    {"char", PLY_INT8},   {"uchar", PLY_UINT8},   {"short", PLY_INT16},   {"ushort", PLY_UINT16},
    {"int", PLY_INT32},   {"uint", PLY_UINT32},   {"float", PLY_FLOAT},   {"double", PLY_DOUBLE},
    {"int8", PLY_INT8},   {"uint8", PLY_UINT8},   {"int16", PLY_INT16},   {"uint16", PLY_UINT16},
    {"int32", PLY_INT32}, {"uint32", PLY_UINT32}, {"float32", PLY_FLOAT}, {"float64", PLY_DOUBLE},
};

size_t ply_type_size(ply_type type)
{
    static const size_t sizes[] = {0, 1, 1, 2, 2, 4, 4, 4, 8};
    return sizes[type];
}

typedef struct span {
    const char *at, *end;
} span;

static bool is_blank(char c)
{
    return c == ' ' || c == '\t';
}

static span take_word(span *rest)
{
    while (rest->at < rest->end && is_blank(*rest->at))
        rest->at++;
    span word = {rest->at, rest->at};
    while (word.end < rest->end && !is_blank(*word.end))
        word.end++;
    rest->at = word.end;
    return word;
}

static bool is_word(span s, const char *word)
{
    return (size_t)(s.end - s.at) == strlen(word) && memcmp(s.at, word, strlen(word)) == 0;
}

static const char *keep(ply_reader *r, span s)
{
    size_t length = (size_t)(s.end - s.at);
    char *copy = arena_alloc(r->scene->arena, length + 1, 1);
    if (!copy) {
        ply_fail_memory(r, "names");
        return "";
    }
    memcpy(copy, s.at, length);
    copy[length] = 0;
    return copy;
}

/* The next line, which ends with LF, CR or both. False: the file ends before. */
static bool take_line(ply_reader *r, span *line)
{
    const unsigned char *p = r->at;
    while (p < r->end && *p != '\n' && *p != '\r')
        p++;
    if (p == r->end)
        return false;
    *line = (span){(const char *)r->at, (const char *)p};
    r->at = p + (p + 1 < r->end && p[0] == '\r' && p[1] == '\n' ? 2 : 1);
    return true;
}

static ply_type find_type(span word)
{
    for (size_t i = 0; i < sizeof TYPES / sizeof *TYPES; i++)
        if (is_word(word, TYPES[i].name))
            return TYPES[i].type;
    return PLY_NONE;
}

#define SHOWN(s) (int)((s).end - (s).at < 60 ? (s).end - (s).at : 60), (s).at

static void read_format(ply_reader *r, span rest)
{
    span word = take_word(&rest);
    if (is_word(word, "ascii"))
        r->form = PLY_TEXT;
    else if (is_word(word, "binary_little_endian"))
        r->form = PLY_LITTLE;
    else if (is_word(word, "binary_big_endian"))
        r->form = PLY_BIG;
    else
        ply_fail(r, FACET_ERROR_INVALID,
                 "format \"%.*s\" is not one of ascii, binary_little_endian and binary_big_endian",
                 SHOWN(word));
}

static void read_element(ply_reader *r, span rest)
{
    span name = take_word(&rest);
    span word = take_word(&rest);
    uint64_t count = 0;
    bool is_number = word.at < word.end;
    for (const char *c = word.at; c < word.end; c++) {
        is_number = is_number && *c >= '0' && *c <= '9';
        count = is_number && count < UINT64_MAX / 16 ? 10 * count + (uint64_t)(*c - '0') : count;
    }
    if (!is_number || r->element_count == MAX_ELEMENTS) {
        ply_fail(r, FACET_ERROR_INVALID,
                 "element \"%.*s\": a number of elements was expected, %d kinds at most", SHOWN(name),
                 (int)MAX_ELEMENTS);
        return;
    }
    if (!mem_reserve(&r->desc->allocator, (void **)&r->elements, &r->element_capacity, r->element_count + 1,
                     sizeof *r->elements)) {
        ply_fail_memory(r, "elements");
        return;
    }
    r->elements[r->element_count++] = (ply_element){.name = keep(r, name), .count = count};
}

static void read_property(ply_reader *r, span rest)
{
    ply_property p = {.name = ""};
    span word = take_word(&rest);
    ply_element *e = r->element_count ? &r->elements[r->element_count - 1] : NULL;
    bool is_list = is_word(word, "list");
    if (is_list) {
        word = take_word(&rest);
        p.count_type = find_type(word);
    }
    bool is_count = !is_list || (p.count_type != PLY_NONE && p.count_type < PLY_FLOAT);
    if (is_list && is_count)
        word = take_word(&rest);
    p.type = find_type(word);
    span name = take_word(&rest);
    if (!e || !is_count || p.type == PLY_NONE || name.at == name.end || e->property_count == MAX_PROPERTIES) {
        ply_fail(r, FACET_ERROR_INVALID,
                 "property \"%.*s\": type and name behind an element were expected, not \"%.*s\"",
                 SHOWN(name), SHOWN(word));
        return;
    }
    p.name = keep(r, name);
    if (!mem_reserve(&r->desc->allocator, (void **)&e->properties, &e->property_capacity,
                     e->property_count + 1, sizeof *e->properties)) {
        ply_fail_memory(r, "properties");
        return;
    }
    e->properties[e->property_count++] = p;
}

/* MeshLab names its texture in a comment; the first one is used. */
static void read_comment(ply_reader *r, span rest, size_t line)
{
    span all = rest;
    while (all.at < all.end && is_blank(*all.at))
        all.at++;
    while (all.end > all.at && is_blank(all.end[-1]))
        all.end--;
    span word = take_word(&rest);
    while (rest.at < rest.end && is_blank(*rest.at))
        rest.at++;
    span name = {rest.at < all.end ? rest.at : all.end, all.end};
    if (is_word(word, "TextureFile") && name.at < name.end && !r->texture_file) {
        r->texture_file = keep(r, name);
        r->texture_line = line;
    }
}

/* Reads up to the data. False: a failure is recorded. */
static bool read_header(ply_reader *r)
{
    span line;
    bool has_format = false;
    if (!take_line(r, &line))
        return ply_fail(r, FACET_ERROR_INVALID, "is cut off in its header");
    for (int i = 0; r->result == FACET_OK; i++) {
        if (i == MAX_LINES || !take_line(r, &line))
            return ply_fail(r, FACET_ERROR_INVALID, "has no \"end_header\"");
        span rest = line;
        span word = take_word(&rest);
        if (is_word(word, "end_header"))
            break;
        if (is_word(word, "format"))
            read_format(r, rest);
        else if (is_word(word, "element"))
            read_element(r, rest);
        else if (is_word(word, "property"))
            read_property(r, rest);
        else if (is_word(word, "comment") || is_word(word, "obj_info"))
            read_comment(r, rest, (size_t)i + 2);
        else if (word.at < word.end)
            return ply_fail(r, FACET_ERROR_INVALID,
                            "\"%.*s\" is not a line of a header; element, property, comment or "
                            "end_header was expected",
                            SHOWN(word));
        has_format |= is_word(word, "format");
    }
    if (r->result == FACET_OK && !has_format)
        return ply_fail(r, FACET_ERROR_INVALID, "its header has no format");
    return r->result == FACET_OK;
}

/* ---- elements ---- */

bool ply_fail(ply_reader *r, facet_result result, const char *format, ...)
{
    char message[512];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(message, sizeof message, format, arguments);
    va_end(arguments);
    if (r->result == FACET_OK)
        r->result = fail(r->error, result, "%s: %s", r->scene->source, message);
    return false;
}

bool ply_fail_memory(ply_reader *r, const char *what)
{
    if (r->result == FACET_OK)
        r->result = fail_memory(r->error, what, (size_t)(r->end - r->begin));
    return false;
}

bool ply_detect(const void *bytes, size_t size)
{
    const char *p = bytes;
    return size >= 4 && memcmp(p, "ply", 3) == 0 && (p[3] == '\n' || p[3] == '\r' || p[3] == ' ');
}

/* ---- the parts of a scene ---- */

/* Vertices that no face uses become points. */
static bool make_cloud(ply_reader *r)
{
    obj_soup *s = &r->soup;
    s->is_cloud = true;
    s->v = mem_alloc(&r->desc->allocator, s->place_count, sizeof *s->v);
    if (!s->v)
        return ply_fail_memory(r, "points");
    if (s->place_count >= UINT32_MAX)
        return ply_fail(r, FACET_ERROR_LIMIT, "has more points than can be indexed");
    for (size_t i = 0; i < s->place_count; i++)
        s->v[i] = (uint32_t)i;
    s->corner_count = s->place_count;
    return true;
}

/* Faces without texture coordinates in a file where others have them. */
static void fill_texcoords(obj_soup *s)
{
    if (s->t && s->texcoord_count == 0) {
        mem_free(s->t);
        s->t = NULL;
    }
}

/* The image that the header names, as base color. */
static void find_texture(ply_reader *r, const char *folder)
{
    if (!r->texture_file || r->soup.texcoord_count == 0)
        return;
    mtl_files files = {.scope = {.scene = r->scene,
                                 .allocator = &r->desc->allocator,
                                 .log = &r->desc->log,
                                 .files = &r->desc->files,
                                 .folder = folder,
                                 .root = r->desc->root,
                                 .max_file_bytes = file_limit(r->desc->max_file_bytes)}};
    mtl_parser p = {.arena = r->scene->arena,
                    .allocator = &r->desc->allocator,
                    .scene = r->scene,
                    .log = &r->desc->log,
                    .file = r->scene->source,
                    .line = r->texture_line};
    uint32_t image = mtl_files_image(&files, &p, "", r->texture_file);
    if (image != SCENE_NONE)
        r->soup.base_color.texture = mtl_files_texture(&files, &(scene_texture){.name = "", .image = image});
    if (files.has_failed || p.has_failed || !mtl_files_finish(&files))
        ply_fail_memory(r, "texture");
    mtl_files_destroy(&files);
}

static bool add_part(ply_reader *r)
{
    if (!mem_reserve(&r->desc->allocator, (void **)&r->soup.parts, &r->soup.part_capacity, 1,
                     sizeof *r->soup.parts))
        return ply_fail_memory(r, "parts");
    r->soup.parts[r->soup.part_count++] = (obj_soup_part){.name = ""};
    return true;
}

static void read_elements(ply_reader *r)
{
    for (size_t i = 0; i < r->element_count && r->result == FACET_OK; i++) {
        const ply_element *e = &r->elements[i];
        if (strcmp(e->name, "vertex") == 0)
            ply_read_vertices(r, e);
        else if (strcmp(e->name, "face") == 0)
            ply_read_faces(r, e, false);
        else if (strcmp(e->name, "tristrips") == 0)
            ply_read_faces(r, e, true);
        else
            ply_skip_element(r, e);
    }
    if (r->result == FACET_OK && !r->soup.places)
        ply_fail(r, FACET_ERROR_INVALID, "has no element \"vertex\"");
}

static void read_all(ply_reader *r, const char *folder)
{
    if (read_header(r))
        read_elements(r);
    if (r->result != FACET_OK || !add_part(r))
        return;
    fill_texcoords(&r->soup);
    if (r->soup.corner_count == 0 && !make_cloud(r))
        return;
    find_texture(r, folder);
    if (r->result == FACET_OK)
        r->result = obj_soup_finish(&r->soup, r->error);
    if (r->result == FACET_OK)
        scene_note(r->scene, &r->desc->log,
                   "%s: PLY names no unit and no upward axis; numbers are read as metres, with y up (--up z)",
                   r->scene->source);
}

static void release(ply_reader *r)
{
    for (size_t i = 0; i < r->element_count; i++)
        mem_free(r->elements[i].properties);
    mem_free(r->elements);
    obj_soup_release(&r->soup);
}

facet_result ply_load_memory(const void *bytes, size_t size, const char *name, const char *folder,
                             const facet_scene_desc *desc, facet_scene **scene, facet_error *error)
{
    const facet_scene_desc defaults = {0};
    ply_reader r = {.desc = desc ? desc : &defaults,
                    .error = error,
                    .begin = bytes,
                    .at = bytes,
                    .end = (const unsigned char *)bytes + size};
    *scene = NULL;
    r.result = scene_create(&r.desc->allocator, name, &r.scene, error);
    if (r.result != FACET_OK)
        return r.result;
    r.scene->max_texture_size = r.desc->max_texture_size;
    r.scene->thread_count = r.desc->thread_count;
    r.soup = obj_soup_begin(r.scene, r.desc);
    read_all(&r, folder);
    release(&r);
    if (r.result == FACET_OK)
        *scene = r.scene;
    else
        scene_destroy(r.scene);
    return r.result;
}
