/* mtl_values.c - the arguments of statements: colors, and maps with their options.
 *
 * A color is RGB, CIE XYZ, or the spectrum of a reflectance in a file of its own. The name of a map may
 * contain spaces and have options behind it; -o and -s translate and scale texture coordinates in MTL's
 * system, whose v points up:
 *     u' = s_u u + o_u,  v' = s_v v + o_v
 * glTF's v points down, w = 1 - v, so that
 *     w' = 1 - v' = 1 - (s_v (1 - w) + o_v) = s_v w + (1 - s_v - o_v)
 * and the offset along v becomes 1 - s_v - o_v, the scale stays. Where the file's own v points down already
 * (has_flipped_texcoords), its formula is glTF's. */
#include <math.h>
#include <stddef.h>
#include <string.h>

#include "image/primaries.h"
#include "image/srgb.h"
#include "io/obj/mtl_parts.h"

/* ---- colors ---- */

/* ---- spectra ---- */

typedef struct spectrum {
    double *samples; /* wavelength in nm and value, wavelengths increasing */
    size_t count, capacity;
} spectrum;

/* Linear interpolation between samples, constant beyond them. */
static double spectrum_at(const spectrum *s, double nm)
{
    size_t i = 0;
    while (i < s->count && s->samples[2 * i] < nm)
        i++;
    if (i == 0 || i == s->count)
        return s->samples[2 * (i == 0 ? 0 : s->count - 1) + 1];
    const double *a = &s->samples[2 * i - 2];
    return a[1] + (a[3] - a[1]) * (nm - a[0]) / (a[2] - a[0]);
}

/* The color of a reflectance in daylight, relative to a perfect white of 1 1 1. */
static void color_of_reflectance(const spectrum *s, double rgb[3])
{
    double sum[3] = {0, 0, 0};
    double white[3] = {0, 0, 0};
    double white_rgb[3];
    for (int i = 0; i < CIE_D65_COUNT; i++) {
        double nm = CIE_D65_FIRST + CIE_D65_STEP * i;
        double xyz[3];
        cie_match_color(nm, xyz);
        for (int k = 0; k < 3; k++) {
            sum[k] += xyz[k] * cie_d65[i] * spectrum_at(s, nm);
            white[k] += xyz[k] * cie_d65[i];
        }
    }
    cie_rec709_from_xyz(sum, rgb);
    cie_rec709_from_xyz(white, white_rgb);
    for (int k = 0; k < 3; k++)
        rgb[k] /= white_rgb[k];
}

/* Parses pairs of wavelength and value, one per line; other lines are comments or headings. False: no
 * pair, or wavelengths that do not increase. Wavelengths below 10 are in micrometers. */
static bool read_spectrum(mtl_parser *p, const uri_bytes *bytes, spectrum *out)
{
    mtl_lines lines = mtl_lines_begin(p->allocator, bytes->data, bytes->size);
    mtl_span line;
    bool is_increasing = true;
    while (mtl_next_line(&lines, &line) && is_increasing) {
        double nm;
        double value;
        if (!mtl_to_number(mtl_next_word(&line), &nm) || !mtl_to_number(mtl_next_word(&line), &value))
            continue;
        nm = nm < 10.0 ? nm * 1000.0 : nm;
        if (!mem_reserve(p->allocator, (void **)&out->samples, &out->capacity, out->count + 1,
                         2 * sizeof *out->samples)) {
            p->has_failed = true;
            break;
        }
        is_increasing = out->count == 0 || nm > out->samples[2 * out->count - 2];
        out->samples[2 * out->count] = nm;
        out->samples[2 * out->count + 1] = value;
        out->count++;
    }
    p->has_failed = p->has_failed || lines.joined.has_failed;
    text_destroy(&lines.joined);
    return is_increasing && out->count > 0 && !p->has_failed;
}

/* The spectrum of a file. */
struct mtl_spectrum {
    double rgb[3];
    bool is_valid; /* false: not a spectrum */
};

void mtl_spectra_destroy(mtl_spectra *spectra)
{
    mem_free(spectra->list);
    index_table_release(&spectra->by_file);
}

/* The color of a file, which is parsed at most once. NULL: no memory. */
static const struct mtl_spectrum *find_spectrum(mtl_parser *p, const uri_bytes *bytes)
{
    mtl_spectra *all = p->spectra;
    uint32_t there = index_table_find(&all->by_file, bytes->file);
    if (there != INDEX_TABLE_NONE)
        return &all->list[there];
    spectrum s = {0};
    struct mtl_spectrum new = {.is_valid = read_spectrum(p, bytes, &s)};
    if (new.is_valid)
        color_of_reflectance(&s, new.rgb);
    mem_free(s.samples);
    p->has_failed =
        p->has_failed ||
        !mem_reserve(p->allocator, (void **)&all->list, &all->capacity, all->count + 1, sizeof *all->list) ||
        !index_table_add(&all->by_file, p->allocator, bytes->file, (uint32_t)all->count);
    if (p->has_failed)
        return NULL;
    all->list[all->count] = new;
    return &all->list[all->count++];
}

/* spectral file.rfl [factor] */
static bool parse_spectral(mtl_parser *p, const char *keyword, mtl_span arguments, double rgb[3])
{
    mtl_span name = mtl_trim(arguments);
    mtl_span rest = arguments;
    double factor = 1.0;
    mtl_next_word(&rest); /* the name; if it contains spaces, the factor is still the last word */
    for (mtl_span ahead = rest; mtl_length(mtl_trim(ahead)) > 0;) {
        mtl_span word = mtl_next_word(&ahead);
        double number;
        if (mtl_length(mtl_trim(ahead)) == 0 && mtl_to_number(word, &number)) {
            factor = number;
            name = mtl_trim((mtl_span){name.begin, word.begin});
        }
    }
    uri_bytes bytes = {.message = "the model was not read from a folder"};
    const char *file = mtl_keep(p, name);
    if (mtl_length(name) == 0 || !p->open || !p->open(p->user, file, &bytes)) {
        mtl_warn(p, "%s: the spectrum cannot be read: %.400s; the statement is ignored", keyword,
                 mtl_length(name) == 0 ? "names no file" : bytes.message);
        return false;
    }
    const struct mtl_spectrum *found = find_spectrum(p, &bytes);
    if (!found)
        return false;
    for (int i = 0; i < 3; i++)
        rgb[i] = found->rgb[i] * factor;
    if (!found->is_valid)
        mtl_warn(p, "%s: \"%.200s\" is not a list of wavelengths and values; the statement is ignored",
                 keyword, file);
    return found->is_valid;
}

/* ---- statements ---- */

/* One number or three; the second of two is repeated. */
static bool parse_triple(mtl_parser *p, const char *keyword, mtl_span arguments, double out[3])
{
    mtl_span rest = arguments;
    for (int i = 0; i < 3; i++) {
        mtl_span word = mtl_next_word(&rest);
        bool is_end = mtl_length(word) == 0 || *word.begin == '#';
        if (i > 0 && is_end) {
            out[i] = out[i - 1];
        } else if (!mtl_to_number(word, &out[i])) {
            mtl_warn(p, "%s: \"%.*s\" is not a number; the statement is ignored", keyword,
                     (int)(mtl_length(word) < 60 ? mtl_length(word) : 60), word.begin);
            return false;
        }
    }
    return true;
}

/* Physical colors are linear; if those of the file are sRGB, they are encoded to match. Components outside
 * of Rec.709 are clamped. */
static void encode(const mtl_parser *p, const double linear[3], double out[3])
{
    for (int i = 0; i < 3; i++) {
        double x = fmax(linear[i], 0.0);
        out[i] = p->has_srgb_colors && x < 1.0 ? srgb_encode(x) : x;
    }
}

bool mtl_parse_color(mtl_parser *p, const char *keyword, mtl_span arguments, float out[3])
{
    mtl_span rest = arguments;
    mtl_span first = mtl_next_word(&rest);
    double values[3];
    double linear[3];
    if (mtl_is_word(first, "spectral")) {
        if (!parse_spectral(p, keyword, rest, linear))
            return false;
        encode(p, linear, values);
    } else if (mtl_is_word(first, "xyz")) {
        if (!parse_triple(p, keyword, rest, values))
            return false;
        cie_rec709_from_xyz(values, linear);
        encode(p, linear, values);
    } else if (!parse_triple(p, keyword, arguments, values)) {
        return false;
    }
    bool is_clamped = false;
    for (int i = 0; i < 3; i++) {
        is_clamped = is_clamped || values[i] < 0.0 || values[i] > (double)LEGACY_LARGEST;
        out[i] = (float)fmin(fmax(values[i], 0.0), (double)LEGACY_LARGEST);
    }
    if (is_clamped)
        mtl_warn(p, "%s: has components below 0 or above %g; they are clamped", keyword,
                 (double)LEGACY_LARGEST);
    return true;
}

/* The values of the options. */
typedef struct map_options {
    text all, dropped; /* dropped: options without a counterpart */
    double offset[3], scale[3], turbulence[3];
    double base_gain[2], bump_multiplier[1];
    bool is_clamped;
    char channel;
} map_options;

/* ---- the options ---- */

typedef enum option_kind { OPTION_NUMBERS, OPTION_SWITCH, OPTION_WORD } option_kind;

typedef struct option_row {
    const char *name;
    option_kind kind;
    size_t least, most;  /* numbers */
    size_t offset;       /* index of the first number in map_options; 0: the option is dropped */
    const char *neutral; /* value with which it is dropped without loss; NULL: never */
} option_row;

static const option_row OPTIONS[] = {
    {"-o", OPTION_NUMBERS, 1, 3, offsetof(map_options, offset), NULL},
    {"-s", OPTION_NUMBERS, 1, 3, offsetof(map_options, scale), NULL},
    {"-t", OPTION_NUMBERS, 1, 3, offsetof(map_options, turbulence), NULL},
    {"-mm", OPTION_NUMBERS, 2, 2, offsetof(map_options, base_gain), NULL},
    {"-bm", OPTION_NUMBERS, 1, 1, offsetof(map_options, bump_multiplier), NULL},
    {"-boost", OPTION_NUMBERS, 1, 1, 0, "0"},
    {"-texres", OPTION_NUMBERS, 1, 1, 0, NULL},
    {"-blendu", OPTION_SWITCH, 0, 0, 0, "on"},
    {"-blendv", OPTION_SWITCH, 0, 0, 0, "on"},
    {"-cc", OPTION_SWITCH, 0, 0, 0, "off"},
    {"-clamp", OPTION_SWITCH, 0, 0, offsetof(map_options, is_clamped), NULL},
    {"-imfchan", OPTION_WORD, 0, 0, offsetof(map_options, channel), NULL},
    {"-type", OPTION_WORD, 0, 0, 0, NULL},
};

static const option_row *find_option(mtl_span word)
{
    for (size_t i = 0; i < sizeof OPTIONS / sizeof *OPTIONS; i++)
        if (mtl_is_word(word, OPTIONS[i].name))
            return &OPTIONS[i];
    return NULL;
}

static void add_words(text *t, mtl_span s)
{
    if (t->length > 0)
        text_add(t, " ");
    text_add_bytes(t, s.begin, mtl_length(s));
}

/* The numbers of an option, at least row->least; missing ones keep their defaults. */
static bool take_numbers(const option_row *row, mtl_span *rest, map_options *out)
{
    double values[3] = {0, 0, 0};
    size_t count = 0;
    mtl_span ahead = *rest;
    while (count < row->most && mtl_to_number(mtl_next_word(&ahead), &values[count])) {
        values[count] = fmax(-(double)LEGACY_LARGEST, fmin(values[count], (double)LEGACY_LARGEST));
        count++;
        *rest = ahead;
    }
    if (count < row->least)
        return false;
    if (row->offset)
        memcpy((char *)out + row->offset, values, count * sizeof *values);
    return true;
}

static bool take_switch(const option_row *row, mtl_span *rest, map_options *out)
{
    mtl_span ahead = *rest;
    mtl_span word = mtl_next_word(&ahead);
    bool is_on = mtl_is_word(word, "on");
    if (!is_on && !mtl_is_word(word, "off"))
        return false;
    if (row->offset)
        *(bool *)((char *)out + row->offset) = is_on;
    *rest = ahead;
    return true;
}

static bool take_word(const option_row *row, mtl_span *rest, map_options *out)
{
    mtl_span ahead = *rest;
    mtl_span word = mtl_next_word(&ahead);
    if (row->offset) {
        if (mtl_length(word) != 1 || !strchr("rgbmlzRGBMLZ", *word.begin))
            return false;
        *((char *)out + row->offset) = (char)(*word.begin | 0x20);
    } else if (mtl_length(word) == 0) {
        return false;
    }
    *rest = ahead;
    return true;
}

/* Takes an option with its values off the front. False: there is none, or it lacks its values. */
static bool take_option(mtl_span *rest, map_options *out)
{
    mtl_span ahead = *rest;
    mtl_span name = mtl_next_word(&ahead);
    const option_row *row = find_option(name);
    mtl_span before = ahead;
    if (!row || !(row->kind == OPTION_NUMBERS  ? take_numbers(row, &ahead, out)
                  : row->kind == OPTION_SWITCH ? take_switch(row, &ahead, out)
                                               : take_word(row, &ahead, out)))
        return false;
    mtl_span values = mtl_trim((mtl_span){before.begin, ahead.begin});
    mtl_span whole = {name.begin, values.end};
    add_words(&out->all, whole);
    bool is_turbulent = row->offset == offsetof(map_options, turbulence) &&
                        (out->turbulence[0] != 0.0 || out->turbulence[1] != 0.0 || out->turbulence[2] != 0.0);
    bool has_depth = (row->offset == offsetof(map_options, offset) && out->offset[2] != 0.0) ||
                     (row->offset == offsetof(map_options, scale) && out->scale[2] != 1.0);
    if (is_turbulent || has_depth || (!row->offset && !(row->neutral && mtl_is_word(values, row->neutral))))
        add_words(&out->dropped, whole);
    *rest = ahead;
    return true;
}

static void map_options_begin(const mtl_parser *p, map_options *o)
{
    *o = (map_options){.scale = {1, 1, 1}, .base_gain = {0, 1}, .bump_multiplier = {1}};
    if (p->allocator)
        o->dropped.allocator = o->all.allocator = *p->allocator;
}

/* Applies the options to the map. */
static void map_options_end(mtl_parser *p, map_options *o, legacy_map *map, bool *is_clamped)
{
    scene_texture_ref *ref = &map->ref;
    ref->offset[0] = (float)o->offset[0];
    ref->scale[0] = (float)o->scale[0];
    ref->scale[1] = (float)o->scale[1];
    ref->offset[1] = (float)(p->has_flipped_texcoords ? o->offset[1] : 1.0 - o->scale[1] - o->offset[1]);
    scene_texture_ref_update(ref);
    map->base = (float)o->base_gain[0];
    map->gain = (float)o->base_gain[1];
    map->bump_multiplier = (float)o->bump_multiplier[0];
    map->channel = o->channel;
    *is_clamped = o->is_clamped;
    p->has_failed = p->has_failed || o->all.has_failed || o->dropped.has_failed;
    if (!p->has_failed && o->all.length)
        map->options = mtl_keep(p, (mtl_span){o->all.data, o->all.data + o->all.length});
    if (!p->has_failed && o->dropped.length)
        map->dropped = mtl_keep(p, (mtl_span){o->dropped.data, o->dropped.data + o->dropped.length});
    text_destroy(&o->all);
    text_destroy(&o->dropped);
}

void mtl_parse_options(mtl_parser *p, const char *options, legacy_map *map, bool *is_clamped)
{
    map_options o;
    mtl_span rest = {options, options + strlen(options)};
    map_options_begin(p, &o);
    while (take_option(&rest, &o))
        continue;
    map_options_end(p, &o, map, is_clamped);
}

/* ---- the name ---- */

/* Whether s consists of options only. */
static bool is_all_options(const mtl_parser *p, mtl_span s)
{
    map_options scratch;
    map_options_begin(p, &scratch);
    while (take_option(&s, &scratch))
        continue;
    text_destroy(&scratch.all);
    text_destroy(&scratch.dropped);
    return mtl_length(mtl_trim(s)) == 0;
}

/* A comment behind a name starts with a blank: "a#1.png" is a name. */
static mtl_span cut_comment(mtl_span s)
{
    for (const char *c = s.begin; c + 1 < s.end; c++)
        if ((c[0] == ' ' || c[0] == '\t') && c[1] == '#')
            return mtl_trim((mtl_span){s.begin, c});
    return s;
}

enum { MAX_TRIES = 16 }; /* each try may parse the whole rest of the line */

/* A name in quotes, which may itself contain quotes: up to one that is followed by options or a comment
 * only. False: there is none. */
static bool take_quoted(const mtl_parser *p, mtl_span *s, mtl_span *name)
{
    mtl_span all = mtl_trim(*s);
    if (mtl_length(all) < 2 || *all.begin != '"')
        return false;
    int tries = 0;
    for (const char *c = all.begin + 1; c < all.end && tries < MAX_TRIES; c++) {
        if (*c != '"')
            continue;
        mtl_span rest = mtl_trim((mtl_span){c + 1, all.end});
        if (mtl_length(rest) == 0 || *rest.begin == '#' || is_all_options(p, rest)) {
            *name = (mtl_span){all.begin + 1, c};
            *s = rest;
            return true;
        }
        tries++;
    }
    return false;
}

/* The name at the front of s: in quotes, or up to where only options follow. Advances *s. */
static mtl_span take_name(const mtl_parser *p, mtl_span *s)
{
    mtl_span name;
    if (take_quoted(p, s, &name))
        return name;
    mtl_span all = cut_comment(mtl_trim(*s));
    int tries = 0;
    mtl_span rest = all;
    while (mtl_length(mtl_trim(rest)) > 0 && tries < MAX_TRIES) {
        mtl_span before = mtl_trim(rest);
        mtl_span word = mtl_next_word(&rest);
        bool is_option = word.begin > all.begin && find_option(word);
        tries += is_option;
        if (is_option && is_all_options(p, before)) {
            *s = before;
            return mtl_trim((mtl_span){all.begin, word.begin});
        }
    }
    *s = (mtl_span){all.end, all.end};
    return all;
}

bool mtl_parse_map(mtl_parser *p, const char *keyword, mtl_span arguments, legacy_map *map, bool *is_clamped)
{
    map_options o;
    mtl_span rest = mtl_trim(arguments);
    *map = legacy_map_default();
    map_options_begin(p, &o);
    while (mtl_length(rest) > 0 && *rest.begin == '-') {
        mtl_span word = rest;
        if (!take_option(&rest, &o)) {
            mtl_span name = mtl_next_word(&word);
            if (!find_option(name) || mtl_length(mtl_trim(word)) == 0)
                break; /* the file may be named -something */
            mtl_warn(p, "%s: %.*s lacks its value; it is ignored", keyword, (int)mtl_length(name),
                     name.begin);
            rest = word;
        }
        rest = mtl_trim(rest);
    }
    mtl_span name = mtl_trim(take_name(p, &rest));
    while (take_option(&rest, &o))
        continue;
    if (mtl_length(name) == 0)
        mtl_warn(p, "%s: names no file; the statement is ignored", keyword);
    else
        map->path = mtl_keep(p, name);
    map_options_end(p, &o, map, is_clamped);
    return map->path != NULL;
}
