/* mtl_color.c - colors of MTL files: RGB, CIE XYZ, or the spectrum of a reflectance in a file of its own. */
#include <math.h>
#include <string.h>

#include "image/cie.h"
#include "image/srgb.h"
#include "io/obj/mtl_parts.h"

/* ---- spectra ---- */

typedef struct spectrum {
    double *samples; /* wavelength in nm and value, wavelengths increasing */
    size_t count, capacity;
} spectrum;

/* Linear between samples, beyond them that of the nearest. */
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

/* The color of a reflectance in daylight, relative to that of a perfect white, which is 1 1 1. */
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

/* Pairs of wavelength and value, one per line; lines that are otherwise are comments or headings. False: no pair, or
 * wavelengths that do not increase. Wavelengths below 10 are in micrometres. */
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

/* What a file is the spectrum of. */
struct mtl_spectrum {
    double rgb[3];
    bool is_valid; /* false: the file is none */
};

void mtl_spectra_destroy(mtl_spectra *spectra)
{
    mem_free(spectra->list);
    index_table_release(&spectra->by_file);
}

/* The color of a file, parsed at most once. NULL: no memory. */
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
    mtl_next_word(&rest); /* the name; with spaces in it the factor is the last word still */
    for (mtl_span ahead = rest; mtl_length(mtl_trim(ahead)) > 0;) {
        mtl_span word = mtl_next_word(&ahead);
        double number;
        if (mtl_length(mtl_trim(ahead)) == 0 && mtl_to_number(word, &number)) {
            factor = number;
            name = mtl_trim((mtl_span){name.begin, word.begin});
        }
    }
    uri_bytes bytes = {.message = "there are no files here"};
    const char *file = mtl_keep(p, name);
    if (mtl_length(name) == 0 || !p->open || !p->open(p->user, file, &bytes)) {
        mtl_warn(p, "%s: the spectrum cannot be had: %.400s; the statement is ignored", keyword,
                 mtl_length(name) == 0 ? "names no file" : bytes.message);
        return false;
    }
    const struct mtl_spectrum *found = find_spectrum(p, &bytes);
    if (!found)
        return false;
    for (int i = 0; i < 3; i++)
        rgb[i] = found->rgb[i] * factor;
    if (!found->is_valid)
        mtl_warn(p, "%s: \"%.200s\" is no list of wavelengths and values; the statement is ignored", keyword,
                 file);
    return found->is_valid;
}

/* ---- statements ---- */

/* One number or three; of two the last counts for the third. */
static bool parse_triple(mtl_parser *p, const char *keyword, mtl_span arguments, double out[3])
{
    mtl_span rest = arguments;
    for (int i = 0; i < 3; i++) {
        mtl_span word = mtl_next_word(&rest);
        bool is_end = mtl_length(word) == 0 || *word.begin == '#';
        if (i > 0 && is_end) {
            out[i] = out[i - 1];
        } else if (!mtl_to_number(word, &out[i])) {
            mtl_warn(p, "%s: \"%.*s\" is no number; the statement is ignored", keyword,
                     (int)(mtl_length(word) < 60 ? mtl_length(word) : 60), word.begin);
            return false;
        }
    }
    return true;
}

/* Physical colors are linear; where the file's are sRGB, these become so too, to be treated alike. What is outside of
 * Rec.709 is clamped. */
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
