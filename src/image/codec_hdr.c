/* codec_hdr.c - Radiance images: RGBE texels, flat or run-length coded, with scanlines in any direction.
 * Format: Ward 1991, "Real Pixels" (Graphics Gems II); Radiance file formats, "picture". */
#include "image/codec.h"

#include <ctype.h>
#include <math.h>
#include <stdatomic.h>
#include <stdio.h>
#include <string.h>

#include "base/memory.h"
#include "base/parallel.h"
#include "base/result.h"
#include "image/half.h"
#include "image/primaries.h"

enum { MIN_CODED_LENGTH = 8, MAX_CODED_LENGTH = 0x7fff }; /* scanlines that may be coded by component */

/* The header. Texel t of scanline s is at (x, y) = origin + s * scan_step + t * texel_step. */
typedef struct hdr_header {
    uint32_t width, height;
    uint32_t scan_count, scan_length;
    bool is_x_first;            /* scanlines are columns */
    bool is_x_falling, is_y_up; /* relative to left to right, top to bottom */
    bool is_plain;              /* exactly four bytes per texel, without runs */
    double exposure[3]; /* product of all EXPOSURE and COLORCORR lines, by which texels were multiplied */
    bool has_primaries;
    primaries primaries; /* NaN if the line does not hold eight numbers */
    const unsigned char *data;
    size_t data_size;
} hdr_header;

/* ---- header ---- */

/* The next line without its end (LF or CR LF); false: no further newline. */
static bool next_line(const unsigned char **p, const unsigned char *end, const char **line, size_t *length)
{
    const unsigned char *newline = memchr(*p, '\n', (size_t)(end - *p));
    if (!newline)
        return false;
    *line = (const char *)*p;
    *length = (size_t)(newline - *p);
    if (*length > 0 && (*line)[*length - 1] == '\r')
        --*length;
    *p = newline + 1;
    return true;
}

static bool starts_with(const char *line, size_t length, const char *prefix)
{
    size_t n = strlen(prefix);
    return length >= n && memcmp(line, prefix, n) == 0;
}

/* Parses one axis of the resolution line, such as "-Y 512", and advances *line. Numbers have 1 to 9 digits. */
static bool parse_axis(const char **line, const char *end, char *sign, char *axis, uint32_t *count)
{
    const char *p = *line;
    while (p < end && *p == ' ')
        p++;
    if (end - p < 3 || (p[0] != '-' && p[0] != '+') || (p[1] != 'X' && p[1] != 'Y') || p[2] != ' ')
        return false;
    *sign = p[0];
    *axis = p[1];
    p += 3;
    while (p < end && *p == ' ')
        p++;
    const char *digits = p;
    for (*count = 0; p < end && isdigit((unsigned char)*p) && p - digits < 9; p++)
        *count = *count * 10 + (uint32_t)(*p - '0');
    *line = p;
    return p > digits && (p == end || *p == ' ');
}

static bool parse_resolution(const char *line, size_t length, hdr_header *h)
{
    const char *end = line + length;
    char sign[2], axis[2];
    uint32_t count[2];
    if (!parse_axis(&line, end, &sign[0], &axis[0], &count[0]) ||
        !parse_axis(&line, end, &sign[1], &axis[1], &count[1]) || axis[0] == axis[1])
        return false;
    while (line < end && *line == ' ')
        line++;
    if (line != end)
        return false;
    h->is_x_first = axis[0] == 'X';
    int x = h->is_x_first ? 0 : 1;
    h->width = count[x];
    h->height = count[1 - x];
    h->is_x_falling = sign[x] == '-';
    h->is_y_up = sign[1 - x] == '+';
    h->scan_count = count[0];
    h->scan_length = count[1];
    return true;
}

/* Multiplies h->exposure by the value of a line: one number, or three for COLORCORR. */
static facet_result parse_exposure(const char *line, size_t length, bool is_color, const char *name,
                                   hdr_header *h, facet_error *error)
{
    const char *end = line + length;
    const char *number = (const char *)memchr(line, '=', length) + 1;
    double factor = 1.0;
    for (int c = 0; c < 3; c++) {
        while (number < end && *number == ' ')
            number++;
        if (c == 0 || is_color)
            factor = codec_parse_number(number, end, &number);
        h->exposure[c] *= factor;
        if (!(h->exposure[c] > 1e-30 && h->exposure[c] < 1e30)) /* NaN too */
            return fail(error, FACET_ERROR_INVALID, "%s: %.*s: %s expected", name,
                        length < 40 ? (int)length : 40, line,
                        is_color ? "three positive numbers were" : "a positive number was");
    }
    return FACET_OK;
}

static void parse_primaries(const char *line, size_t length, hdr_header *h)
{
    const char *end = line + length;
    const char *number = (const char *)memchr(line, '=', length) + 1;
    h->has_primaries = false; /* eight zeros, which some programs write, name none */
    for (int i = 0; i < 8; i++) {
        while (number < end && (*number == ' ' || *number == '\t'))
            number++;
        h->primaries.xy[i / 2][i % 2] = codec_parse_number(number, end, &number);
        h->has_primaries |= h->primaries.xy[i / 2][i % 2] != 0.0; /* NaN too */
    }
}

static facet_result parse_header(const unsigned char *bytes, size_t size, const char *name, hdr_header *h,
                                 facet_error *error)
{
    static const char format_key[] = "FORMAT=";
    *h = (hdr_header){.exposure = {1.0, 1.0, 1.0}};
    const unsigned char *p = bytes;
    const unsigned char *end = bytes + size;
    const char *line;
    size_t length;
    for (;;) {
        if (!next_line(&p, end, &line, &length))
            return fail(error, FACET_ERROR_INVALID, "%s: header: an empty line was expected at its end",
                        name);
        if (length == 0)
            break;
        if (starts_with(line, length, format_key)) {
            line += sizeof format_key - 1;
            length -= sizeof format_key - 1;
            if (!starts_with(line, length, "32-bit_rle_rgbe"))
                return fail(error, FACET_ERROR_UNSUPPORTED, "%s: FORMAT %.*s is not 32-bit_rle_rgbe", name,
                            length < 40 ? (int)length : 40, line);
        } else if (starts_with(line, length, "EXPOSURE=") || starts_with(line, length, "COLORCORR=")) {
            facet_result result = parse_exposure(line, length, line[0] == 'C', name, h, error);
            if (result != FACET_OK)
                return result;
        } else if (starts_with(line, length, "PRIMARIES=")) {
            parse_primaries(line, length, h);
        }
    }
    if (!next_line(&p, end, &line, &length) || !parse_resolution(line, length, h))
        return fail(error, FACET_ERROR_INVALID, "%s: header: a resolution as \"-Y 512 +X 1024\" was expected",
                    name);
    h->data = p;
    h->data_size = (size_t)(end - p);
    return FACET_OK;
}

facet_result hdr_probe(const unsigned char *bytes, size_t size, const char *name, image *header,
                       facet_error *error)
{
    hdr_header h;
    TRY(parse_header(bytes, size, name, &h, error));
    TRY(codec_check_size(name, h.width, h.height, UINT32_MAX, error));
    *header = (image){.width = h.width, .height = h.height, .channel_count = 3, .type = IMAGE_F32};
    return FACET_OK;
}

/* ---- scanlines ---- */

/* Scanlines coded by component begin with 2, 2 and their length; normalised RGBE texels cannot, since their
 * largest component is at least 128. */
static bool is_coded(const hdr_header *h, const unsigned char *p)
{
    return !h->is_plain && p[0] == 2 && p[1] == 2 && p[2] < 128 && h->scan_length >= MIN_CODED_LENGTH &&
           h->scan_length <= MAX_CODED_LENGTH;
}

static bool is_repeat(const hdr_header *h, const unsigned char *p)
{
    return !h->is_plain && p[0] == 1 && p[1] == 1 && p[2] == 1;
}

/* Position after the coded scanline at p; NULL: damaged. Codes: 1 to 128 literal bytes follow, or 129 to 255:
 * one byte is repeated 1 to 127 times. */
static const unsigned char *skip_coded(const hdr_header *h, const unsigned char *p, const unsigned char *end)
{
    if (((uint32_t)p[2] << 8 | p[3]) != h->scan_length)
        return NULL;
    p += 4;
    for (int component = 0; component < 4; component++)
        for (uint32_t t = 0; t < h->scan_length;) {
            if (end - p < 2)
                return NULL;
            uint32_t code = *p;
            uint32_t count = code > 128 ? code - 128 : code;
            uint32_t bytes = code > 128 ? 2 : 1 + code;
            if (count == 0 || count > h->scan_length - t || (size_t)(end - p) < bytes)
                return NULL;
            p += bytes;
            t += count;
        }
    return p;
}

/* The same for texels of four bytes, of which (1, 1, 1, n) repeats the previous one n times; consecutive
 * repeats are the bytes of one count, low ones first. */
static const unsigned char *skip_flat(const hdr_header *h, const unsigned char *p, const unsigned char *end)
{
    uint32_t shift = 0;
    for (uint32_t t = 0; t < h->scan_length; p += 4) {
        if (end - p < 4)
            return NULL;
        uint64_t count = 1;
        if (is_repeat(h, p)) {
            count = shift < 32 ? (uint64_t)p[3] << shift : 0;
            shift += 8;
            if (t == 0 || shift > 32 || count > h->scan_length - t)
                return NULL;
        } else {
            shift = 0;
        }
        t += (uint32_t)count;
    }
    return p;
}

typedef struct hdr_reading {
    const hdr_header *header;
    const facet_allocator *allocator;
    const size_t *offsets; /* positions of the scanlines in the data */
    float scales[3][256];  /* radiance of one unit of the mantissa, per channel and exponent */
    float *texels;         /* of scanline 0, texel 0 */
    ptrdiff_t scan_step, texel_step;
    _Atomic bool has_no_memory;
} hdr_reading;

/* Decodes a checked scanline to components: planes[component * scan_length + t]. */
static void read_coded(const hdr_header *h, const unsigned char *p, unsigned char *planes)
{
    unsigned char *to = planes;
    unsigned char *to_end = planes + 4 * (size_t)h->scan_length;
    p += 4;
    while (to < to_end) {
        uint32_t code = *p++;
        if (code > 128) {
            memset(to, *p++, code - 128);
            to += code - 128;
        } else {
            memcpy(to, p, code);
            p += code;
            to += code;
        }
    }
}

static void read_flat(const hdr_header *h, const unsigned char *p, unsigned char *planes)
{
    size_t length = h->scan_length;
    unsigned char texel[4] = {0};
    uint32_t shift = 0;
    for (size_t t = 0; t < length; p += 4) {
        size_t count = 1;
        if (is_repeat(h, p)) {
            count = (size_t)p[3] << shift;
            shift += 8;
        } else {
            memcpy(texel, p, 4);
            shift = 0;
        }
        for (size_t i = 0; i < count; i++, t++)
            for (size_t component = 0; component < 4; component++)
                planes[component * length + t] = texel[component];
    }
}

/* Radiance of component m with exponent e: m / 256 * 2^(e - 128); 0 if e is 0. Radiance itself uses m + 0.5,
 * the center of the range of a writer that truncates; most other programs use m, which keeps 0 and 1 exact. */
static void read_scans(void *context, size_t begin, size_t end)
{
    hdr_reading *r = context;
    const size_t length = r->header->scan_length;
    unsigned char *planes = mem_alloc(r->allocator, length, 4);
    if (!planes) {
        atomic_store(&r->has_no_memory, true);
        return;
    }
    for (size_t s = begin; s < end; s++) {
        const unsigned char *p = r->header->data + r->offsets[s];
        if (is_coded(r->header, p))
            read_coded(r->header, p, planes);
        else
            read_flat(r->header, p, planes);
        float *texel = r->texels + (ptrdiff_t)s * r->scan_step;
        for (size_t t = 0; t < length; t++, texel += r->texel_step) {
            const unsigned char exponent = planes[3 * length + t];
            texel[0] = (float)planes[t] * r->scales[0][exponent];
            texel[1] = (float)planes[length + t] * r->scales[1][exponent];
            texel[2] = (float)planes[2 * length + t] * r->scales[2][exponent];
        }
    }
    mem_free(planes);
}

/* Whether scanlines coded by component fill the data exactly. */
static bool is_coded_throughout(const hdr_header *h)
{
    const unsigned char *p = h->data;
    const unsigned char *end = h->data + h->data_size;
    for (uint32_t s = 0; s < h->scan_count && p; s++)
        p = end - p >= 4 && is_coded(h, p) ? skip_coded(h, p, end) : NULL;
    return p == end;
}

/* Finds and checks each scanline. Data of exactly four bytes per texel are flat texels, although one may look
 * like a run if the writer does not normalise mantissas: (1, 1, 1, 128). */
static facet_result find_scans(hdr_header *h, const char *name, size_t *offsets, facet_error *error)
{
    h->is_plain = h->data_size == 4 * (uint64_t)h->width * h->height && !is_coded_throughout(h);
    const unsigned char *p = h->data;
    const unsigned char *end = h->data + h->data_size;
    for (uint32_t s = 0; s < h->scan_count; s++) {
        offsets[s] = (size_t)(p - h->data);
        if (end - p < 4)
            return fail(error, FACET_ERROR_INVALID, "%s: the file ends before scanline %u of %u", name, s,
                        h->scan_count);
        p = is_coded(h, p) ? skip_coded(h, p, end) : skip_flat(h, p, end);
        if (!p)
            return fail(error, FACET_ERROR_INVALID,
                        "%s: scanline %u of %u: is cut off or does not encode %u texels", name, s,
                        h->scan_count, h->scan_length);
    }
    return FACET_OK;
}

static void set_directions(hdr_reading *r, const hdr_header *h, float *pixels)
{
    ptrdiff_t x_step = h->is_x_falling ? -3 : 3;
    ptrdiff_t y_step = 3 * (ptrdiff_t)h->width * (h->is_y_up ? -1 : 1);
    r->texels = pixels;
    if (h->is_x_falling)
        r->texels += 3 * (ptrdiff_t)(h->width - 1);
    if (h->is_y_up)
        r->texels += 3 * (ptrdiff_t)h->width * (ptrdiff_t)(h->height - 1);
    r->scan_step = h->is_x_first ? x_step : y_step;
    r->texel_step = h->is_x_first ? y_step : x_step;
}

facet_result hdr_decode(const unsigned char *bytes, size_t size, const char *name,
                        const image_decode_desc *desc, image *out, facet_error *error)
{
    hdr_header h;
    size_t *offsets = NULL;
    image made = {0};
    TRY(parse_header(bytes, size, name, &h, error));
    TRY(codec_check_size(name, h.width, h.height, desc->max_size, error));

    offsets = mem_alloc(&desc->allocator, h.scan_count, sizeof *offsets);
    if (!offsets)
        return fail_memory(error, "scanline offsets", h.scan_count * sizeof *offsets);
    facet_result result = find_scans(&h, name, offsets, error);
    if (result == FACET_OK)
        result = image_create(&desc->allocator, h.width, h.height, 3, IMAGE_F32, &made, error);
    if (result != FACET_OK)
        goto done;

    hdr_reading r = {.header = &h, .allocator = &desc->allocator, .offsets = offsets};
    for (int e = 1; e < 256; e++)
        for (int c = 0; c < 3; c++)
            r.scales[c][e] = (float)fmin(ldexp(1.0, e - 128 - 8) / h.exposure[c], 0x1p119);
    set_directions(&r, &h, made.pixels);
    parallel_for(desc->thread_count, h.scan_count, 32768 / h.scan_length + 1, read_scans, &r);
    if (atomic_load(&r.has_no_memory))
        result = fail_memory(error, "scanline", 4 * (size_t)h.scan_length);
    else if (h.has_primaries)
        primaries_convert(&made, &h.primaries, desc);
done:
    mem_free(offsets);
    if (result == FACET_OK)
        *out = made;
    else
        image_destroy(&made);
    return result;
}

/* ---- writing ---- */

/* Encodes to the nearest components; values that are not positive (or NaN) become 0, those above the range of
 * the format its maximum. */
static void texel_to_rgbe(const float rgb[3], unsigned char rgbe[4])
{
    const float brightest = 0x1.fep126f; /* 255 / 256 2^127 */
    float c[3];
    float largest = 0.0f;
    for (int i = 0; i < 3; i++) {
        c[i] = rgb[i] > 0.0f ? (rgb[i] < brightest ? rgb[i] : brightest) : 0.0f;
        largest = c[i] > largest ? c[i] : largest;
    }
    memset(rgbe, 0, 4);
    if (largest < 1e-32f)
        return;
    int exponent = (int)(float_bits(largest) >> 23) - 126; /* largest = f 2^exponent, f in [0.5, 1) */
    float scale = float_from_bits((uint32_t)(127 + 7 - exponent) << 23) * 2.0f; /* 2^(8 - exponent) */
    if (largest * scale >= 255.5f) { /* rounds to 256, which is 128 at the next exponent */
        scale *= 0.5f;
        exponent++;
    }
    for (int i = 0; i < 3; i++)
        rgbe[i] = (unsigned char)(c[i] * scale + 0.5f);
    rgbe[3] = (unsigned char)(exponent + 128);
}

/* Encodes length bytes to out and returns its end: runs of at least 4, the rest as literals. */
static unsigned char *code_component(const unsigned char *plane, uint32_t length, unsigned char *out)
{
    uint32_t t = 0;
    while (t < length) {
        uint32_t literal = t; /* [literal, t) is literal, a run follows */
        uint32_t run = 0;
        while (t < length) {
            for (run = 1; run < 127 && t + run < length && plane[t + run] == plane[t];)
                run++;
            if (run >= 4)
                break;
            t += run;
            run = 0;
        }
        while (literal < t) {
            uint32_t count = t - literal < 128 ? t - literal : 128;
            *out++ = (unsigned char)count;
            memcpy(out, plane + literal, count);
            out += count;
            literal += count;
        }
        if (run) {
            *out++ = (unsigned char)(128 + run);
            *out++ = plane[t];
            t += run;
        }
    }
    return out;
}

facet_result hdr_encode(const image *i, const image_encode_desc *desc, unsigned char **bytes, size_t *size,
                        facet_error *error)
{
    TRY(codec_check_input(i, "Radiance HDR", i->type == IMAGE_F32 && !i->is_srgb, "float RGB", 1u << 3,
                          error));
    const bool is_coding = i->width >= MIN_CODED_LENGTH && i->width <= MAX_CODED_LENGTH;
    const size_t width = i->width;
    const size_t most = 4 + 4 * (width + width / 128 + 2); /* bytes of a scanline */
    unsigned char *planes = mem_alloc(&desc->allocator, width, 4);
    unsigned char *file = mem_alloc(&desc->allocator, (size_t)i->height + 1, most + 128);
    if (!planes || !file) {
        mem_free(planes);
        mem_free(file);
        return fail_memory(error, "Radiance HDR file", i->height * most);
    }
    unsigned char *p = file;
    p += snprintf((char *)p, 128, "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y %u +X %u\n", i->height, i->width);
    const float *texel = i->pixels;
    for (uint32_t y = 0; y < i->height; y++) {
        for (size_t x = 0; x < width; x++, texel += 3) {
            unsigned char rgbe[4];
            texel_to_rgbe(texel, rgbe);
            if (is_coding) {
                for (size_t component = 0; component < 4; component++)
                    planes[component * width + x] = rgbe[component];
            } else {
                memcpy(p, rgbe, 4);
                p += 4;
            }
        }
        if (!is_coding)
            continue;
        *p++ = 2;
        *p++ = 2;
        *p++ = (unsigned char)(width >> 8);
        *p++ = (unsigned char)width;
        for (size_t component = 0; component < 4; component++)
            p = code_component(planes + component * width, i->width, p);
    }
    mem_free(planes);
    *bytes = file;
    *size = (size_t)(p - file);
    return FACET_OK;
}
