/* stl.c - see stl.h. A binary file has a header of 80 bytes, the number of triangles, and 50 bytes per
 * triangle: the normal and three corners as floats, and 16 bits without a standard meaning. */
#include "io/stl/stl.h"

#include <string.h>
#include <strings.h>

#include "base/memory.h"
#include "base/hash.h"
#include "base/result.h"
#include "image/codec.h"
#include "io/obj/obj_soup.h"
#include "io/obj/obj_table.h"

enum { HEADER_SIZE = 84, TRIANGLE_SIZE = 50 };

typedef struct stl_reader {
    facet_scene *scene;
    const facet_scene_desc *desc;
    facet_error *error;
    obj_soup soup;
    obj_table table; /* positions, to merge equal ones */
} stl_reader;

/* ---- text ---- */

typedef struct words {
    const char *at, *end;
} words;

static bool is_space(char c)
{
    return c == ' ' || (c >= '\t' && c <= '\r');
}

/* The next word; *size 0: there is none. */
static const char *next_word(words *w, size_t *size)
{
    while (w->at < w->end && is_space(*w->at))
        w->at++;
    const char *word = w->at;
    while (w->at < w->end && !is_space(*w->at))
        w->at++;
    *size = (size_t)(w->at - word);
    return word;
}

static bool is_word(const char *word, size_t size, const char *wanted)
{
    return size == strlen(wanted) && strncasecmp(word, wanted, size) == 0;
}

static const char *line_end(const words *w)
{
    const char *p = w->at;
    while (p < w->end && *p != '\n' && *p != '\r')
        p++;
    return p;
}

static words begin_words(const void *bytes, size_t size)
{
    words w = {bytes, (const char *)bytes + size};
    if (size >= 3 && memcmp(bytes, "\xef\xbb\xbf", 3) == 0)
        w.at += 3;
    return w;
}

/* ---- detection ---- */

static uint32_t read_u32(const unsigned char *p)
{
    return (uint32_t)p[0] | (uint32_t)p[1] << 8 | (uint32_t)p[2] << 16 | (uint32_t)p[3] << 24;
}

static bool is_binary(const unsigned char *bytes, size_t size)
{
    return size >= HEADER_SIZE && (size - HEADER_SIZE) % TRIANGLE_SIZE == 0 &&
           (size - HEADER_SIZE) / TRIANGLE_SIZE == read_u32(bytes + 80);
}

/* "solid", the rest of whose line is a name, followed by a facet or the end. */
static bool is_text(const void *bytes, size_t size)
{
    words w = begin_words(bytes, size);
    size_t length;
    const char *word = next_word(&w, &length);
    if (!is_word(word, length, "solid"))
        return false;
    w.at = line_end(&w);
    word = next_word(&w, &length);
    return is_word(word, length, "facet") || is_word(word, length, "endsolid") ||
           is_word(word, length, "color");
}

bool stl_detect(const void *bytes, size_t size)
{
    return is_binary(bytes, size) || is_text(bytes, size);
}

/* ---- corners ---- */

/* A key that equal positions share, and others rarely. */
static obj_key key_of(const double place[3], uint32_t number)
{
    uint64_t hash = 0;
    for (int k = 0; k < 3; k++) {
        uint64_t bits;
        memcpy(&bits, &place[k], sizeof bits);
        hash = mix64(hash ^ bits);
    }
    return (obj_key){.v = (uint32_t)hash, .t = (uint32_t)(hash >> 32), .vertex = number};
}

/* Appends a corner, which shares an equal position if there is one. False: no memory. */
static bool add_corner(stl_reader *r, const double at[3])
{
    obj_soup *s = &r->soup;
    const double place[3] = {at[0] + 0.0, at[1] + 0.0, at[2] + 0.0}; /* -0 is 0 */
    uint32_t v = obj_table_find(&r->table, key_of(place, (uint32_t)s->place_count));
    if (v == UINT32_MAX || !mem_reserve(&r->desc->allocator, (void **)&s->v, &s->corner_capacity,
                                        s->corner_count + 1, sizeof *s->v))
        return false;
    if (v == s->place_count || memcmp(s->places + 3 * (size_t)v, place, sizeof place) != 0) {
        if (!mem_reserve(&r->desc->allocator, (void **)&s->places, &s->place_capacity, s->place_count + 1,
                         3 * sizeof *s->places))
            return false;
        v = (uint32_t)s->place_count;
        memcpy(s->places + 3 * s->place_count++, place, sizeof place);
    }
    s->v[s->corner_count++] = v;
    return true;
}

static bool add_part(stl_reader *r, const char *name, size_t size)
{
    obj_soup *s = &r->soup;
    if (!mem_reserve(&r->desc->allocator, (void **)&s->parts, &s->part_capacity, s->part_count + 1,
                     sizeof *s->parts))
        return false;
    s->parts[s->part_count++] = (obj_soup_part){.name = name, .name_size = size, .begin = s->corner_count};
    return true;
}

static facet_result fail_triangles(const stl_reader *r)
{
    return fail_memory(r->error, "triangles of an STL file", r->soup.corner_count * sizeof(uint32_t));
}

/* ---- binary ---- */

static double read_float(const unsigned char *p)
{
    uint32_t bits = read_u32(p);
    float x;
    memcpy(&x, &bits, sizeof x);
    return (double)x;
}

static facet_result read_binary(stl_reader *r, const unsigned char *bytes, size_t size)
{
    const char *source = r->scene->source;
    if (size < HEADER_SIZE)
        return fail(r->error, FACET_ERROR_INVALID,
                    "%s: is neither STL text, which begins with \"solid\", nor long enough for the "
                    "%d bytes before the triangles of a binary file",
                    source, (int)HEADER_SIZE);
    size_t there = (size - HEADER_SIZE) / TRIANGLE_SIZE;
    size_t claimed = read_u32(bytes + 80);
    if (claimed > there)
        scene_warn(r->scene, &r->desc->log, "%s: is cut off: %zu triangles were declared, %zu are there",
                   source, claimed, there);
    size_t count = claimed < there ? claimed : there;
    if (!add_part(r, "", 0))
        return fail_triangles(r);
    for (size_t i = 0; i < count; i++)
        for (size_t k = 0; k < 3; k++) {
            const unsigned char *p = bytes + HEADER_SIZE + TRIANGLE_SIZE * i + 12 + 12 * k;
            const double place[3] = {read_float(p), read_float(p + 4), read_float(p + 8)};
            if (!add_corner(r, place))
                return fail_triangles(r);
        }
    return FACET_OK;
}

/* ---- text ---- */

/* Three numbers. False: something else. */
static bool read_place(words *w, double place[3])
{
    for (int k = 0; k < 3; k++) {
        size_t size;
        const char *word = next_word(w, &size);
        const char *after;
        place[k] = codec_parse_number(word, word + size, &after);
        if (size == 0 || after != word + size)
            return false;
    }
    return true;
}

static size_t line_number(const void *bytes, const char *at)
{
    size_t line = 1;
    for (const char *p = bytes; p < at; p++)
        line += *p == '\n';
    return line;
}

/* The numbers of a vertex; a loop of more than three corners is a triangle fan. */
static facet_result read_vertex(stl_reader *r, words *w, const char *begin, size_t *in_loop)
{
    double place[3];
    obj_soup *s = &r->soup;
    const char *at = w->at;
    if (!read_place(w, place))
        return fail(r->error, FACET_ERROR_INVALID, "%s: line %zu: a vertex must have three numbers",
                    r->scene->source, line_number(begin, at));
    size_t first = s->corner_count - (*in_loop >= 3 ? 3 : *in_loop);
    if (!mem_reserve(&r->desc->allocator, (void **)&s->v, &s->corner_capacity, s->corner_count + 3,
                     sizeof *s->v))
        return fail_triangles(r);
    if (*in_loop >= 3) {
        s->v[s->corner_count] = s->v[first];
        s->v[s->corner_count + 1] = s->v[first + 2];
        s->corner_count += 2;
    }
    (*in_loop)++;
    return add_corner(r, place) ? FACET_OK : fail_triangles(r);
}

/* Removes the corners of a loop that has fewer than three. */
static void end_loop(stl_reader *r, size_t *in_loop, size_t *short_count)
{
    if (*in_loop > 0 && *in_loop < 3) {
        r->soup.corner_count -= *in_loop;
        (*short_count)++;
    }
    *in_loop = 0;
}

static facet_result read_text(stl_reader *r, const void *bytes, size_t size)
{
    words w = begin_words(bytes, size);
    size_t in_loop = 0;
    size_t short_count = 0;
    facet_result result = FACET_OK;
    while (result == FACET_OK) {
        size_t length;
        const char *word = next_word(&w, &length);
        if (length == 0)
            break;
        if (is_word(word, length, "vertex")) {
            result = r->soup.part_count || add_part(r, "", 0) ? read_vertex(r, &w, bytes, &in_loop)
                                                              : fail_triangles(r);
        } else if (is_word(word, length, "solid")) {
            end_loop(r, &in_loop, &short_count); /* an unfinished loop belongs to the previous solid */
            const char *end = line_end(&w);
            while (w.at < end && is_space(*w.at))
                w.at++;
            const char *last = end;
            while (last > w.at && is_space(last[-1]))
                last--;
            result = add_part(r, w.at, (size_t)(last - w.at)) ? FACET_OK : fail_triangles(r);
            w.at = end;
        } else if (is_word(word, length, "endsolid")) {
            w.at = line_end(&w);
        } else if (is_word(word, length, "loop") || is_word(word, length, "endloop") ||
                   is_word(word, length, "endfacet")) {
            end_loop(r, &in_loop, &short_count);
        }
    }
    end_loop(r, &in_loop, &short_count);
    if (short_count)
        scene_warn(r->scene, &r->desc->log, "%s: %zu facets have fewer than 3 vertices; they are left out",
                   r->scene->source, short_count);
    return result;
}

/* ---- the file ---- */

facet_result stl_load_memory(const void *bytes, size_t size, const char *name, const facet_scene_desc *desc,
                             facet_scene **scene, facet_error *error)
{
    const facet_scene_desc defaults = {0};
    stl_reader r = {.desc = desc ? desc : &defaults, .error = error};
    *scene = NULL;
    facet_result result = scene_create(&r.desc->allocator, name, &r.scene, error);
    if (result != FACET_OK)
        return result;
    r.scene->max_texture_size = r.desc->max_texture_size;
    r.scene->thread_count = r.desc->thread_count;
    r.soup = obj_soup_begin(r.scene, r.desc);
    r.table.allocator = &r.desc->allocator;
    if (!obj_table_reset(&r.table, 1024))
        result = fail_triangles(&r);
    if (result == FACET_OK)
        result = is_text(bytes, size) && !is_binary(bytes, size) ? read_text(&r, bytes, size)
                                                                 : read_binary(&r, bytes, size);
    obj_table_release(&r.table);
    if (result == FACET_OK)
        result = obj_soup_finish(&r.soup, error);
    obj_soup_release(&r.soup);
    if (result == FACET_OK)
        scene_note(r.scene, &r.desc->log,
                   "%s: STL names no unit and no upward axis; numbers are read as metres, with y up (--up z)",
                   name);
    if (result == FACET_OK)
        *scene = r.scene;
    else
        scene_destroy(r.scene);
    return result;
}
