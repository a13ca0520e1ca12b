/* obj_read.c - reads a file by the steps of obj_reader.h, and reports its flaws: one sentence per kind,
 * with the first line. */
#include <stdio.h>
#include <string.h>

#include "base/parallel.h"
#include "base/result.h"
#include "base/text.h"
#include "io/obj/obj.h"
#include "io/obj/obj_parse.h"
#include "io/uri.h"
#include "scene/origin.h"

/* ---- remarks ---- */

void obj_note(obj_remarks *remarks, obj_remark remark, size_t offset)
{
    if (remarks->counts[remark]++ == 0)
        remarks->first[remark] = offset;
}

/* The number of the line at byte offset, from 1. */
static size_t line_number(const char *bytes, size_t offset)
{
    size_t line = 1;
    for (size_t i = 0; i < offset; i++)
        line += bytes[i] == '\n' || (bytes[i] == '\r' && bytes[i + 1] != '\n');
    return line;
}

typedef enum place { AT_BYTE, AT_ELEMENT, NOWHERE } place;

/* The sentence of each remark, after "FILE: line N: ". */
static const struct {
    const char *sentence;
    place place; /* meaning of remarks.first */
} REMARKS[OBJ_REMARK_COUNT] = {
    [OBJ_VERTEX_NOT_FINITE] = {"a vertex is not finite, or farther out than 1e17; it is not drawn", AT_BYTE},
    [OBJ_VERTEX_SHORT] = {"a vertex has fewer than 3 coordinates; the others are 0", AT_BYTE},
    [OBJ_TEXCOORD_NOT_FINITE] = {"a texture coordinate is not finite; it becomes 0", AT_BYTE},
    [OBJ_NOT_A_NUMBER] = {"a word is not a number; its numeric beginning is used", AT_BYTE},
    [OBJ_UNKNOWN_STATEMENT] = {"the statement is unknown; it is ignored", AT_BYTE},
    [OBJ_FACE_WRONG] = {"an element refers to a vertex that does not exist; it is left out", AT_ELEMENT},
    [OBJ_ATTRIBUTE_WRONG] =
        {"an element refers to a texture coordinate or normal that does not exist; it is drawn without",
         AT_ELEMENT},
    [OBJ_FACE_SHORT] = {"a face has fewer than 3 different corners, or a line fewer than 2; it is left out",
                        AT_ELEMENT},
    [OBJ_FACE_NOT_FINITE] = {"an element uses a vertex that is not finite; it is left out", AT_ELEMENT},
    [OBJ_NORMAL_ZERO] = {"a normal has no direction; another one is computed", AT_ELEMENT},
    [OBJ_TEXCOORD_MISSING] = {"some corners of a material have texture coordinates, others do not; those get "
                              "(0, 0)",
                              NOWHERE},
    [OBJ_POLYGON_ROUGH] = {"a polygon has so many corners that it was triangulated only roughly", NOWHERE},
};

static size_t count_remark(const obj_reader *r, obj_remark remark)
{
    size_t count = 0;
    for (size_t i = 0; i < r->chunk_count; i++)
        count += r->chunks[i].remarks.counts[remark];
    return count;
}

/* The line of a remark that was made. */
static size_t find_line(const obj_reader *r, obj_remark remark, const char *bytes)
{
    size_t i = 0;
    while (r->chunks[i].remarks.counts[remark] == 0)
        i++;
    size_t first = r->chunks[i].remarks.first[remark];
    if (REMARKS[remark].place == AT_ELEMENT)
        first = obj_find_element(&r->chunks[i], first, r->allocator);
    return line_number(bytes, first);
}

static void warn_remark(obj_reader *r, obj_remark remark, const char *bytes)
{
    size_t count = count_remark(r, remark);
    char line[32] = "";
    char more[64] = "";
    if (count == 0)
        return;
    if (REMARKS[remark].place != NOWHERE)
        snprintf(line, sizeof line, "line %zu: ", find_line(r, remark, bytes));
    if (count > 1)
        snprintf(more, sizeof more, " (%zu times in all)", count);
    scene_warn(r->scene, &r->desc->log, "%s: %s%s%s", r->scene->source, line, REMARKS[remark].sentence, more);
}

/* One warning for all unsupported statements of a kind. */
static void warn_statements(obj_reader *r, bool is_geometry, const char *sentence)
{
    uint64_t all = 0;
    for (size_t i = 0; i < r->chunk_count; i++)
        all |= r->chunks[i].other_statements;
    text names = {.allocator = *r->allocator};
    bool is_curved;
    const char *name;
    for (unsigned bit = 0; (name = obj_statement_name(bit, &is_curved)); bit++)
        if (is_curved == is_geometry && all >> bit & 1u)
            text_addf(&names, "%s%s", names.length ? ", " : "", name);
    if (names.length && !names.has_failed)
        scene_warn(r->scene, &r->desc->log, "%s: %s: %s", r->scene->source, sentence, names.data);
    text_destroy(&names);
}

static void report_remarks(obj_reader *r, const char *bytes)
{
    for (int i = 0; i < OBJ_REMARK_COUNT; i++)
        warn_remark(r, (obj_remark)i, bytes);
    warn_statements(r, true, "free-form curves and surfaces are not supported; ignored");
    warn_statements(r, false, "statements without a counterpart in facet; ignored");
}

/* ---- failures ---- */

bool obj_fail_memory(obj_reader *r, const char *what, size_t size)
{
    if (obj_is_ok(r))
        r->result = fail_memory(r->error, what, size);
    return false;
}

bool obj_fail_limit(obj_reader *r, const char *what)
{
    if (obj_is_ok(r))
        r->result =
            fail(r->error, FACET_ERROR_LIMIT, "%s: has more %s than can be indexed", r->scene->source, what);
    return false;
}

bool obj_check_memory(obj_reader *r, const char *what)
{
    return !atomic_load(&r->has_failed) || obj_fail_memory(r, what, 0);
}

/* ---- steps ---- */

static void parse_chunks(void *context, size_t begin, size_t end)
{
    obj_reader *r = context;
    for (size_t i = begin; i < end && !atomic_load(&r->has_failed); i++) {
        obj_parse_chunk(&r->chunks[i], r->allocator);
        if (r->chunks[i].has_failed)
            atomic_store(&r->has_failed, true);
    }
}

/* Samples positions of all chunks to find the origin. */
static bool find_origin(obj_reader *r)
{
    enum { MAX = 1024 };
    size_t total = 0, count = 0, next = 0, before = 0;
    for (size_t i = 0; i < r->chunk_count; i++)
        total += r->chunks[i].positions.count;
    size_t step = total / MAX + 1;
    float *few = mem_alloc(r->allocator, MAX, 3 * sizeof *few);
    for (size_t i = 0; few && i < r->chunk_count; i++) {
        const obj_floats *list = &r->chunks[i].positions;
        for (; next < before + list->count; next += step)
            memcpy(few + 3 * count++, list->data + 3 * (next - before), 3 * sizeof *few);
        before += list->count;
    }
    bool is_far = few && scene_find_origin(few, count, r->allocator, r->origin);
    mem_free(few);
    return few ? is_far : obj_fail_memory(r, "positions", MAX * 3 * sizeof *few);
}

/* The numbers of a model that is far from the origin are parsed again, since floats have lost their
 * digits. */
static void parse(obj_reader *r)
{
    parallel_for(r->thread_count, r->chunk_count, 1, parse_chunks, r);
    if (!obj_check_memory(r, "statements") || !find_origin(r))
        return;
    for (size_t i = 0; i < r->chunk_count; i++) {
        obj_chunk *c = &r->chunks[i];
        obj_chunk_release(c);
        *c = (obj_chunk){.text = c->text,
                         .size = c->size,
                         .offset = c->offset,
                         .origin = r->origin,
                         .wanted_element = SIZE_MAX};
    }
    parallel_for(r->thread_count, r->chunk_count, 1, parse_chunks, r);
    obj_check_memory(r, "statements");
}

static void check_chunks(void *context, size_t begin, size_t end)
{
    obj_reader *r = context;
    for (size_t i = begin; i < end; i++)
        obj_check_chunk(r, &r->chunks[i]);
}

/* Whether a comment is a sentence about the model, and not the name of a program. */
static bool is_prose(const char *comment, size_t length)
{
    while (length && obj_is_blank(comment[length - 1]))
        length--;
    return length && comment[length - 1] == '.';
}

/* Comments before the first statement tell the program that wrote the file; the first one, unless it is a sentence,
 * is kept as its name. */
static void read_head(obj_reader *r)
{
    enum { MAX_COMMENTS = 8, MAX_LENGTH = 200 };
    const char *p = r->chunks[0].text;
    const char *end = p + r->chunks[0].size;
    for (int i = 0; i < MAX_COMMENTS && p < end;) {
        while (p < end && (obj_is_blank(*p) || obj_is_line_end(*p)))
            p++;
        if (p == end || *p != '#')
            return;
        while (*p == '#' || obj_is_blank(*p))
            p++;
        const char *line = p;
        while (!obj_is_line_end(*p))
            p++;
        size_t length = (size_t)(p - line) < MAX_LENGTH ? (size_t)(p - line) : MAX_LENGTH;
        if (length == 0)
            continue;
        mtl_reader_hint(r->materials, line, length);
        if (i++ == 0 && !is_prose(line, length)) {
            r->scene->generator = obj_copy_name(r, line, length);
            if (!r->scene->generator)
                return;
        }
    }
}

/* Whether the text contains OBJ statements and elements. */
static bool look_at_statements(obj_reader *r, bool *has_elements)
{
    bool has_statement = false;
    *has_elements = false;
    for (size_t i = 0; i < r->chunk_count; i++) {
        const obj_chunk *c = &r->chunks[i];
        *has_elements |= c->mode >= 0;
        has_statement |=
            c->has_statement || c->mode >= 0 || c->positions.count || c->texcoords.count || c->normals.count;
    }
    if (!has_statement)
        r->result = fail(r->error, FACET_ERROR_INVALID,
                         "%s: has no statement of an OBJ file; vertices (v) and faces (f) were expected",
                         r->scene->source);
    return has_statement;
}

static void make_geometry(obj_reader *r, bool has_elements)
{
    obj_join_chunks(r);
    if (obj_is_ok(r) && has_elements)
        parallel_for(r->thread_count, r->chunk_count, 1, check_chunks, r);
    if (obj_is_ok(r))
        obj_make_runs(r);
    if (obj_is_ok(r) && has_elements)
        obj_make_corners(r);
    else if (obj_is_ok(r))
        obj_make_cloud(r);
    if (obj_is_ok(r)) { /* not before the chunks have released their names */
        r->indices = arena_alloc(r->scene->arena, r->corner_count, sizeof *r->indices);
        if (!r->indices)
            obj_fail_memory(r, "indices", r->corner_count * sizeof *r->indices);
    }
    if (obj_is_ok(r))
        obj_make_normals(r);
    if (obj_is_ok(r))
        obj_make_vertices(r);
}

/* Reports what was left out and replaced. */
static void warn_all(obj_reader *r, bool has_elements, const char *bytes)
{
    for (uint32_t i = 0; i < r->primitive_count; i++)
        if (r->primitives[i].has_texcoords)
            r->chunks[0].remarks.counts[OBJ_TEXCOORD_MISSING] += r->primitives[i].missing_texcoords;
    report_remarks(r, bytes);
    if (r->primitive_count == 0)
        scene_warn(r->scene, &r->desc->log, "%s: has no face, line or point that can be drawn",
                   r->scene->source);
    else if (!has_elements)
        scene_warn(r->scene, &r->desc->log, "%s: has vertices only; they are shown as points",
                   r->scene->source);
}

static void read_all(obj_reader *r, const char *bytes, size_t size)
{
    bool has_elements;
    obj_cut_chunks(r, bytes, size);
    if (!obj_is_ok(r))
        return;
    parse(r);
    if (!obj_is_ok(r) || !look_at_statements(r, &has_elements))
        return;
    read_head(r);
    make_geometry(r, has_elements);
    if (obj_is_ok(r))
        obj_make_scene(r);
    if (obj_is_ok(r))
        warn_all(r, has_elements, bytes);
}

/* ---- the file ---- */

static void release(obj_reader *r)
{
    for (size_t i = 0; i < r->chunk_count; i++)
        obj_chunk_release(&r->chunks[i]);
    mem_free(r->chunks);
    mem_free(r->tail);
    mem_free(r->positions);
    mem_free(r->texcoords);
    mem_free(r->normals);
    mem_free(r->colors);
    mem_free(r->runs);
    obj_names_release(&r->objects);
    obj_names_release(&r->material_names);
    mem_free(r->primitives);
    mem_free(r->material_indices);
    mem_free(r->v);
    mem_free(r->t);
    mem_free(r->n);
    mem_free(r->groups);
    mem_free(r->more_normals);
    mtl_reader_destroy(r->materials);
}

/* folder: NULL: from memory. */
static facet_result load(const char *bytes, size_t size, const char *source, const char *folder,
                         const facet_scene_desc *desc, facet_scene **out, facet_error *error)
{
    obj_reader r = {.desc = desc,
                    .allocator = &desc->allocator,
                    .error = error,
                    .thread_count = desc->thread_count,
                    .objects.allocator = desc->allocator,
                    .material_names.allocator = desc->allocator};
    r.result = scene_create(&desc->allocator, source, &r.scene, error);
    if (obj_is_ok(&r)) {
        r.scene->max_texture_size = desc->max_texture_size;
        r.scene->thread_count = desc->thread_count;
        r.result = mtl_reader_create(r.scene, desc, folder, &r.materials, error);
    }
    if (obj_is_ok(&r))
        read_all(&r, bytes, size);
    if (obj_is_ok(&r))
        r.result = mtl_reader_finish(r.materials, error);
    release(&r);
    if (r.result == FACET_OK)
        *out = r.scene;
    else
        scene_destroy(r.scene);
    return r.result;
}

facet_result obj_load(const char *path, const facet_scene_desc *desc, facet_scene **scene, facet_error *error)
{
    const facet_scene_desc defaults = {0};
    return io_load_file(load, path, desc ? desc : &defaults, scene, error);
}

facet_result obj_load_memory(const void *bytes, size_t size, const char *name, const facet_scene_desc *desc,
                             facet_scene **scene, facet_error *error)
{
    const facet_scene_desc defaults = {0};
    *scene = NULL;
    return load(bytes, size, name, NULL, desc ? desc : &defaults, scene, error);
}
