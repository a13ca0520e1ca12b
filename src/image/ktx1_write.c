/* ktx1_write.c - see ktx_write.h.
 *
 * glType should be GL_UNSIGNED_INT_10F_11F_11F_REV (0x8C3B), but Filament's cmgen writes GL_R11F_G11F_B10F
 * (0x8C3A) and its reader accepts nothing else, so that is written. glFormat is GL_RGB, as in the
 * specification. */
#include "image/ktx_write.h"

#include <string.h>

#include "base/memory.h"
#include "base/parallel.h"
#include "base/result.h"
#include "image/codec.h"

enum {
    GL_RGB = 0x1907,
    GL_R11F_G11F_B10F = 0x8C3A,
    IDENTIFIER_SIZE = 12,
    HEADER_SIZE = 64,
    TEXEL_SIZE = 4,
    FACES = 6,
    MAX_LEVELS = 32,
    GRAIN_TEXELS = 16384
};

typedef struct writing {
    const ktx1_write_desc *desc;
    uint32_t edge;     /* of the level being packed */
    uint32_t level;    /* its index */
    unsigned char *to; /* its texels */
} writing;

static size_t round_up(size_t size)
{
    return (size + 3) / 4 * 4;
}

/* Rows of the six faces of a level. */
static void pack_rows(void *context, size_t begin, size_t end)
{
    const writing *w = context;
    for (size_t i = begin; i < end; i++) {
        const facet_image_view *v = &w->desc->images[w->level * FACES + i / w->edge];
        const float *row = (const float *)((const char *)v->pixels + i % w->edge * v->row_stride_bytes);
        ktx2_pack(FACET_TEXEL_FORMAT_B10G11R11, row, v->channel_count, w->edge, true,
                  w->to + i * w->edge * TEXEL_SIZE);
    }
}

static facet_result check(const ktx1_write_desc *d, facet_error *error)
{
    const uint32_t edge = d->images[0].width;
    if (d->level_count == 0 || d->level_count > MAX_LEVELS || edge >> (d->level_count - 1) == 0)
        return fail(error, FACET_ERROR_ARGUMENT, "KTX: %u texels do not have %u levels", edge,
                    d->level_count);
    for (uint32_t i = 0; i < FACES * d->level_count; i++) {
        const facet_image_view *v = &d->images[i];
        const uint32_t wanted = edge >> i / FACES;
        if (v->width != wanted || v->height != wanted || v->channel_count == 0 || v->channel_count > 4)
            return fail(error, FACET_ERROR_ARGUMENT,
                        "KTX: level %u, face %u: %u x %u texels of %u channels where %u x %u of 1 to 4 were "
                        "expected",
                        i / FACES, i % FACES, v->width, v->height, v->channel_count, wanted, wanted);
    }
    return FACET_OK;
}

/* Bytes of a face. False: more than the format or size_t can express. */
static bool face_size(uint32_t edge, size_t *size)
{
    return checked_mul(edge, edge, size) && checked_mul(*size, TEXEL_SIZE, size) && *size <= UINT32_MAX;
}

static bool file_size(const ktx1_write_desc *d, size_t pair_size, size_t *size)
{
    *size = HEADER_SIZE + pair_size;
    for (uint32_t i = 0; i < d->level_count; i++) {
        size_t face, level;
        if (!face_size(d->images[0].width >> i, &face) || !checked_mul(face, FACES, &level) ||
            !checked_add(level, 4, &level) || !checked_add(*size, level, size))
            return false;
    }
    return true;
}

static void put_header(const ktx1_write_desc *d, size_t pair_size, unsigned char *bytes)
{
    const uint32_t edge = d->images[0].width;
    const uint32_t words[] = {0x04030201, /* endianness */
                              GL_R11F_G11F_B10F,
                              TEXEL_SIZE, /* glTypeSize: a packed texel is one word */
                              GL_RGB,
                              GL_R11F_G11F_B10F,
                              GL_RGB,
                              edge,
                              edge,
                              0, /* depth */
                              0, /* not an array */
                              FACES,
                              d->level_count,
                              (uint32_t)pair_size};
    memcpy(bytes, "\xabKTX 11\xbb\r\n\x1a\n", IDENTIFIER_SIZE);
    for (size_t i = 0; i < sizeof words / sizeof *words; i++)
        store_u32_le(bytes + IDENTIFIER_SIZE + 4 * i, words[i]);
}

/* bytes: pair_size of them, 0. */
static void put_pair(const ktx1_write_desc *d, unsigned char *bytes)
{
    const size_t key_size = strlen(d->key) + 1, value_size = strlen(d->value);
    store_u32_le(bytes, (uint32_t)(key_size + value_size));
    memcpy(bytes + 4, d->key, key_size);
    memcpy(bytes + 4 + key_size, d->value, value_size);
}

facet_result ktx1_write_cube(const ktx1_write_desc *desc, unsigned char **bytes, size_t *size,
                             facet_error *error)
{
    *bytes = NULL;
    *size = 0;
    TRY(check(desc, error));
    const size_t pair_size = desc->key ? 4 + round_up(strlen(desc->key) + 1 + strlen(desc->value)) : 0;
    size_t total, at = HEADER_SIZE + pair_size;
    if (!file_size(desc, pair_size, &total))
        return fail_memory(error, "KTX file", SIZE_MAX);
    unsigned char *file = mem_alloc(&desc->allocator, total, 1);
    if (!file)
        return fail_memory(error, "KTX file", total);
    memset(file, 0, at);
    put_header(desc, pair_size, file);
    if (desc->key)
        put_pair(desc, file + HEADER_SIZE);
    for (uint32_t level = 0; level < desc->level_count; level++) {
        writing w = {.desc = desc, .level = level, .edge = desc->images[0].width >> level};
        const size_t face = (size_t)w.edge * w.edge * TEXEL_SIZE;
        store_u32_le(file + at, (uint32_t)face); /* for cube maps that are not arrays, the size of one face */
        w.to = file + at + 4;
        parallel_for(desc->thread_count, (size_t)FACES * w.edge, 1 + GRAIN_TEXELS / w.edge, pack_rows, &w);
        at += 4 + FACES * face;
    }
    *bytes = file;
    *size = total;
    return FACET_OK;
}
