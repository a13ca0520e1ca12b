/* obj_remarks.c - what was wrong with a file that was read all the same: one sentence per kind, with the first line. */
#include <stdio.h>

#include "base/text.h"
#include "io/obj/obj_parse.h"

void obj_note(obj_remarks *remarks, obj_remark remark, size_t offset)
{
    if (remarks->counts[remark]++ == 0)
        remarks->first[remark] = offset;
}

size_t obj_line_number(const char *bytes, size_t offset)
{
    size_t line = 1;
    for (size_t i = 0; i < offset; i++)
        line += bytes[i] == '\n' || (bytes[i] == '\r' && bytes[i + 1] != '\n');
    return line;
}

typedef enum place { AT_BYTE, AT_ELEMENT, NOWHERE } place;

/* The sentence behind "FILE: line N: ". */
static const struct {
    const char *sentence;
    place place; /* of remarks.first */
} REMARKS[OBJ_REMARK_COUNT] = {
    [OBJ_VERTEX_NOT_FINITE] = {"a vertex is not finite, or farther out than 1e17; it is not drawn", AT_BYTE},
    [OBJ_VERTEX_SHORT] = {"a vertex has fewer than 3 coordinates; the others are 0", AT_BYTE},
    [OBJ_TEXCOORD_NOT_FINITE] = {"a texture coordinate is not finite; it becomes 0", AT_BYTE},
    [OBJ_NOT_A_NUMBER] = {"something is no number; what of it is one is used", AT_BYTE},
    [OBJ_UNKNOWN_STATEMENT] = {"the statement is none of OBJ's; it is left out", AT_BYTE},
    [OBJ_FACE_WRONG] = {"an element names a vertex that is not there; it is left out", AT_ELEMENT},
    [OBJ_ATTRIBUTE_WRONG] =
        {"an element names a texture coordinate or normal that is not there; it does without", AT_ELEMENT},
    [OBJ_FACE_SHORT] = {"a face has fewer than 3 different corners, or a line fewer than 2; it is left out",
                        AT_ELEMENT},
    [OBJ_FACE_NOT_FINITE] = {"an element uses a vertex that is not finite; it is left out", AT_ELEMENT},
    [OBJ_NORMAL_ZERO] = {"a normal has no direction; another one is computed", AT_ELEMENT},
    [OBJ_TEXCOORD_MISSING] =
        {"some corners have no texture coordinates, others of the same material have; they get "
         "(0, 0)",
         NOWHERE},
    [OBJ_POLYGON_ROUGH] = {"a polygon has so many corners that it was cut into triangles roughly", NOWHERE},
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
    return obj_line_number(bytes, first);
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

/* One warning for all statements of a kind that there are. */
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

void obj_warn_all(obj_reader *r, const char *bytes)
{
    for (int i = 0; i < OBJ_REMARK_COUNT; i++)
        warn_remark(r, (obj_remark)i, bytes);
    warn_statements(r, true, "free-form curves and surfaces are not read, but polygons only; left out were");
    warn_statements(r, false, "statements that nothing here corresponds to are left out");
}
