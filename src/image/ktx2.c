/* ktx2.c - see ktx2.h: opens a file (header, index of levels, format descriptor, metadata) and reads it as an
 * image file. ktx2_read.c decodes. */
#include "image/ktx2.h"
#include "base/result.h"
#include "image/codec.h"

/* Offsets in the file, bytes (section "File Structure"). */
enum {
    VK_FORMAT = 12,
    PIXEL_WIDTH = 20,
    PIXEL_HEIGHT = 24,
    PIXEL_DEPTH = 28,
    LAYER_COUNT = 32,
    FACE_COUNT = 36,
    LEVEL_COUNT = 40,
    SCHEME = 44,
    DFD_OFFSET = 48,
    DFD_SIZE = 52,
    KVD_OFFSET = 56,
    KVD_SIZE = 60,
    SGD_OFFSET = 64,
    SGD_SIZE = 72,
    LEVEL_INDEX = 80,
    LEVEL_RECORD = 24
};

/* Offsets in a format descriptor (KDF section 5). */
enum {
    DFD_MODEL = 12,
    DFD_TRANSFER = 14,
    DFD_FLAGS = 15,
    DFD_SAMPLES = 28,
    DFD_SAMPLE = 16,
    DFD_CHANNEL = 3, /* of a sample */
    TRANSFER_SRGB = 2,
    FLAG_PREMULTIPLIED = 1
};

typedef struct span {
    const unsigned char *bytes;
    size_t size;
} span;

/* A part of the file; false: outside of the file. */
static bool get_span(span file, uint64_t offset, uint64_t size, span *out)
{
    if (size > file.size || offset > file.size - size)
        return false;
    *out = (span){file.bytes + offset, (size_t)size};
    return true;
}

uint32_t ktx2_level_edge(uint32_t edge, uint32_t level)
{
    return edge >> level ? edge >> level : 1;
}

/* ---- header ---- */

static facet_result fail_ktx2(facet_error *error, const char *name, const char *what)
{
    return fail(error, FACET_ERROR_INVALID, "%s: KTX2: %s", name, what);
}

static facet_result read_counts(span file, ktx2 *k, facet_error *error)
{
    const unsigned char *b = file.bytes;
    k->width = load_u32_le(b + PIXEL_WIDTH);
    k->height = load_u32_le(b + PIXEL_HEIGHT);
    k->layer_count = load_u32_le(b + LAYER_COUNT);
    k->face_count = load_u32_le(b + FACE_COUNT);
    k->level_count = load_u32_le(b + LEVEL_COUNT);
    if (load_u32_le(b + PIXEL_DEPTH) != 0)
        return fail(error, FACET_ERROR_UNSUPPORTED, "%s: KTX2: 3D textures are not read (pixelDepth is %u)",
                    k->name, load_u32_le(b + PIXEL_DEPTH));
    if (k->width == 0 || k->height == 0)
        return fail(error, FACET_ERROR_INVALID, "%s: KTX2: the image has no texels (%u x %u)", k->name,
                    k->width, k->height);
    if (k->face_count != 1 && (k->face_count != 6 || k->width != k->height))
        return fail(error, FACET_ERROR_INVALID,
                    "%s: KTX2: faceCount: 1, or 6 of a square image, was expected, not %u of %u x %u",
                    k->name, k->face_count, k->width, k->height);
    k->is_array = k->layer_count > 0;
    k->is_cube = k->face_count == 6;
    k->has_all_mips = k->level_count == 0;
    k->layer_count += !k->is_array;
    k->level_count += k->has_all_mips;
    const uint32_t larger = k->width > k->height ? k->width : k->height;
    if (k->level_count > KTX2_MAX_LEVELS || larger >> (k->level_count - 1) == 0)
        return fail(error, FACET_ERROR_INVALID, "%s: KTX2: levelCount: %u x %u texels do not have %u levels",
                    k->name, k->width, k->height, k->level_count);
    return FACET_OK;
}

/* ---- format ---- */

static facet_result find_basis_format(const ktx2 *k, span dfd, const ktx2_format **out, facet_error *error)
{
    const unsigned model = dfd.bytes[DFD_MODEL];
    if (model == KDF_MODEL_UASTC_HDR || model == KDF_MODEL_UASTC_HDR_6X6)
        return fail(error, FACET_ERROR_UNSUPPORTED, "%s: KTX2: UASTC HDR is not read", k->name);
    const int first = dfd.bytes[DFD_SAMPLES + DFD_CHANNEL] & 15;
    const bool is_pair = dfd.size >= DFD_SAMPLES + 2 * DFD_SAMPLE;
    *out = ktx2_find_basis_format(model, first,
                                  is_pair ? dfd.bytes[DFD_SAMPLES + DFD_SAMPLE + DFD_CHANNEL] & 15 : -1);
    if (!*out)
        return fail(
            error, FACET_ERROR_UNSUPPORTED,
            "%s: KTX2: ETC1S or UASTC was expected where vkFormat is 0, not color model %u with channel %d",
            k->name, model, first);
    if ((k->scheme == KTX2_BASISLZ) != ((*out)->kind == KTX2_ETC1S))
        return fail(error, FACET_ERROR_INVALID,
                    "%s: KTX2: supercompressionScheme: BasisLZ was expected with ETC1S only", k->name);
    return FACET_OK;
}

static facet_result read_format(span file, ktx2 *k, facet_error *error)
{
    const unsigned char *b = file.bytes;
    const uint32_t number = load_u32_le(b + VK_FORMAT), scheme = load_u32_le(b + SCHEME);
    span dfd;
    if (!get_span(file, load_u32_le(b + DFD_OFFSET), load_u32_le(b + DFD_SIZE), &dfd) ||
        dfd.size < DFD_SAMPLES + DFD_SAMPLE)
        return fail_ktx2(error, k->name, "the format descriptor is missing or outside of the file");
    if (scheme > KTX2_ZLIB)
        return fail(error, FACET_ERROR_UNSUPPORTED,
                    "%s: KTX2: supercompressionScheme: none, BasisLZ, Zstandard or zlib was expected, not %u",
                    k->name, scheme);
    k->scheme = (ktx2_scheme)scheme;
    k->is_srgb = dfd.bytes[DFD_TRANSFER] == TRANSFER_SRGB;
    k->is_premultiplied = (dfd.bytes[DFD_FLAGS] & FLAG_PREMULTIPLIED) != 0;
#ifndef HAVE_ZSTD
    if (k->scheme == KTX2_ZSTD)
        return fail(
            error, FACET_ERROR_UNSUPPORTED,
            "%s: this build of facet does not read KTX2 files compressed with Zstandard: it was built "
            "without libzstd",
            k->name);
#endif
    if (number == 0)
        return find_basis_format(k, dfd, &k->format, error);
    bool is_srgb, is_missing;
    k->format = ktx2_find_format(number, &is_srgb, &is_missing);
    if (!k->format)
        return fail(error, FACET_ERROR_UNSUPPORTED, "%s: KTX2: vkFormat %u is not supported", k->name,
                    number);
    if (is_missing)
        return fail(error, FACET_ERROR_UNSUPPORTED,
                    "%s: this build of facet does not read %s: libastcenc was missing when it was built",
                    k->name, k->format->name);
    if (k->scheme == KTX2_BASISLZ)
        return fail_ktx2(error, k->name, "supercompressionScheme: BasisLZ was expected with vkFormat 0 only");
    k->is_srgb |= is_srgb;
    return FACET_OK;
}

/* ---- metadata ---- */

/* A value of two or four characters; others are ignored. */
static void read_value(ktx2 *k, span key, span value)
{
    if (key.size == 15 && memcmp(key.bytes, "KTXorientation", 15) == 0 && value.size >= 2) {
        k->is_right_to_left = value.bytes[0] == 'l';
        k->is_bottom_up = value.bytes[1] == 'u';
    }
    if (key.size == 11 && memcmp(key.bytes, "KTXswizzle", 11) == 0 && value.size >= 4) {
        for (int c = 0; c < 4; c++)
            if (!memchr("rgba01", value.bytes[c], 6))
                return;
        memcpy(k->swizzle, value.bytes, 4);
    }
}

static facet_result read_metadata(span file, ktx2 *k, facet_error *error)
{
    span rest;
    memcpy(k->swizzle, "rgba", 4);
    if (!get_span(file, load_u32_le(file.bytes + KVD_OFFSET), load_u32_le(file.bytes + KVD_SIZE), &rest))
        return fail_ktx2(error, k->name, "the metadata is outside of the file");
    while (rest.size > 4) {
        const size_t size = load_u32_le(rest.bytes);
        if (size > rest.size - 4)
            return fail_ktx2(error, k->name, "a metadata entry is larger than the metadata");
        const unsigned char *entry = rest.bytes + 4;
        const unsigned char *zero = memchr(entry, 0, size);
        if (zero) {
            span key = {entry, (size_t)(zero - entry) + 1};
            read_value(k, key, (span){zero + 1, size - key.size});
        }
        const size_t padded = 4 + (size + 3) / 4 * 4;
        if (padded >= rest.size)
            break;
        rest = (span){rest.bytes + padded, rest.size - padded};
    }
    return FACET_OK;
}

/* ---- levels ---- */

/* Bytes of a level without supercompression; false: overflow. */
static bool get_level_size(const ktx2 *k, uint32_t level, uint64_t *size)
{
    const ktx2_format *f = k->format;
    const uint64_t columns =
        ((uint64_t)ktx2_level_edge(k->width, level) + f->block_width - 1) / f->block_width;
    const uint64_t rows =
        ((uint64_t)ktx2_level_edge(k->height, level) + f->block_height - 1) / f->block_height;
    *size = columns * rows; /* less than 2^64 */
    return !__builtin_mul_overflow(*size, (uint64_t)f->block_size * k->face_count, size) &&
           !__builtin_mul_overflow(*size, (uint64_t)k->layer_count, size);
}

/* Largest expansion of a byte: a Zstandard block repeats 128 KiB for 4 bytes; Deflate packs a run of 258 into
 * 2 bits. */
static uint64_t get_expansion(ktx2_scheme scheme)
{
    return scheme == KTX2_ZSTD ? 1 << 15 : scheme == KTX2_ZLIB ? 1032 : 1;
}

static facet_result read_levels(span file, ktx2 *k, facet_error *error)
{
    if (file.size < LEVEL_INDEX + (size_t)k->level_count * LEVEL_RECORD)
        return fail_ktx2(error, k->name, "the file ends in the index of levels");
    for (uint32_t i = 0; i < k->level_count; i++) {
        const unsigned char *record = file.bytes + LEVEL_INDEX + (size_t)i * LEVEL_RECORD;
        const uint64_t offset = load_u64_le(record), size = load_u64_le(record + 8),
                       whole = load_u64_le(record + 16);
        span level;
        if (!get_span(file, offset, size, &level))
            return fail(error, FACET_ERROR_INVALID,
                        "%s: KTX2: level %u: bytes %llu to %llu are past the end of the file (%zu bytes)",
                        k->name, i, (unsigned long long)offset, (unsigned long long)(offset + size),
                        file.size);
        k->levels[i].bytes = level.bytes;
        k->levels[i].size = level.size;
        if (k->scheme == KTX2_BASISLZ)
            continue;
        uint64_t expected;
        if (!get_level_size(k, i, &expected) || whole != expected ||
            (k->scheme == KTX2_NONE && size != expected) || expected / get_expansion(k->scheme) > size)
            return fail(
                error, FACET_ERROR_INVALID,
                "%s: KTX2: level %u: %s, %u x %u texels do not fit its %llu bytes (%llu uncompressed)",
                k->name, i, k->format->name, ktx2_level_edge(k->width, i), ktx2_level_edge(k->height, i),
                (unsigned long long)size, (unsigned long long)whole);
    }
    return FACET_OK;
}

static facet_result read_global(span file, ktx2 *k, facet_error *error)
{
    span global;
    if (!get_span(file, load_u64_le(file.bytes + SGD_OFFSET), load_u64_le(file.bytes + SGD_SIZE), &global))
        return fail_ktx2(error, k->name, "the supercompression global data is outside of the file");
    k->global = global.bytes;
    k->global_size = global.size;
    return FACET_OK;
}

facet_result ktx2_open(const void *bytes, size_t size, const char *name, ktx2 *out, facet_error *error)
{
    *out = (ktx2){0};
    ktx2 k = {.name = name};
    span file = {bytes, size};
    if (size < LEVEL_INDEX)
        return fail_ktx2(error, name, "the file ends in its header");
    if (image_codec_detect(bytes, size) != IMAGE_CODEC_KTX2)
        return fail_ktx2(error, name, "the identifier of KTX 2.0 files was expected");
    TRY(read_counts(file, &k, error));
    TRY(read_format(file, &k, error));
    TRY(read_metadata(file, &k, error));
    TRY(read_global(file, &k, error));
    TRY(read_levels(file, &k, error));
    *out = k;
    return FACET_OK;
}

/* ---- the codec ---- */

facet_result ktx2_probe(const unsigned char *bytes, size_t size, const char *name, image *header,
                        facet_error *error)
{
    ktx2 k;
    TRY(ktx2_open(bytes, size, name, &k, error));
    *header = ktx2_header(&k);
    return FACET_OK;
}

/* An edge reduced by 2^k, rounded up as in image_decode_desc. */
static uint32_t get_reduced_edge(uint32_t edge, uint32_t k)
{
    return (uint32_t)(((uint64_t)edge + (UINT64_C(1) << k) - 1) >> k);
}

/* The smallest level with the size of the reduced image; levels round down, so odd edges differ. */
static uint32_t choose_level(const ktx2 *k, uint32_t max_reduction)
{
    uint32_t level = 0;
    for (uint32_t i = 1; i <= max_reduction && i < k->level_count; i++)
        if (ktx2_level_edge(k->width, i) == get_reduced_edge(k->width, i) &&
            ktx2_level_edge(k->height, i) == get_reduced_edge(k->height, i))
            level = i;
    return level;
}

facet_result ktx2_decode_file(const unsigned char *bytes, size_t size, const char *name,
                              const image_decode_desc *desc, image *out, facet_error *error)
{
    ktx2 k;
    TRY(ktx2_open(bytes, size, name, &k, error));
    /* of the whole image, also if a smaller level is decoded */
    TRY(codec_check_size(name, k.width, k.height, desc->max_size, error));
    return ktx2_read(&k, choose_level(&k, desc->max_reduction), 0, 0, desc, out, error);
}
