/* mtl_statements.c - the text of MTL files (lines, words, numbers) and the statements of a material, by
 * tables (Alias| Wavefront, File Formats 4.2, section 5, and the PBR extension of 2015). Values stay as
 * they are written; invalid ones are clamped or ignored with a warning. */
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>

#include "image/codec.h"
#include "io/obj/mtl_parts.h"
#include "scene/legacy_extras.h"

/* ---- text ---- */

static bool is_blank(char c)
{
    return c == ' ' || c == '\t' || c == '\v' || c == '\f';
}

mtl_span mtl_trim(mtl_span s)
{
    while (s.begin < s.end && is_blank(*s.begin))
        s.begin++;
    while (s.begin < s.end && is_blank(s.end[-1]))
        s.end--;
    return s;
}

mtl_span mtl_next_word(mtl_span *rest)
{
    mtl_span word = mtl_trim(*rest);
    const char *end = word.begin;
    while (end < word.end && !is_blank(*end))
        end++;
    rest->begin = end;
    rest->end = word.end;
    word.end = end;
    return word;
}

bool mtl_is_word(mtl_span s, const char *word)
{
    size_t length = strlen(word);
    return mtl_length(s) == length && strncasecmp(s.begin, word, length) == 0;
}

bool mtl_to_number(mtl_span s, double *out)
{
    const char *after;
    *out = codec_parse_number(s.begin, s.end, &after);
    return after == s.end && isfinite(*out);
}

mtl_lines mtl_lines_begin(const facet_allocator *allocator, const void *bytes, size_t size)
{
    mtl_lines lines = {.at = bytes, .end = (const char *)bytes + size, .next = 1};
    if (allocator)
        lines.joined.allocator = *allocator;
    if (size >= 3 && memcmp(bytes, "\xef\xbb\xbf", 3) == 0) /* byte order mark */
        lines.at += 3;
    return lines;
}

/* The next line of the file without its end, which is LF, CR, both, or a 0. */
static mtl_span take_line(mtl_lines *lines)
{
    mtl_span line = {lines->at, lines->at};
    while (line.end < lines->end && *line.end != '\n' && *line.end != '\r' && *line.end != 0)
        line.end++;
    lines->at = line.end;
    if (lines->at < lines->end)
        lines->at += lines->end - lines->at >= 2 && lines->at[0] == '\r' && lines->at[1] == '\n' ? 2 : 1;
    lines->next++;
    return line;
}

/* A backslash at the end of a line continues it, except in comments, which may end in a Windows path. */
static bool is_continued(const mtl_lines *lines, mtl_span line)
{
    return line.end > line.begin && line.end[-1] == '\\' && lines->at < lines->end &&
           !(mtl_length(mtl_trim(line)) > 0 && *mtl_trim(line).begin == '#');
}

bool mtl_next_line(mtl_lines *lines, mtl_span *out)
{
    while (lines->at < lines->end && !lines->joined.has_failed) {
        lines->line = lines->next;
        mtl_span line = take_line(lines);
        if (is_continued(lines, line)) {
            lines->joined.length = 0;
            do {
                text_add_bytes(&lines->joined, line.begin, mtl_length(line) - 1);
                text_add(&lines->joined, " ");
                line = take_line(lines);
            } while (is_continued(lines, line));
            text_add_bytes(&lines->joined, line.begin, mtl_length(line));
            if (lines->joined.has_failed)
                return false;
            line = (mtl_span){lines->joined.data, lines->joined.data + lines->joined.length};
        }
        *out = mtl_trim(line);
        if (mtl_length(*out) > 0)
            return true;
    }
    return false;
}

/* ---- state ---- */

void mtl_warn(mtl_parser *p, const char *format, ...)
{
    char message[600];
    if (!p->scene)
        return;
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(message, sizeof message, format, arguments);
    va_end(arguments);
    scene_warn(p->scene, p->log, "%s: line %zu: %s", p->file, p->line, message);
}

const char *mtl_keep(mtl_parser *p, mtl_span s)
{
    char *copy = arena_alloc(p->arena, mtl_length(s) + 1, 1);
    if (!copy) {
        p->has_failed = true;
        return "";
    }
    memcpy(copy, s.begin, mtl_length(s));
    copy[mtl_length(s)] = 0;
    return copy;
}

mtl_draft mtl_draft_begin(const facet_allocator *allocator)
{
    mtl_draft draft = {.m = legacy_material_default()};
    if (allocator)
        draft.unknown.allocator = *allocator;
    return draft;
}

/* Keeps a statement without a counterpart, to be written again. */
static void keep_line(mtl_draft *draft, mtl_span line)
{
    text_add_bytes(&draft->unknown, line.begin, mtl_length(line));
    text_add(&draft->unknown, "\n");
}

/* For messages: at most 60 characters. */
#define SHOWN(s) (int)(mtl_length(s) < 60 ? mtl_length(s) : 60), (s).begin

/* ---- numbers and colors ---- */

/* One number in its range. The rest of the line is ignored: a comment, or numbers for other readers. */
static bool parse_number(mtl_parser *p, const char *keyword, mtl_span arguments, double least, double most,
                         float *out)
{
    mtl_span word = mtl_next_word(&arguments);
    double value;
    if (!mtl_to_number(word, &value)) {
        mtl_warn(p, "%s: \"%.*s\" is not a number; the statement is ignored", keyword, SHOWN(word));
        return false;
    }
    double clamped = value < least ? least : value > most ? most : value;
    if (clamped != value)
        mtl_warn(p, "%s: %g is not in [%g, %g]; %g is used", keyword, value, least, most, clamped);
    *out = (float)clamped;
    return true;
}

static void parse_parameter(mtl_parser *p, const legacy_parameter *row, mtl_span arguments, mtl_draft *draft)
{
    float values[3];
    if (row->count == 3
            ? mtl_parse_color(p, row->key, arguments, values)
            : parse_number(p, row->key, arguments, (double)row->minimum, (double)row->maximum, values)) {
        memcpy(legacy_floats(&draft->m, row), values, row->count * sizeof *values);
        draft->m.fields |= row->field;
    }
}

static const legacy_parameter *find_parameter(mtl_span keyword)
{
    for (size_t i = 0; i < LEGACY_PARAMETER_COUNT; i++)
        if (mtl_is_word(keyword, legacy_parameters[i].key))
            return &legacy_parameters[i];
    return NULL;
}

/* ---- the others ---- */

typedef struct special_row {
    const char *keyword;
    void (*parse)(mtl_parser *p, mtl_span line, mtl_span arguments, mtl_draft *draft);
} special_row;

static void parse_illum(mtl_parser *p, mtl_span line, mtl_span arguments, mtl_draft *draft)
{
    mtl_span word = mtl_next_word(&arguments);
    double value;
    (void)line;
    if (!mtl_to_number(word, &value) || value < 0.0 || value > 10.0 || value != (double)(int)value) {
        mtl_warn(p, "illum: \"%.*s\" is not one of 0, 1, .. 10; the statement is ignored", SHOWN(word));
        return;
    }
    draft->m.illum = (int)value;
    draft->m.fields |= LEGACY_ILLUM;
}

static void parse_dissolve(mtl_parser *p, mtl_span line, mtl_span arguments, mtl_draft *draft)
{
    mtl_span rest = arguments;
    (void)line;
    bool is_halo = mtl_is_word(mtl_next_word(&rest), "-halo");
    if (!parse_number(p, "d", is_halo ? rest : arguments, 0, 1, &draft->m.opacity))
        return;
    draft->m.is_halo = is_halo;
    draft->m.fields |= LEGACY_OPACITY;
    draft->has_d = true;
}

static void parse_transparency(mtl_parser *p, mtl_span line, mtl_span arguments, mtl_draft *draft)
{
    (void)line;
    draft->has_tr = parse_number(p, "Tr", arguments, 0, 1, &draft->tr) || draft->has_tr;
}

/* "Pe" is an alias of Ke in some programs; Ke has precedence. */
static void parse_emission(mtl_parser *p, mtl_span line, mtl_span arguments, mtl_draft *draft)
{
    bool is_ke = line.begin[0] == 'K' || line.begin[0] == 'k';
    if (draft->has_ke && !is_ke)
        return;
    static const char keyword[] = "Ke";
    parse_parameter(p, find_parameter((mtl_span){keyword, keyword + 2}), arguments, draft);
    draft->has_ke = is_ke && legacy_has(&draft->m, LEGACY_EMISSION);
}

static void parse_map_row(mtl_parser *p, const char *keyword, legacy_map_slot slot, mtl_span arguments,
                          mtl_draft *draft)
{
    legacy_map map;
    bool is_clamped;
    if (!mtl_parse_map(p, keyword, arguments, &map, &is_clamped))
        return;
    draft->m.maps[slot] = map;
    draft->is_clamped[slot] = is_clamped;
}

/* map_Tr is used without a map_d only; whether 0 or 1 is opaque differs between programs. */
static void parse_transparency_map(mtl_parser *p, mtl_span line, mtl_span arguments, mtl_draft *draft)
{
    (void)line;
    if (!draft->has_map_d)
        parse_map_row(p, "map_Tr", LEGACY_OPACITY_MAP, arguments, draft);
}

static void parse_opacity_map(mtl_parser *p, mtl_span line, mtl_span arguments, mtl_draft *draft)
{
    (void)line;
    parse_map_row(p, "map_d", LEGACY_OPACITY_MAP, arguments, draft);
    draft->has_map_d = draft->m.maps[LEGACY_OPACITY_MAP].path != NULL;
}

/* Six of them make a cube: the first is parsed, the others are kept as text. */
static void parse_reflection(mtl_parser *p, mtl_span line, mtl_span arguments, mtl_draft *draft)
{
    if (draft->m.maps[LEGACY_REFLECTION_MAP].path)
        keep_line(draft, line);
    else
        parse_map_row(p, "refl", LEGACY_REFLECTION_MAP, arguments, draft);
}

static void parse_orm(mtl_parser *p, mtl_span line, mtl_span arguments, mtl_draft *draft)
{
    bool is_rma = line.begin[4] == 'R' || line.begin[4] == 'r'; /* map_RMA */
    parse_map_row(p, is_rma ? "map_RMA" : "map_ORM", LEGACY_ORM_MAP, arguments, draft);
    draft->m.is_rma = is_rma && draft->m.maps[LEGACY_ORM_MAP].path;
}

/* Antialiasing of all maps: no counterpart. */
static void keep_statement(mtl_parser *p, mtl_span line, mtl_span arguments, mtl_draft *draft)
{
    (void)p;
    (void)arguments;
    keep_line(draft, line);
}

static void refuse_library(mtl_parser *p, mtl_span line, mtl_span arguments, mtl_draft *draft)
{
    (void)line;
    (void)arguments;
    (void)draft;
    mtl_warn(p, "mtllib is not a statement of an MTL file; no library is read");
}

static const special_row SPECIAL[] = {
    {"illum", parse_illum},
    {"d", parse_dissolve},
    {"Tr", parse_transparency},
    {"Ke", parse_emission},
    {"Pe", parse_emission},
    {"map_d", parse_opacity_map},
    {"map_Tr", parse_transparency_map},
    {"refl", parse_reflection},
    {"map_refl", parse_reflection},
    {"map_RMA", parse_orm},
    {"map_ORM", parse_orm},
    {"map_aat", keep_statement},
    {"mtllib", refuse_library},
};

/* Aliases of legacy_map_keys in some programs. */
static const struct {
    const char *keyword;
    legacy_map_slot slot;
} OTHER_MAPS[] = {
    {"bump", LEGACY_BUMP_MAP},       {"map_disp", LEGACY_DISPLACEMENT_MAP}, {"map_decal", LEGACY_DECAL_MAP},
    {"map_norm", LEGACY_NORMAL_MAP}, {"map_Pe", LEGACY_EMISSION_MAP},
};

/* The slot of a keyword; LEGACY_MAP_COUNT: not a map. */
static int find_slot(mtl_span keyword)
{
    for (int i = 0; i < LEGACY_MAP_COUNT; i++)
        if (mtl_is_word(keyword, legacy_map_keys[i]))
            return i;
    for (size_t i = 0; i < sizeof OTHER_MAPS / sizeof *OTHER_MAPS; i++)
        if (mtl_is_word(keyword, OTHER_MAPS[i].keyword))
            return (int)OTHER_MAPS[i].slot;
    return LEGACY_MAP_COUNT;
}

void mtl_parse_statement(mtl_parser *p, mtl_span line, mtl_draft *draft)
{
    mtl_span rest = line;
    mtl_span keyword = mtl_next_word(&rest);
    mtl_span arguments = mtl_trim(rest);
    for (size_t i = 0; i < sizeof SPECIAL / sizeof *SPECIAL; i++)
        if (mtl_is_word(keyword, SPECIAL[i].keyword)) {
            SPECIAL[i].parse(p, line, arguments, draft);
            return;
        }
    const legacy_parameter *row = find_parameter(keyword);
    int slot = find_slot(keyword);
    if (row)
        parse_parameter(p, row, arguments, draft);
    else if (slot < LEGACY_MAP_COUNT)
        parse_map_row(p, legacy_map_keys[slot], (legacy_map_slot)slot, arguments, draft);
    else
        keep_line(draft, line);
}

/* Tr is 1 - d in most programs, and d in some: only a matching d makes it unambiguous. */
static void settle_opacity(mtl_draft *draft)
{
    legacy_material *m = &draft->m;
    if (draft->has_tr) {
        float opacity = 1.0f - draft->tr;
        float difference = m->opacity - opacity;
        m->is_transparency_ambiguous = !draft->has_d || difference > 1e-3f || difference < -1e-3f;
        m->opacity = draft->has_d ? m->opacity : opacity;
        m->fields |= LEGACY_OPACITY;
    }
    if (m->maps[LEGACY_OPACITY_MAP].path && !draft->has_map_d)
        m->is_transparency_ambiguous = true;
}

void mtl_draft_end(mtl_parser *p, mtl_draft *draft)
{
    settle_opacity(draft);
    p->has_failed = p->has_failed || draft->unknown.has_failed;
    if (draft->unknown.length > 0 && !p->has_failed)
        draft->m.unknown =
            mtl_keep(p, (mtl_span){draft->unknown.data, draft->unknown.data + draft->unknown.length});
    text_destroy(&draft->unknown);
}
