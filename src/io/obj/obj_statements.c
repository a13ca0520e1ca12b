/* obj_statements.c - statements by name: objects, groups, materials, points and lines, and unsupported
 * ones. Also detects OBJ files by their first statement. */
#include <string.h>

#include "io/obj/obj_parse.h"

typedef enum statement_kind {
    POSITION,
    TEXCOORD,
    NORMAL,
    FACE,
    LINE,
    POINT,
    OBJECT,
    GROUP,
    SMOOTHING,
    MATERIAL,
    LIBRARY,
    CURVED, /* free-form curves and surfaces */
    OTHER   /* display settings and the like */
} statement_kind;

static const struct {
    char name[12];
    statement_kind kind;
} STATEMENTS[] = {
    {"v", POSITION},      {"vt", TEXCOORD},      {"vn", NORMAL},       {"f", FACE},        {"fo", FACE},
    {"l", LINE},          {"p", POINT},          {"o", OBJECT},        {"g", GROUP},       {"s", SMOOTHING},
    {"usemtl", MATERIAL}, {"mtllib", LIBRARY},   {"vp", CURVED},       {"cstype", CURVED}, {"deg", CURVED},
    {"bmat", CURVED},     {"step", CURVED},      {"curv", CURVED},     {"curv2", CURVED},  {"surf", CURVED},
    {"parm", CURVED},     {"trim", CURVED},      {"hole", CURVED},     {"scrv", CURVED},   {"sp", CURVED},
    {"end", CURVED},      {"con", CURVED},       {"bzp", CURVED},      {"bsp", CURVED},    {"cdc", CURVED},
    {"cdp", CURVED},      {"res", CURVED},       {"ctech", CURVED},    {"stech", CURVED},  {"bevel", OTHER},
    {"c_interp", OTHER},  {"d_interp", OTHER},   {"lod", OTHER},       {"mg", OTHER},      {"usemap", OTHER},
    {"maplib", OTHER},    {"shadow_obj", OTHER}, {"trace_obj", OTHER}, {"call", OTHER},    {"csh", OTHER},
};
enum { STATEMENT_COUNT = sizeof STATEMENTS / sizeof *STATEMENTS };
_Static_assert(STATEMENT_COUNT <= 64, "obj_chunk.other_statements has a bit for each");

static char to_lower(char c)
{
    return c >= 'A' && c <= 'Z' ? (char)(c + ('a' - 'A')) : c;
}

/* The row of the statement whose name is length bytes at p, in any case; -1: unknown. */
static int find_statement(const char *p, size_t length)
{
    for (int i = 0; i < STATEMENT_COUNT; i++) {
        const char *name = STATEMENTS[i].name;
        size_t k = 0;
        while (k < length && name[k] && to_lower(p[k]) == name[k])
            k++;
        if (k == length && !name[k])
            return i;
    }
    return -1;
}

const char *obj_statement_name(unsigned bit, bool *is_geometry)
{
    if (bit >= STATEMENT_COUNT)
        return NULL;
    *is_geometry = STATEMENTS[bit].kind == CURVED;
    return STATEMENTS[bit].name;
}

bool obj_detect(const void *bytes, size_t size)
{
    const char *start = bytes;
    size_t i = size >= 3 && memcmp(start, "\xef\xbb\xbf", 3) == 0 ? 3 : 0;
    for (; i < size; i++) {
        if (start[i] == '#')
            while (i < size && !obj_is_line_end(start[i]))
                i++;
        else if (!obj_is_blank(start[i]) && !obj_is_line_end(start[i]))
            break;
    }
    size_t length = 0;
    while (length < sizeof STATEMENTS->name && i + length < size && !obj_is_blank(start[i + length]) &&
           !obj_is_line_end(start[i + length]))
        length++;
    return length > 0 && find_statement(start + i, length) >= 0;
}

/* Whether a line is a statement of that name with a number after it. */
static bool is_numbers(const char *line, const char *end, char name)
{
    if (end - line < 3 || line[0] != name || !obj_is_blank(line[1]))
        return false;
    for (line++; line < end && obj_is_blank(*line);)
        line++;
    line += line < end && (*line == '-' || *line == '+');
    line += line < end && *line == '.';
    return line < end && *line >= '0' && *line <= '9';
}

bool obj_has_faces(const void *bytes, size_t size)
{
    const char *p = bytes;
    const char *end = p + size;
    bool has_vertex = false;
    bool has_element = false;
    while (p < end && !(has_vertex && has_element)) {
        const char *line = p;
        while (p < end && !obj_is_line_end(*p))
            p++;
        while (line < p && obj_is_blank(*line))
            line++;
        has_vertex |= is_numbers(line, p, 'v');
        has_element |= is_numbers(line, p, 'f') || is_numbers(line, p, 'l') || is_numbers(line, p, 'p');
        p++;
    }
    return has_vertex && has_element;
}

/* ---- arguments ---- */

const char *obj_skip_statement(const char *p)
{
    while (!obj_is_line_end(*p)) {
        const char *behind = *p == '\\' ? obj_skip_continuation(p) : p;
        p = behind == p ? p + 1 : behind;
    }
    return p;
}

static const char *add_name(obj_chunk *c, const char *p, obj_event_kind kind,
                            const facet_allocator *allocator)
{
    p = obj_skip_blanks(p);
    const char *end = obj_skip_statement(p);
    const char *last = end;
    while (last > p && obj_is_blank(last[-1]))
        last--;
    obj_add_event(c, (obj_event){.kind = kind, .text = p, .length = (uint32_t)(last - p)}, allocator);
    c->has_object |= kind == OBJ_OBJECT;
    return end;
}

/* A number, or off; anything else counts as on. Bits beyond the 32nd are lost. */
static const char *add_smoothing(obj_chunk *c, const char *p, const facet_allocator *allocator)
{
    p = obj_skip_blanks(p);
    const char *end = obj_skip_word(p);
    uint32_t group = 0;
    bool is_number = end > p;
    for (const char *q = p; q < end; q++) {
        is_number &= *q >= '0' && *q <= '9';
        group = is_number ? 10u * group + (uint32_t)(*q - '0') : group;
    }
    bool is_off = end == p || (end - p == 3 && to_lower(p[0]) == 'o' && to_lower(p[1]) == 'f');
    group = is_number ? group : is_off ? 0 : 1;
    obj_add_event(c, (obj_event){.kind = OBJ_SMOOTHING, .value = group}, allocator);
    c->has_smoothing = true;
    return obj_skip_statement(end);
}

static int hex_digit(char c)
{
    c = to_lower(c);
    return c >= '0' && c <= '9' ? c - '0' : c >= 'a' && c <= 'f' ? c - 'a' + 10 : -1;
}

/* A comment; those of ZBrush contain colors, MMRRGGBB per position. */
static const char *read_comment(obj_chunk *c, const char *p, const facet_allocator *allocator)
{
    if (strncmp(p, "#MRGB ", 6) == 0) {
        for (p += 6;;) {
            uint32_t value = 0;
            int digits = 0;
            for (; digits < 8 && hex_digit(p[digits]) >= 0; digits++)
                value = value << 4 | (uint32_t)hex_digit(p[digits]);
            if (digits < 8 ||
                (c->mrgb.count == c->mrgb.capacity && !obj_indices_grow(c, &c->mrgb, allocator)))
                break;
            c->mrgb.data[c->mrgb.count++] = value;
            p += 8;
        }
    }
    while (!obj_is_line_end(*p)) /* no continuation here: Windows paths may end with a backslash */
        p++;
    return p;
}

const char *obj_parse_statement(obj_chunk *c, const char *p, const facet_allocator *allocator)
{
    if (*p == '#')
        return read_comment(c, p, allocator);
    const char *end = obj_skip_word(p);
    int row = find_statement(p, (size_t)(end - p));
    if (row < 0) {
        obj_note(&c->remarks, OBJ_UNKNOWN_STATEMENT, c->offset + (size_t)(p - c->text));
        return obj_skip_statement(end);
    }
    c->has_statement = true;
    switch (STATEMENTS[row].kind) {
    case POSITION:
        return obj_read_vertex(c, end, 0, allocator);
    case TEXCOORD:
        return obj_read_vertex(c, end, 't', allocator);
    case NORMAL:
        return obj_read_vertex(c, end, 'n', allocator);
    case FACE:
        return obj_read_element(c, end, SCENE_TRIANGLES, allocator);
    case LINE:
        return obj_read_element(c, end, SCENE_LINES, allocator);
    case POINT:
        return obj_read_element(c, end, SCENE_POINTS, allocator);
    case OBJECT:
        return add_name(c, end, OBJ_OBJECT, allocator);
    case GROUP:
        return add_name(c, end, OBJ_GROUP, allocator);
    case MATERIAL:
        return add_name(c, end, OBJ_MATERIAL, allocator);
    case LIBRARY:
        return add_name(c, end, OBJ_LIBRARY, allocator);
    case SMOOTHING:
        return add_smoothing(c, end, allocator);
    case CURVED:
    case OTHER:
        break;
    }
    if (c->other_statements == 0)
        c->first_other = c->offset + (size_t)(p - c->text);
    c->other_statements |= (uint64_t)1 << row;
    return obj_skip_statement(end);
}
