/* ktx2_write.c - see ktx_write.h. Order of the file: header, index of levels, format descriptor, metadata,
 * levels from smallest to largest. */
#include "image/ktx_write.h"

#include <string.h>

#ifdef HAVE_ZSTD
#include <zstd.h>
#endif

#include "base/memory.h"
#include "base/parallel.h"
#include "base/result.h"
#include "image/codec.h"
#include "image/ktx2.h"

enum { HEADER_SIZE = 80, LEVEL_RECORD = 24, GRAIN_TEXELS = 16384, MAX_ZSTD_LEVEL = 19 };

/* Output position in preallocated memory. */
typedef struct output {
    unsigned char *bytes;
    size_t at;
} output;

static void put_u32(output *o, uint32_t x)
{
    store_u32_le(o->bytes + o->at, x);
    o->at += 4;
}

static void put_u64(output *o, uint64_t x)
{
    put_u32(o, (uint32_t)x);
    put_u32(o, (uint32_t)(x >> 32));
}

static size_t align_up(size_t x, size_t unit)
{
    return (x + unit - 1) / unit * unit;
}

/* ---- the format descriptor: one basic descriptor block (KDF section 5) ---- */

enum {
    KDF_HEADER = 28, /* total size and the block before its samples */
    KDF_SAMPLE = 16,
    KDF_VERSION = 2, /* 1.3 */
    KDF_MODEL_RGBSDA = 1,
    KDF_PRIMARIES_BT709 = 1,
    KDF_TRANSFER_LINEAR = 1,
    KDF_ALPHA = 15, /* channels: R 0, G 1, B 2 */
    KDF_EXPONENT = 0x20,
    KDF_SIGNED = 0x40,
    KDF_FLOAT = 0x80
};

static const uint32_t one_bits = 0x3f800000, minus_one_bits = 0xbf800000;

static uint32_t count_samples(facet_texel_format format)
{
    return format == FACET_TEXEL_FORMAT_RGB9E5 ? 6 : ktx2_find_texel(format)->component_count;
}

static void put_sample(output *o, uint32_t first_bit, uint32_t bit_count, uint32_t channel, uint32_t lower,
                       uint32_t upper)
{
    put_u32(o, first_bit | (bit_count - 1) << 16 | channel << 24);
    put_u32(o, 0); /* position in the texel block */
    put_u32(o, lower);
    put_u32(o, upper);
}

/* lower and upper are the codes of the nominal range: -1 and 1 for floats, or 0 and 1 without a sign. RGB9E5
 * has a sample of digits and one of the exponent for each channel; 1 is the digits 256 with the exponent 16,
 * and the lower of an exponent is its bias (KDF section 5, "R9G9B9E5"). */
static void put_samples(output *o, facet_texel_format format)
{
    const ktx2_texel *t = ktx2_find_texel(format);
    if (format == FACET_TEXEL_FORMAT_RGB9E5) {
        for (uint32_t c = 0; c < 3; c++) {
            put_sample(o, 9 * c, 9, c, 0, 16 << 9 | 256);
            put_sample(o, 27, 5, c | KDF_EXPONENT, 15, 31);
        }
    } else if (format == FACET_TEXEL_FORMAT_B10G11R11) {
        put_sample(o, 0, 11, 0 | KDF_FLOAT, 0, one_bits);
        put_sample(o, 11, 11, 1 | KDF_FLOAT, 0, one_bits);
        put_sample(o, 22, 10, 2 | KDF_FLOAT, 0, one_bits);
    } else {
        const uint32_t bits = 8 * t->type_size;
        for (uint32_t c = 0; c < t->component_count; c++)
            put_sample(o, bits * c, bits, (c == 3 ? KDF_ALPHA : c) | KDF_FLOAT | KDF_SIGNED, minus_one_bits,
                       one_bits);
    }
}

static size_t descriptor_size(facet_texel_format format)
{
    return KDF_HEADER + KDF_SAMPLE * (size_t)count_samples(format);
}

/* Linear, BT.709, alpha straight. */
static void put_descriptor(output *o, facet_texel_format format)
{
    const uint32_t size = (uint32_t)descriptor_size(format);
    put_u32(o, size);
    put_u32(o, 0); /* Khronos' basic block */
    put_u32(o, KDF_VERSION | (size - 4) << 16);
    put_u32(o, KDF_MODEL_RGBSDA | KDF_PRIMARIES_BT709 << 8 | KDF_TRANSFER_LINEAR << 16); /* alpha straight */
    put_u32(o, 0);                             /* a block is 1 x 1 x 1 x 1 texels */
    put_u32(o, ktx2_find_texel(format)->size); /* in one plane */
    put_u32(o, 0);
    put_samples(o, format);
}

/* ---- metadata ---- */

/* Sorted by key, as required. */
typedef struct metadata {
    const char *keys[2], *values[2];
} metadata;

static metadata make_metadata(const ktx2_write_desc *desc)
{
    return (metadata){{"KTXorientation", "KTXwriter"}, {"rd", desc->writer}};
}

static size_t entry_size(const metadata *m, int i)
{
    return strlen(m->keys[i]) + 1 + strlen(m->values[i]) + 1;
}

static size_t metadata_size(const metadata *m)
{
    return 4 + align_up(entry_size(m, 0), 4) + 4 + align_up(entry_size(m, 1), 4);
}

static void put_metadata(output *o, const metadata *m)
{
    for (int i = 0; i < 2; i++) {
        const size_t size = entry_size(m, i), key_size = strlen(m->keys[i]) + 1;
        put_u32(o, (uint32_t)size);
        memset(o->bytes + o->at, 0, align_up(size, 4));
        memcpy(o->bytes + o->at, m->keys[i], key_size);
        memcpy(o->bytes + o->at + key_size, m->values[i], size - key_size);
        o->at += align_up(size, 4);
    }
}

/* ---- levels ---- */

typedef struct level {
    size_t offset, whole_size; /* offset of its packed texels */
    unsigned char *compressed; /* NULL: none */
    size_t size, file_offset;  /* in the file */
} level;

typedef struct writing {
    const ktx2_write_desc *desc;
    const ktx2_texel *texel;
    uint32_t width, height;
    size_t start;     /* offset of the first level in the file */
    size_t alignment; /* alignment of levels in the file */
    level levels[KTX2_MAX_LEVELS];
    /* packed texels of all levels: the file itself, or a separate buffer if they are compressed */
    unsigned char *packed;
    bool has_failed[KTX2_MAX_LEVELS];
    uint32_t packing; /* the level being packed by pack_rows() */
} writing;

/* Rows of all faces of a level. */
static void pack_rows(void *context, size_t begin, size_t end)
{
    const writing *w = context;
    const ktx2_write_desc *d = w->desc;
    const uint32_t width = ktx2_level_edge(w->width, w->packing);
    const uint32_t height = ktx2_level_edge(w->height, w->packing);
    unsigned char *to = w->packed + w->levels[w->packing].offset;
    for (size_t i = begin; i < end; i++) {
        const facet_image_view *v = &d->images[w->packing * d->face_count + i / height];
        const float *row = (const float *)((const char *)v->pixels + i % height * v->row_stride_bytes);
        ktx2_pack(d->format, row, v->channel_count, width, d->is_opaque, to + i * width * w->texel->size);
    }
}

static void pack_levels(writing *w)
{
    for (w->packing = 0; w->packing < w->desc->level_count; w->packing++) {
        const size_t rows = (size_t)w->desc->face_count * ktx2_level_edge(w->height, w->packing);
        parallel_for(w->desc->thread_count, rows, 1 + GRAIN_TEXELS / ktx2_level_edge(w->width, w->packing),
                     pack_rows, w);
    }
}

/* Sizes and offsets of the packed levels from first on; false: overflow. */
static bool place_levels(writing *w, size_t first, size_t alignment, size_t *end)
{
    size_t at = first;
    for (uint32_t i = w->desc->level_count; i-- > 0;) {
        level *l = &w->levels[i];
        size_t padded;
        if (!checked_mul(ktx2_level_edge(w->width, i), ktx2_level_edge(w->height, i), &l->whole_size) ||
            !checked_mul(l->whole_size, (size_t)w->desc->face_count * w->texel->size, &l->whole_size) ||
            !checked_add(at, alignment, &padded))
            return false;
        l->offset = align_up(at, alignment);
        if (!checked_add(l->offset, l->whole_size, &at))
            return false;
    }
    *end = at;
    return true;
}

#ifdef HAVE_ZSTD
/* Upper bound of the memory that Zstandard allocates with malloc to compress size bytes at a level (measured
 * with 1.5.5: at most 27 times the size for 100 kB, and the limits of its window and tables). */
static ptrdiff_t zstd_memory(size_t size, uint32_t zstd_level)
{
    const size_t limit_mib = zstd_level <= 6 ? 4 : zstd_level <= 8 ? 8 : zstd_level <= 11 ? 28 : 96;
    const size_t limit = limit_mib << 20;
    return (ptrdiff_t)((256u << 10) + (size < limit / 28 ? 28 * size : limit));
}

static bool compress_level(const writing *w, level *l)
{
    const facet_allocator *allocator = &w->desc->allocator;
    const ptrdiff_t library_memory = zstd_memory(l->whole_size, w->desc->zstd_level);
    const size_t bound = ZSTD_compressBound(l->whole_size);
    if (ZSTD_isError(bound) || !mem_account(allocator, library_memory))
        return false;
    l->compressed = mem_alloc(allocator, bound, 1);
    ZSTD_CCtx *context = l->compressed ? ZSTD_createCCtx() : NULL;
    if (context)
        l->size = ZSTD_compressCCtx(context, l->compressed, bound, w->packed + l->offset, l->whole_size,
                                    (int)w->desc->zstd_level);
    const bool is_done = context && !ZSTD_isError(l->size);
    ZSTD_freeCCtx(context);
    mem_account(allocator, -library_memory);
    return is_done;
}
#else
static bool compress_level(const writing *w, level *l)
{
    (void)w, (void)l;
    return false; /* refused by check() */
}
#endif

static void compress_levels(void *context, size_t begin, size_t end)
{
    writing *w = context;
    for (size_t i = begin; i < end; i++)
        w->has_failed[i] = !compress_level(w, &w->levels[i]);
}

/* ---- the file ---- */

static facet_result check(const ktx2_write_desc *d, facet_error *error)
{
    const uint32_t width = d->images[0].width, height = d->images[0].height;
    const uint32_t larger = width > height ? width : height;
    if ((unsigned)d->format > FACET_TEXEL_FORMAT_R32F)
        return fail(error, FACET_ERROR_ARGUMENT, "KTX2: %u is not a facet_texel_format", (unsigned)d->format);
    if (width == 0 || height == 0 || (d->face_count != 1 && d->face_count != 6) ||
        (d->face_count == 6 && width != height))
        return fail(error, FACET_ERROR_ARGUMENT,
                    "KTX2: one image or the six square ones of a cube were expected, not %u of %u x %u",
                    d->face_count, width, height);
    if (d->level_count == 0 || d->level_count > KTX2_MAX_LEVELS || larger >> (d->level_count - 1) == 0)
        return fail(error, FACET_ERROR_ARGUMENT, "KTX2: %u x %u texels do not have %u levels", width, height,
                    d->level_count);
    for (uint32_t i = 0; i < d->level_count * d->face_count; i++) {
        const facet_image_view *v = &d->images[i];
        const uint32_t l = i / d->face_count;
        if (v->width != ktx2_level_edge(width, l) || v->height != ktx2_level_edge(height, l) ||
            v->channel_count == 0 || v->channel_count > 4)
            return fail(error, FACET_ERROR_ARGUMENT,
                        "KTX2: level %u, face %u: %u x %u texels of %u channels where %u x %u of 1 to 4 were "
                        "expected",
                        l, i % d->face_count, v->width, v->height, v->channel_count,
                        ktx2_level_edge(width, l), ktx2_level_edge(height, l));
    }
    if (d->zstd_level > MAX_ZSTD_LEVEL)
        return fail(error, FACET_ERROR_ARGUMENT, "KTX2: Zstandard level %u: 1 to %d were expected",
                    d->zstd_level, MAX_ZSTD_LEVEL);
#ifndef HAVE_ZSTD
    if (d->zstd_level)
        return fail(
            error, FACET_ERROR_UNSUPPORTED,
            "this build of facet does not write KTX2 files compressed with Zstandard: it was built without "
            "libzstd");
#endif
    return FACET_OK;
}

/* Writes everything before the levels, whose offsets are known. */
static void put_front(const writing *w, const metadata *m, unsigned char *bytes)
{
    const ktx2_write_desc *d = w->desc;
    const size_t index_end = HEADER_SIZE + LEVEL_RECORD * (size_t)d->level_count;
    output o = {bytes, 12};
    memcpy(bytes, "\xabKTX 20\xbb\r\n\x1a\n", 12);
    const uint32_t words[] = {w->texel->vk_format,
                              w->texel->type_size,
                              w->width,
                              w->height,
                              0, /* depth */
                              0, /* layers: no array */
                              d->face_count,
                              d->level_count,
                              d->zstd_level ? KTX2_ZSTD : KTX2_NONE,
                              (uint32_t)index_end,
                              (uint32_t)descriptor_size(d->format),
                              (uint32_t)(index_end + descriptor_size(d->format)),
                              (uint32_t)metadata_size(m)};
    for (size_t i = 0; i < sizeof words / sizeof *words; i++)
        put_u32(&o, words[i]);
    put_u64(&o, 0); /* no global data of a supercompression */
    put_u64(&o, 0);
    for (uint32_t i = 0; i < d->level_count; i++) {
        put_u64(&o, w->levels[i].file_offset);
        put_u64(&o, w->levels[i].size);
        put_u64(&o, w->levels[i].whole_size);
    }
    put_descriptor(&o, d->format);
    put_metadata(&o, m);
    memset(bytes + o.at, 0, w->start - o.at);
}

/* Writes uncompressed levels, packed in place. */
static facet_result write_plain(writing *w, unsigned char **bytes, size_t *size, facet_error *error)
{
    if (!place_levels(w, w->start, w->alignment, size))
        return fail_memory(error, "KTX2 file", SIZE_MAX);
    *bytes = mem_alloc(&w->desc->allocator, *size, 1);
    if (!*bytes)
        return fail_memory(error, "KTX2 file", *size);
    w->packed = *bytes;
    for (uint32_t i = 0; i < w->desc->level_count; i++) {
        level *l = &w->levels[i];
        const size_t end = i ? w->levels[i - 1].offset : *size;
        memset(*bytes + l->offset + l->whole_size, 0, end - l->offset - l->whole_size);
        l->file_offset = l->offset;
        l->size = l->whole_size;
    }
    pack_levels(w);
    return FACET_OK;
}

static facet_result write_compressed(writing *w, unsigned char **bytes, size_t *size, facet_error *error)
{
    size_t packed_size;
    if (!place_levels(w, 0, 1, &packed_size))
        return fail_memory(error, "KTX2 file", SIZE_MAX);
    w->packed = mem_alloc(&w->desc->allocator, packed_size, 1);
    if (!w->packed)
        return fail_memory(error, "KTX2 levels", packed_size);
    pack_levels(w);
    parallel_for(w->desc->thread_count, w->desc->level_count, 1, compress_levels, w);
    mem_free(w->packed);
    *size = w->start;
    for (uint32_t i = w->desc->level_count; i-- > 0;) {
        if (w->has_failed[i])
            return fail_memory(error, "Zstandard", w->levels[i].whole_size);
        w->levels[i].file_offset = *size;
        *size += w->levels[i].size;
    }
    *bytes = mem_alloc(&w->desc->allocator, *size, 1);
    if (!*bytes)
        return fail_memory(error, "KTX2 file", *size);
    for (uint32_t i = 0; i < w->desc->level_count; i++)
        memcpy(*bytes + w->levels[i].file_offset, w->levels[i].compressed, w->levels[i].size);
    return FACET_OK;
}

facet_result ktx2_write(const ktx2_write_desc *desc, unsigned char **bytes, size_t *size, facet_error *error)
{
    *bytes = NULL;
    *size = 0;
    TRY(check(desc, error));
    const metadata m = make_metadata(desc);
    writing w = {.desc = desc,
                 .texel = ktx2_find_texel(desc->format),
                 .width = desc->images[0].width,
                 .height = desc->images[0].height};
    const size_t front = HEADER_SIZE + LEVEL_RECORD * (size_t)desc->level_count +
                         descriptor_size(desc->format) + metadata_size(&m);
    /* The least common multiple of 4 and the size of a texel, which is 2 or a multiple of 4. */
    w.alignment = desc->zstd_level ? 1 : w.texel->size < 4 ? 4 : w.texel->size;
    w.start = align_up(front, w.alignment);
    facet_result result =
        desc->zstd_level ? write_compressed(&w, bytes, size, error) : write_plain(&w, bytes, size, error);
    for (uint32_t i = 0; i < desc->level_count; i++)
        mem_free(w.levels[i].compressed);
    if (result == FACET_OK)
        put_front(&w, &m, *bytes);
    else
        *size = 0;
    return result;
}
