/* exr_dwa.c - OpenEXR's DWAA and DWAB: color channels in blocks of 8 x 8 as JPEG codes them (a cosine
 * transform of perceptual values, coefficients as half numbers, Huffman or deflate), alpha run-length
 * coded, others deflated. Format: DreamWorks Animation 2014, as the OpenEXR library reads it. */
#include "image/codec.h"
#include "image/exr.h"

#include <ctype.h>
#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "image/half.h"
#include "image/inflate.h"

enum { BLOCK = 8, BLOCK_TEXELS = 64, HALVES = 65536 };
enum { END_OF_BLOCK = 0xff00, RUN_OF_ZEROS = 0xff /* in the high byte */ };

/* How the samples of a channel are coded. */
typedef enum scheme { SCHEME_PLAIN, SCHEME_DCT, SCHEME_RUNS, SCHEME_COUNT } scheme;

/* The numbers of 64 bits that a chunk begins with. */
typedef enum field {
    FIELD_VERSION,
    FIELD_PLAIN_SIZE,
    FIELD_PLAIN_PACKED,
    FIELD_AC_PACKED,
    FIELD_DC_PACKED,
    FIELD_RUNS_PACKED,
    FIELD_RUNS_CODED, /* inflated, not yet expanded */
    FIELD_RUNS_SIZE,
    FIELD_AC_COUNT, /* in 16-bit numbers */
    FIELD_DC_COUNT,
    FIELD_AC_CODING, /* 0: Huffman, 1: deflate */
    FIELD_COUNT
} field;

typedef struct dwa {
    const exr_chunk *chunk;
    uint64_t fields[FIELD_COUNT];
    scheme *schemes;       /* per channel */
    int8_t *colors;        /* per channel: 0, 1, 2: it is the red, green, blue of its layer; -1: none */
    bool *is_done;         /* per channel */
    unsigned char *plain;  /* samples of the plain channels, one after the other */
    unsigned char *runs;   /* those of SCHEME_RUNS, in planes of bytes */
    uint16_t *ac, *ac_end; /* coefficients not yet taken: all but the first of each block .. */
    uint16_t *dc, *dc_end; /* .. and the first */
    uint16_t *to_linear;   /* per half: light of a perceptual value */
    unsigned char *samples;
} dwa;

/* ---- which channel is coded how ---- */

typedef struct rule {
    const char *suffix; /* behind the last point of the channel's name */
    exr_type type;
    scheme scheme;
    int8_t color;
    bool ignores_case;
} rule;

static bool does_match(const rule *r, const exr_channel *channel)
{
    const char *point = strrchr(channel->name, '.');
    const char *a = point ? point + 1 : channel->name;
    const char *b = r->suffix;
    if (r->type != channel->type)
        return false;
    if (!r->ignores_case)
        return strcmp(a, b) == 0;
    while (*a && tolower((unsigned char)*a) == tolower((unsigned char)*b)) {
        a++;
        b++;
    }
    return *a == *b;
}

static void apply_rule(dwa *d, const rule *r)
{
    for (uint32_t c = 0; c < d->chunk->channel_count; c++)
        if (does_match(r, &d->chunk->channels[c])) {
            d->schemes[c] = r->scheme;
            if (r->color >= 0)
                d->colors[c] = r->color;
        }
}

/* Files of versions 0 and 1 have these rules. */
static void apply_legacy_rules(dwa *d)
{
    static const struct {
        const char *suffix;
        int8_t color;
    } coded[] = {{"r", 0},   {"red", 0},  {"g", 1},  {"grn", 1}, {"green", 1}, {"b", 2},
                 {"blu", 2}, {"blue", 2}, {"y", -1}, {"by", -1}, {"ry", -1}};
    for (size_t i = 0; i < sizeof coded / sizeof *coded; i++)
        for (int type = EXR_HALF; type <= EXR_FLOAT; type++)
            apply_rule(d, &(rule){coded[i].suffix, (exr_type)type, SCHEME_DCT, coded[i].color, true});
    for (int type = EXR_UINT; type <= EXR_FLOAT; type++)
        apply_rule(d, &(rule){"a", (exr_type)type, SCHEME_RUNS, -1, true});
}

/* Rules as later files carry them: their size with itself in 16 bits, then each a string, a byte of flags and
 * one of type. Returns behind them, NULL: damaged. */
static const unsigned char *apply_stored_rules(dwa *d, const unsigned char *p, const unsigned char *end)
{
    if (end - p < 2)
        return NULL;
    size_t size = p[0] | (size_t)p[1] << 8;
    if (size < 2 || size > (size_t)(end - p))
        return NULL;
    end = p + size;
    for (p += 2; p < end;) {
        const unsigned char *zero = memchr(p, 0, (size_t)(end - p));
        if (!zero || end - zero < 3 || zero[2] > EXR_FLOAT)
            return NULL;
        rule r = {.suffix = (const char *)p,
                  .type = (exr_type)zero[2],
                  .scheme = (scheme)(zero[1] >> 2 & 3),
                  .color = (int8_t)((zero[1] >> 4) - 1),
                  .ignores_case = zero[1] & 1};
        if (r.scheme >= SCHEME_COUNT || r.color > 2)
            return NULL;
        apply_rule(d, &r);
        p = zero + 3;
    }
    return p;
}

/* Length of the layer's name with its point. */
static size_t prefix_length(const char *name)
{
    const char *point = strrchr(name, '.');
    return point ? (size_t)(point + 1 - name) : 0;
}

/* The channel of a color in the layer of channel c; -1: there is none. */
static int find_color(const dwa *d, uint32_t c, int8_t color)
{
    const char *name = d->chunk->channels[c].name;
    const size_t length = prefix_length(name);
    for (uint32_t k = d->chunk->channel_count; k-- > 0;) { /* the last one counts */
        const char *other = d->chunk->channels[k].name;
        if (d->colors[k] == color && prefix_length(other) == length && memcmp(other, name, length) == 0)
            return (int)k;
    }
    return -1;
}

/* ---- the parts of a chunk ---- */

static size_t plane_texels(const dwa *d)
{
    return (size_t)d->chunk->width * d->chunk->height;
}

static size_t scheme_size(const dwa *d, scheme s)
{
    size_t size = 0;
    for (uint32_t c = 0; c < d->chunk->channel_count; c++)
        if (d->schemes[c] == s)
            size += plane_texels(d) * exr_sample_size(&d->chunk->channels[c]);
    return size;
}

static size_t block_count(const dwa *d)
{
    size_t channels = 0;
    for (uint32_t c = 0; c < d->chunk->channel_count; c++)
        channels += d->schemes[c] == SCHEME_DCT;
    return channels * ((d->chunk->width + BLOCK - 1) / BLOCK) * ((d->chunk->height + BLOCK - 1) / BLOCK);
}

/* In the machine's order of bytes, in place. */
static void load_halves(uint16_t *halves, size_t count)
{
    const unsigned char *bytes = (const unsigned char *)halves;
    for (size_t k = 0; k < count; k++)
        halves[k] = (uint16_t)(bytes[2 * k] | bytes[2 * k + 1] << 8);
}

static facet_result unpack_ac(dwa *d, const unsigned char *packed)
{
    const size_t count = (size_t)d->fields[FIELD_AC_COUNT];
    const size_t packed_size = (size_t)d->fields[FIELD_AC_PACKED];
    d->ac_end = d->ac + count;
    if (count == 0)
        return FACET_OK;
    if (d->fields[FIELD_AC_CODING] == 0)
        return exr_huffman_decode(d->chunk->allocator, packed, packed_size, d->ac, count);
    if (!zlib_inflate(packed, packed_size, (unsigned char *)d->ac, 2 * count))
        return FACET_ERROR_INVALID;
    load_halves(d->ac, count);
    return FACET_OK;
}

static facet_result unpack_dc(dwa *d, const unsigned char *packed)
{
    const size_t count = (size_t)d->fields[FIELD_DC_COUNT];
    d->dc_end = d->dc + count;
    if (count == 0)
        return FACET_OK;
    unsigned char *predicted = mem_alloc(d->chunk->allocator, count, 2);
    if (!predicted)
        return FACET_ERROR_MEMORY;
    bool is_whole = zlib_inflate(packed, (size_t)d->fields[FIELD_DC_PACKED], predicted, 2 * count);
    if (is_whole) {
        exr_unpredict(predicted, 2 * count, (unsigned char *)d->dc);
        load_halves(d->dc, count);
    }
    mem_free(predicted);
    return is_whole ? FACET_OK : FACET_ERROR_INVALID;
}

static facet_result unpack_runs(dwa *d, const unsigned char *packed)
{
    const size_t size = (size_t)d->fields[FIELD_RUNS_SIZE];
    const size_t coded_size = (size_t)d->fields[FIELD_RUNS_CODED];
    if (size == 0)
        return FACET_OK;
    unsigned char *coded = mem_alloc(d->chunk->allocator, coded_size, 1);
    if (!coded)
        return FACET_ERROR_MEMORY;
    facet_result result = FACET_ERROR_INVALID;
    if (zlib_inflate(packed, (size_t)d->fields[FIELD_RUNS_PACKED], coded, coded_size))
        result = exr_expand_runs(coded, coded_size, d->runs, size);
    mem_free(coded);
    return result;
}

static facet_result unpack_plain(dwa *d, const unsigned char *packed)
{
    const size_t size = (size_t)d->fields[FIELD_PLAIN_SIZE];
    if (size == 0)
        return FACET_OK;
    bool is_whole = zlib_inflate(packed, (size_t)d->fields[FIELD_PLAIN_PACKED], d->plain, size);
    return is_whole ? FACET_OK : FACET_ERROR_INVALID;
}

/* Whether the sizes fit the chunk's channels, so that memory can be taken for them. */
static bool are_sizes_right(const dwa *d, size_t available)
{
    static const field packed[] = {FIELD_PLAIN_PACKED, FIELD_AC_PACKED, FIELD_DC_PACKED, FIELD_RUNS_PACKED};
    for (size_t i = 0; i < sizeof packed / sizeof *packed; i++) {
        if (d->fields[packed[i]] > available)
            return false;
        available -= (size_t)d->fields[packed[i]];
    }
    const size_t blocks = block_count(d);
    return d->fields[FIELD_PLAIN_SIZE] == scheme_size(d, SCHEME_PLAIN) &&
           d->fields[FIELD_RUNS_SIZE] == scheme_size(d, SCHEME_RUNS) &&
           d->fields[FIELD_RUNS_CODED] <= 2 * d->fields[FIELD_RUNS_SIZE] &&
           d->fields[FIELD_DC_COUNT] == blocks && d->fields[FIELD_AC_COUNT] <= blocks * (BLOCK_TEXELS - 1) &&
           d->fields[FIELD_AC_CODING] <= 1;
}

/* ---- blocks ---- */

/* Position in zigzag order of each coefficient, row by row. */
static const uint8_t zigzag[BLOCK_TEXELS] = {0,  1,  5,  6,  14, 15, 27, 28, 2,  4,  7,  13, 16, 26, 29, 42,
                                             3,  8,  12, 17, 25, 30, 41, 43, 9,  11, 18, 24, 31, 40, 44, 53,
                                             10, 19, 23, 32, 39, 45, 52, 54, 20, 22, 33, 38, 46, 51, 55, 60,
                                             21, 34, 37, 47, 50, 56, 59, 61, 35, 36, 48, 49, 57, 58, 62, 63};

/* The 8 values whose orthonormal cosine transform c is, stride apart: the sum over k of s(k) c[k] cos((2 n
 * + 1) k pi / 16), s(0) = sqrt(1/8), else 1/2; even and odd k apart, which n and 7 - n share. */
static void inverse_cosines(float *c, size_t stride)
{
    const float s0 = 0.353553391f;                    /* cos(4 pi / 16) / 2 */
    const float s2 = 0.461939766f, s6 = 0.191341716f; /* cos(2 pi / 16) / 2 .. */
    const float s1 = 0.490392640f, s3 = 0.415734806f, s5 = 0.277785117f, s7 = 0.097545161f;
    const float c0 = c[0], c1 = c[stride], c2 = c[2 * stride], c3 = c[3 * stride];
    const float c4 = c[4 * stride], c5 = c[5 * stride], c6 = c[6 * stride], c7 = c[7 * stride];
    const float sum = s0 * (c0 + c4), difference = s0 * (c0 - c4);
    const float outer = s2 * c2 + s6 * c6, inner = s6 * c2 - s2 * c6;
    const float even[4] = {sum + outer, difference + inner, difference - inner, sum - outer};
    const float odd[4] = {s1 * c1 + s3 * c3 + s5 * c5 + s7 * c7, s3 * c1 - s7 * c3 - s1 * c5 - s5 * c7,
                          s5 * c1 - s1 * c3 + s7 * c5 + s3 * c7, s7 * c1 - s5 * c3 + s3 * c5 - s1 * c7};
    for (size_t n = 0; n < 4; n++) {
        c[n * stride] = even[n] + odd[n];
        c[(7 - n) * stride] = even[n] - odd[n];
    }
}

/* The next block of coefficients, transformed. False: they are damaged. */
static bool read_block(dwa *d, uint16_t dc, float out[BLOCK_TEXELS])
{
    uint16_t halves[BLOCK_TEXELS] = {0}; /* in zigzag order */
    uint32_t last = 0;                   /* that is not 0 */
    halves[0] = dc;
    for (uint32_t k = 1; k < BLOCK_TEXELS;) {
        if (d->ac == d->ac_end)
            return false;
        uint16_t token = *d->ac++;
        if (token == END_OF_BLOCK)
            break;
        if (token >> 8 == RUN_OF_ZEROS) {
            k += token & 0xff;
        } else {
            last = k;
            halves[k++] = token;
        }
    }
    if (last == 0) {
        float value = half_to_float(dc) * 0.125f;
        for (int k = 0; k < BLOCK_TEXELS; k++)
            out[k] = value;
        return true;
    }
    for (int k = 0; k < BLOCK_TEXELS; k++)
        out[k] = half_to_float(halves[zigzag[k]]);
    for (size_t row = 0; row < BLOCK; row++)
        inverse_cosines(out + row * BLOCK, 1);
    for (size_t column = 0; column < BLOCK; column++)
        inverse_cosines(out + column, BLOCK);
    return true;
}

/* Y'CbCr of Rec.709 to R'G'B', with the library's constants. */
static void convert_to_rgb(float y[BLOCK_TEXELS], float cb[BLOCK_TEXELS], float cr[BLOCK_TEXELS])
{
    for (int k = 0; k < BLOCK_TEXELS; k++) {
        float r = y[k] + 1.5747f * cr[k];
        float g = y[k] - 0.1873f * cb[k] - 0.4682f * cr[k];
        float b = y[k] + 1.8556f * cb[k];
        y[k] = r;
        cb[k] = g;
        cr[k] = b;
    }
}

/* Where the samples of channel c in row 0 stand in a row. */
static size_t channel_offset(const dwa *d, uint32_t c)
{
    size_t offset = 0;
    while (c-- > 0)
        offset += d->chunk->width * exr_sample_size(&d->chunk->channels[c]);
    return offset;
}

static void store_block(const dwa *d, uint32_t c, uint32_t x, uint32_t y, const float block[BLOCK_TEXELS],
                        const uint16_t *to_linear)
{
    const size_t size = exr_sample_size(&d->chunk->channels[c]);
    const size_t row_stride = d->chunk->size / d->chunk->height;
    const uint32_t columns = d->chunk->width - x < BLOCK ? d->chunk->width - x : BLOCK;
    const uint32_t rows = d->chunk->height - y < BLOCK ? d->chunk->height - y : BLOCK;
    for (uint32_t row = 0; row < rows; row++) {
        unsigned char *to = d->samples + (y + row) * row_stride + channel_offset(d, c) + x * size;
        for (uint32_t column = 0; column < columns; column++, to += size) {
            uint16_t half = half_from_float(block[row * BLOCK + column]);
            half = to_linear ? to_linear[half] : half;
            if (size == 2) {
                to[0] = (unsigned char)half;
                to[1] = (unsigned char)(half >> 8);
            } else {
                store_u32_le(to, float_bits(half_to_float(half)));
            }
        }
    }
}

/* One channel, or the three of a layer; the DC coefficients of each stand together. */
static bool decode_blocks(dwa *d, const uint32_t *channels, uint32_t count, bool is_linear)
{
    float blocks[3][BLOCK_TEXELS];
    const size_t columns = (d->chunk->width + BLOCK - 1) / BLOCK;
    const size_t rows = (d->chunk->height + BLOCK - 1) / BLOCK;
    if ((size_t)(d->dc_end - d->dc) < count * rows * columns)
        return false;
    for (size_t row = 0; row < rows; row++)
        for (size_t column = 0; column < columns; column++) {
            for (uint32_t k = 0; k < count; k++)
                if (!read_block(d, d->dc[(k * rows + row) * columns + column], blocks[k]))
                    return false;
            if (count == 3)
                convert_to_rgb(blocks[0], blocks[1], blocks[2]);
            for (uint32_t k = 0; k < count; k++)
                store_block(d, channels[k], (uint32_t)column * BLOCK, (uint32_t)row * BLOCK, blocks[k],
                            is_linear ? NULL : d->to_linear);
        }
    d->dc += count * rows * columns;
    return true;
}

/* Half to half: perceptual values up to 1 are to the power of 2.2, beyond exponential, with that slope. */
static void fill_linear_table(uint16_t table[HALVES])
{
    for (uint32_t half = 0; half < HALVES / 2; half++) {
        double x = (double)half_to_float((uint16_t)half);
        double light = x <= 1.0 ? pow(x, 2.2) : exp(2.2 * (x - 1.0));
        table[half] = half < 0x7c00 ? half_from_float((float)fmin(light, 1e30)) : 0;
        table[half | 0x8000] = table[half] ? table[half] | 0x8000 : 0;
    }
}

/* ---- channels ---- */

static int compare_layers(const char *a, const char *b)
{
    size_t a_length = prefix_length(a);
    size_t b_length = prefix_length(b);
    int order = memcmp(a, b, a_length < b_length ? a_length : b_length);
    return order ? order : a_length < b_length ? -1 : a_length > b_length;
}

/* Layers with red, green and blue, by name; first of all since their coefficients stand first. */
static bool decode_colors(dwa *d)
{
    for (;;) {
        int next[3] = {-1, -1, -1};
        for (uint32_t c = 0; c < d->chunk->channel_count; c++) {
            int found[3];
            for (int8_t color = 0; color < 3; color++)
                found[color] = find_color(d, c, color);
            if (found[0] < 0 || found[1] < 0 || found[2] < 0 || d->is_done[found[0]])
                continue;
            if (next[0] < 0 ||
                compare_layers(d->chunk->channels[found[0]].name, d->chunk->channels[next[0]].name) < 0)
                memcpy(next, found, sizeof next);
        }
        if (next[0] < 0)
            return true;
        uint32_t channels[3];
        for (int color = 0; color < 3; color++) {
            channels[color] = (uint32_t)next[color];
            if (d->schemes[channels[color]] != SCHEME_DCT)
                return false;
            d->is_done[channels[color]] = true;
        }
        if (!decode_blocks(d, channels, 3, false))
            return false;
    }
}

static void copy_plain(dwa *d, uint32_t c)
{
    const size_t row_size = d->chunk->width * exr_sample_size(&d->chunk->channels[c]);
    unsigned char *to = d->samples + channel_offset(d, c);
    for (uint32_t y = 0; y < d->chunk->height; y++) {
        memcpy(to, d->plain, row_size);
        d->plain += row_size;
        to += d->chunk->size / d->chunk->height;
    }
}

static void gather_planes(dwa *d, uint32_t c)
{
    const size_t size = exr_sample_size(&d->chunk->channels[c]);
    for (uint32_t y = 0; y < d->chunk->height; y++) {
        unsigned char *to = d->samples + y * (d->chunk->size / d->chunk->height) + channel_offset(d, c);
        const unsigned char *from = d->runs + (size_t)y * d->chunk->width;
        for (uint32_t x = 0; x < d->chunk->width; x++)
            for (size_t byte = 0; byte < size; byte++)
                *to++ = from[byte * plane_texels(d) + x];
    }
    d->runs += size * plane_texels(d);
}

static facet_result unpack_parts(dwa *d, const unsigned char *p)
{
    facet_result result = unpack_plain(d, p);
    p += d->fields[FIELD_PLAIN_PACKED];
    if (result == FACET_OK)
        result = unpack_ac(d, p);
    p += d->fields[FIELD_AC_PACKED];
    if (result == FACET_OK)
        result = unpack_dc(d, p);
    p += d->fields[FIELD_DC_PACKED];
    if (result == FACET_OK)
        result = unpack_runs(d, p);
    return result;
}

static facet_result decode_channels(dwa *d)
{
    if (!decode_colors(d))
        return FACET_ERROR_INVALID;
    for (uint32_t c = 0; c < d->chunk->channel_count; c++) {
        if (d->is_done[c])
            continue;
        if (d->schemes[c] == SCHEME_PLAIN)
            copy_plain(d, c);
        else if (d->schemes[c] == SCHEME_RUNS)
            gather_planes(d, c);
        else if (!decode_blocks(d, &c, 1, d->chunk->channels[c].is_linear))
            return FACET_ERROR_INVALID;
    }
    return FACET_OK;
}

facet_result exr_unpack_dwa(const exr_chunk *chunk, const unsigned char *packed, size_t packed_size,
                            unsigned char *samples)
{
    dwa d = {.chunk = chunk, .samples = samples};
    const unsigned char *p = packed;
    const unsigned char *end = packed + packed_size;
    if (packed_size < FIELD_COUNT * 8)
        return FACET_ERROR_INVALID;
    for (int f = 0; f < FIELD_COUNT; f++, p += 8)
        d.fields[f] = load_u32_le(p) | (uint64_t)load_u32_le(p + 4) << 32;

    const uint32_t count = chunk->channel_count;
    d.schemes = mem_zalloc(chunk->allocator, count, sizeof *d.schemes + 2);
    if (!d.schemes)
        return FACET_ERROR_MEMORY;
    d.colors = (int8_t *)(d.schemes + count);
    d.is_done = (bool *)(d.colors + count);
    memset(d.colors, -1, count);
    facet_result result = FACET_ERROR_INVALID;
    unsigned char *parts = NULL;
    if (d.fields[FIELD_VERSION] < 2)
        apply_legacy_rules(&d);
    else
        p = apply_stored_rules(&d, p, end);
    if (!p || !are_sizes_right(&d, (size_t)(end - p)))
        goto done;

    size_t plain_size = (scheme_size(&d, SCHEME_PLAIN) + 7) & ~(size_t)7;
    size_t runs_size = (scheme_size(&d, SCHEME_RUNS) + 7) & ~(size_t)7;
    size_t halves = HALVES + (size_t)d.fields[FIELD_AC_COUNT] + (size_t)d.fields[FIELD_DC_COUNT];
    parts = mem_alloc(chunk->allocator, plain_size + runs_size + 2 * halves, 1);
    if (!parts) {
        result = FACET_ERROR_MEMORY;
        goto done;
    }
    d.plain = parts;
    d.runs = parts + plain_size;
    d.to_linear = (uint16_t *)(void *)(d.runs + runs_size);
    d.ac = d.to_linear + HALVES;
    d.dc = d.ac + d.fields[FIELD_AC_COUNT];
    fill_linear_table(d.to_linear);
    result = unpack_parts(&d, p);
    if (result == FACET_OK)
        result = decode_channels(&d);
done:
    mem_free(parts);
    mem_free(d.schemes);
    return result;
}
