/* bake_ktx.c - see bake_ktx.h. Khronos, "KTX File Format Specification", versions 1 and 2.
 *
 * KTX 1's glType should be GL_UNSIGNED_INT_10F_11F_11F_REV (0x8C3B); cmgen writes GL_R11F_G11F_B10F (0x8C3A) and Filament's
 * reader takes nothing else, so that is what is written. As glFormat it takes GL_RGB, as the specification wants it. */
#include "cli/bake_ktx.h"

#include "cli/failure.h"

#include <stdlib.h>
#include <string.h>

enum {
    GL_RGB = 0x1907,
    GL_R11F_G11F_B10F = 0x8C3A,
    HEADER_SIZE = 64,
    TEXEL_SIZE = 4,
    FACES = 6,
    KTX2_WIDTH = 20,
    KTX2_LEVEL_COUNT = 40,
    KTX2_LEVELS = 80,
    KTX2_LEVEL_SIZE = 24
};

static void put(unsigned char **at, uint32_t number)
{
    for (int i = 0; i < 4; i++)
        (*at)[i] = (unsigned char)(number >> 8 * i);
    *at += 4;
}

static uint32_t get(const unsigned char *at)
{
    return (uint32_t)at[0] | (uint32_t)at[1] << 8 | (uint32_t)at[2] << 16 | (uint32_t)at[3] << 24;
}

static size_t round_up(size_t size)
{
    return (size + 3) & ~(size_t)3;
}

static size_t edge_of(uint32_t width, uint32_t level)
{
    return width >> level ? width >> level : 1;
}

/* Six faces of a level in a KTX2 file, of length bytes each; NULL: they are not there, which is a bug. */
static const unsigned char *find_level(const unsigned char *ktx2, size_t ktx2_size, uint32_t level,
                                       size_t length, facet_error *error)
{
    /* the lower half of 64 bits: six faces of 8192 texels are less than 4 GiB */
    const size_t offset = get(ktx2 + KTX2_LEVELS + (size_t)level * KTX2_LEVEL_SIZE);
    if (offset <= ktx2_size && FACES * length <= ktx2_size - offset)
        return ktx2 + offset;
    fail_with(error, FACET_ERROR_BUG, "KTX2: level %u of a cube map is not where it was expected", level);
    return NULL;
}

static void put_header(unsigned char **at, uint32_t width, uint32_t level_count, size_t pairs_size)
{
    static const unsigned char identifier[12] = {0xAB, 'K',  'T',  'X',  ' ',  '1',
                                                 '1',  0xBB, '\r', '\n', 0x1A, '\n'};
    const uint32_t fields[] = {0x04030201, /* endianness */
                               GL_R11F_G11F_B10F,
                               TEXEL_SIZE, /* glTypeSize: of a packed type the whole texel */
                               GL_RGB,
                               GL_R11F_G11F_B10F,
                               GL_RGB,
                               width,
                               width,
                               0, /* depth */
                               0, /* not an array */
                               FACES,
                               level_count,
                               (uint32_t)pairs_size};
    memcpy(*at, identifier, sizeof identifier);
    *at += sizeof identifier;
    for (size_t i = 0; i < sizeof fields / sizeof *fields; i++)
        put(at, fields[i]);
}

facet_result bake_ktx1_from_ktx2(const unsigned char *ktx2, size_t ktx2_size, const char *text,
                                 unsigned char **bytes, size_t *size, facet_error *error)
{
    const uint32_t width = get(ktx2 + KTX2_WIDTH), level_count = get(ktx2 + KTX2_LEVEL_COUNT);
    const size_t pair = text ? 3 + strlen(text) : 0; /* "sh", 0, the value without a 0 */
    const size_t pairs_size = pair ? 4 + round_up(pair) : 0;
    size_t total = HEADER_SIZE + pairs_size;
    *bytes = NULL;
    *size = 0;
    for (uint32_t level = 0; level < level_count; level++)
        total += 4 + FACES * edge_of(width, level) * edge_of(width, level) * TEXEL_SIZE;
    unsigned char *file = calloc(1, total);
    if (!file)
        return fail_with(error, FACET_ERROR_MEMORY, "out of memory: a KTX file of %zu bytes", total);
    unsigned char *at = file;
    put_header(&at, width, level_count, pairs_size);
    if (pair) {
        put(&at, (uint32_t)pair);
        memcpy(at, "sh", 3);
        memcpy(at + 3, text, pair - 3);
        at += round_up(pair);
    }
    for (uint32_t level = 0; level < level_count; level++) {
        const size_t length = edge_of(width, level) * edge_of(width, level) * TEXEL_SIZE;
        const unsigned char *texels = find_level(ktx2, ktx2_size, level, length, error);
        if (!texels) {
            free(file);
            return FACET_ERROR_BUG;
        }
        put(&at, (uint32_t)length);
        memcpy(at, texels, FACES * length);
        at += FACES * length;
    }
    *bytes = file;
    *size = total;
    return FACET_OK;
}

static void swap_bytes(unsigned char *a, unsigned char *b, size_t size)
{
    for (size_t i = 0; i < size; i++) {
        unsigned char byte = a[i];
        a[i] = b[i];
        b[i] = byte;
    }
}

facet_result bake_ktx2_mirror(unsigned char *ktx2, size_t ktx2_size, size_t texel_size, facet_error *error)
{
    const uint32_t width = get(ktx2 + KTX2_WIDTH), level_count = get(ktx2 + KTX2_LEVEL_COUNT);
    for (uint32_t level = 0; level < level_count; level++) {
        const size_t edge = edge_of(width, level), row = edge * texel_size, length = edge * row;
        const unsigned char *found = find_level(ktx2, ktx2_size, level, length, error);
        if (!found)
            return FACET_ERROR_BUG;
        unsigned char *texels = ktx2 + (found - ktx2);
        swap_bytes(texels, texels + length, length); /* +X and -X */
        for (size_t y = 0; y < FACES * edge; y++)
            for (size_t x = 0; x < edge / 2; x++)
                swap_bytes(texels + y * row + x * texel_size, texels + y * row + (edge - 1 - x) * texel_size,
                           texel_size);
    }
    return FACET_OK;
}
