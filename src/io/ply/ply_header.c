/* ply_header.c - the header of a PLY file: lines of text up to "end_header". */
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "io/ply/ply_reader.h"

enum { MOST_ELEMENTS = 64, MOST_PROPERTIES = 1024, MOST_LINES = 100000 };

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

/* The next line, whose end is LF, CR or both. False: the file ends within it. */
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
                 "format \"%.*s\" is none of ascii, binary_little_endian and binary_big_endian", SHOWN(word));
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
    if (!is_number || r->element_count == MOST_ELEMENTS) {
        ply_fail(r, FACET_ERROR_INVALID,
                 "element \"%.*s\": a number of elements was expected, %d kinds at most", SHOWN(name),
                 (int)MOST_ELEMENTS);
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
    if (!e || !is_count || p.type == PLY_NONE || name.at == name.end ||
        e->property_count == MOST_PROPERTIES) {
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

/* MeshLab names its texture in a comment; the first counts. */
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

bool ply_read_header(ply_reader *r)
{
    span line;
    bool has_format = false;
    if (!take_line(r, &line))
        return ply_fail(r, FACET_ERROR_INVALID, "is cut off in its header");
    for (int i = 0; r->result == FACET_OK; i++) {
        if (i == MOST_LINES || !take_line(r, &line))
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
                            "\"%.*s\" is no line of a header; element, property, comment or "
                            "end_header was expected",
                            SHOWN(word));
        has_format |= is_word(word, "format");
    }
    if (r->result == FACET_OK && !has_format)
        return ply_fail(r, FACET_ERROR_INVALID, "its header has no format");
    return r->result == FACET_OK;
}
