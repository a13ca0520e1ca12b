/* texture_pyramid.c - see texture_pyramid.h. */
#include "cpu/texture_pyramid.h"

#include <string.h>

#include "base/memory.h"
#include "base/result.h"
#include "image/srgb.h"

/* ---- codes and values ---- */

void texture_tables_fill(texture_tables *tables)
{
    srgb_tables srgb;
    srgb_tables_prepare(&srgb);
    for (uint32_t i = 0; i < 256; i++) {
        tables->data[i] = (float)i / 255.0f;
        tables->data16[i] = (uint16_t)(257 * i);
        tables->color[i] = srgb.decoded[i];
        tables->color16[i] = (uint16_t)(srgb.decoded[i] * 65535.0f + 0.5f);
    }
    for (uint32_t v = 0; v < 65536; v++)
        tables->color_from_16[v] = srgb_encode_u8(&srgb, (float)v / 65535.0f);
}

static unsigned char data_from_16(uint32_t v)
{
    return (unsigned char)((v + 128) / 257);
}

/* Makes a 16-bit image linear, in place. */
static facet_result decode_16(image *i, const facet_allocator *allocator, facet_error *error)
{
    uint16_t *linear = mem_alloc(allocator, 65536, sizeof *linear);
    if (!linear)
        return fail_memory(error, "table of 16-bit colors", 65536 * sizeof *linear);
    for (uint32_t v = 0; v < 65536; v++)
        linear[v] = (uint16_t)(srgb_decode(v / 65535.0) * 65535.0 + 0.5);
    size_t texel_count = (size_t)i->width * i->height;
    uint32_t color_count = i->channel_count < 3 ? 1 : 3;
    uint16_t *texel = i->pixels;
    for (size_t t = 0; t < texel_count; t++, texel += i->channel_count)
        for (uint32_t c = 0; c < color_count; c++)
            texel[c] = linear[texel[c]];
    mem_free(linear);
    return FACET_OK;
}

/* ---- one level from the next finer one ---- */

/* The texels of an edge of size that texel i of the edge of the next level (max(1, size / 2)) covers: count of
 * them, from begin on; weights sum to total. An odd size = 2 n + 1 gives n texels, each of which covers 2 + 1 / n:
 * (n - i) / n of the first one, all of the second and (i + 1) / n of the third. */
typedef struct coverage {
    uint32_t begin, count, weights[3], total;
} coverage;

static coverage cover(uint32_t size, uint32_t i)
{
    if (size == 1)
        return (coverage){.begin = 0, .count = 1, .weights = {1}, .total = 1};
    if (size % 2 == 0)
        return (coverage){.begin = 2 * i, .count = 2, .weights = {1, 1}, .total = 2};
    uint32_t n = size / 2;
    return (coverage){.begin = 2 * i, .count = 3, .weights = {n - i, n, i + 1}, .total = size};
}

/* A level on its way: linear, 16 bits; or the 8-bit image that it starts from. */
typedef struct plane {
    const void *texels;
    uint32_t width, height, channel_count;
    const uint16_t *color16, *alpha16; /* 8 bits: what the codes stand for; NULL: 16 bits */
} plane;

/* Row y of source in 16 bits; in room where it has to be decoded. */
static const uint16_t *get_row(const plane *source, uint32_t y, uint16_t *room)
{
    size_t count = (size_t)source->width * source->channel_count;
    if (!source->color16)
        return (const uint16_t *)source->texels + y * count;
    const unsigned char *codes = (const unsigned char *)source->texels + y * count;
    const uint16_t *color = source->color16;
    const uint16_t *alpha = source->alpha16;
    if (color == alpha) { /* data: as data16 has it, but this vectorises */
        for (size_t i = 0; i < count; i++)
            room[i] = (uint16_t)(257 * codes[i]);
    } else if (source->channel_count % 2 == 1) {
        for (size_t i = 0; i < count; i++)
            room[i] = color[codes[i]];
    } else if (source->channel_count == 2) {
        for (size_t i = 0; i < count; i += 2) {
            room[i] = color[codes[i]];
            room[i + 1] = alpha[codes[i + 1]];
        }
    } else {
        for (size_t i = 0; i < count; i += 4) {
            room[i] = color[codes[i]];
            room[i + 1] = color[codes[i + 1]];
            room[i + 2] = color[codes[i + 2]];
            room[i + 3] = alpha[codes[i + 3]];
        }
    }
    return room;
}

/* Means of 2 x 2 texels. */
static inline __attribute__((always_inline)) void
halve_row_of(const uint16_t *a, const uint16_t *b, uint32_t width, uint32_t channel_count, uint16_t *out)
{
    for (uint32_t x = 0; x < width; x++)
        for (uint32_t c = 0; c < channel_count; c++) {
            size_t i = (size_t)2 * x * channel_count + c;
            uint32_t sum = (uint32_t)a[i] + a[i + channel_count] + b[i] + b[i + channel_count];
            out[(size_t)x * channel_count + c] = (uint16_t)((sum + 2) >> 2);
        }
}

static void halve_row(const uint16_t *a, const uint16_t *b, uint32_t width, uint32_t channel_count,
                      uint16_t *out)
{
    switch (channel_count) { /* constants let the loops unroll */
    case 1:
        halve_row_of(a, b, width, 1, out);
        break;
    case 2:
        halve_row_of(a, b, width, 2, out);
        break;
    case 3:
        halve_row_of(a, b, width, 3, out);
        break;
    default:
        halve_row_of(a, b, width, 4, out);
    }
}

/* Weighted means for edges of any size. Sums stay below 2^16 (2^32)^2: sizes are below 2^24. */
static void reduce_row(const uint16_t *const rows[3], coverage vertical, const plane *source, uint32_t width,
                       uint16_t *out)
{
    for (uint32_t x = 0; x < width; x++) {
        coverage horizontal = cover(source->width, x);
        uint64_t total = (uint64_t)horizontal.total * vertical.total;
        for (uint32_t c = 0; c < source->channel_count; c++) {
            uint64_t sum = total / 2;
            for (uint32_t j = 0; j < vertical.count; j++) {
                uint64_t row_sum = 0;
                for (uint32_t i = 0; i < horizontal.count; i++)
                    row_sum += (uint64_t)horizontal.weights[i] *
                               rows[j][(size_t)(horizontal.begin + i) * source->channel_count + c];
                sum += vertical.weights[j] * row_sum;
            }
            out[(size_t)x * source->channel_count + c] = (uint16_t)(sum / total);
        }
    }
}

/* The next coarser level of source, 16 bits. room: three rows of source. */
static void reduce(const plane *source, uint16_t *room, uint16_t *out, uint32_t width, uint32_t height)
{
    size_t row_size = (size_t)source->width * source->channel_count;
    for (uint32_t y = 0; y < height; y++) {
        coverage vertical = cover(source->height, y);
        const uint16_t *rows[3] = {NULL, NULL, NULL};
        for (uint32_t j = 0; j < vertical.count; j++)
            rows[j] = get_row(source, vertical.begin + j, room + j * row_size);
        uint16_t *out_row = out + (size_t)y * width * source->channel_count;
        if (vertical.count == 2 && source->width % 2 == 0)
            halve_row(rows[0], rows[1], width, source->channel_count, out_row);
        else
            reduce_row(rows, vertical, source, width, out_row);
    }
}

/* ---- the pyramid ---- */

static uint32_t level_size(uint32_t size, uint32_t level)
{
    return size >> level ? size >> level : 1;
}

uint32_t texture_level_count(uint32_t width, uint32_t height)
{
    uint32_t count = 1;
    for (uint32_t size = width > height ? width : height; size > 1; size >>= 1)
        count++;
    return count;
}

/* Stores a level that has come out in 16 bits. */
static void store(const texture_pyramid *p, const texture_tables *tables, bool as_color,
                  const uint16_t *texels, size_t texel_count, unsigned char *out)
{
    size_t count = texel_count * p->channel_count;
    if (p->type == IMAGE_U16) {
        memcpy(out, texels, count * sizeof *texels);
        return;
    }
    uint32_t alpha = p->channel_count % 2 == 0 ? p->channel_count - 1 : UINT32_MAX;
    if (!as_color) {
        for (size_t i = 0; i < count; i++)
            out[i] = data_from_16(texels[i]);
        return;
    }
    for (size_t i = 0; i < count; i += p->channel_count)
        for (uint32_t c = 0; c < p->channel_count; c++)
            out[i + c] = c == alpha ? data_from_16(texels[i + c]) : tables->color_from_16[texels[i + c]];
}

/* Bytes of the levels from first on. */
static size_t levels_size(const texture_pyramid *p, uint32_t first)
{
    size_t size = 0;
    for (uint32_t level = first; level < p->level_count; level++)
        size += (size_t)level_size(p->width, level) * level_size(p->height, level) * p->channel_count *
                image_type_size(p->type);
    return size;
}

/* Sets p->levels[level] and returns where its texels go in the block *at, which moves behind them. */
static unsigned char *place_level(texture_pyramid *p, uint32_t level, unsigned char **at)
{
    unsigned char *texels = *at;
    uint32_t width = level_size(p->width, level);
    uint32_t height = level_size(p->height, level);
    p->levels[level] = (texture_level){
        .texels = texels, .width = width, .height = height, .size = {(float)width, (float)height}};
    *at += (size_t)width * height * p->channel_count * image_type_size(p->type);
    return texels;
}

/* Makes and stores all levels below source, which is level number source_level; frees source once it is not
 * needed where it is not kept. work: two levels of 16 bits and three rows of source. */
static void build_levels(texture_pyramid *p, image *source, uint32_t source_level, bool as_color,
                         const texture_tables *tables, uint16_t *work)
{
    plane current = {.texels = source->pixels,
                     .width = source->width,
                     .height = source->height,
                     .channel_count = p->channel_count};
    if (p->type == IMAGE_U8) {
        current.color16 = as_color ? tables->color16 : tables->data16;
        current.alpha16 = tables->data16;
    }
    size_t row_size = (size_t)source->width * p->channel_count;
    uint16_t *room = work;
    uint16_t *here = room + 3 * row_size;
    uint16_t *there = here + (size_t)level_size(p->width, source_level + 1) *
                                 level_size(p->height, source_level + 1) * p->channel_count;
    unsigned char *at = p->blocks[1];
    for (uint32_t level = source_level + 1; level < p->level_count; level++) {
        uint32_t width = level_size(p->width, level);
        uint32_t height = level_size(p->height, level);
        reduce(&current, room, here, width, height);
        if (level == source_level + 1 && source_level < p->first_level)
            image_destroy(source);
        if (level >= p->first_level)
            store(p, tables, as_color, here, (size_t)width * height, place_level(p, level, &at));
        current =
            (plane){.texels = here, .width = width, .height = height, .channel_count = p->channel_count};
        uint16_t *swap = here;
        here = there;
        there = swap;
    }
}

facet_result texture_pyramid_create(image *source, uint32_t source_level, uint32_t width, uint32_t height,
                                    uint32_t first_level, bool as_color, const texture_tables *tables,
                                    const facet_allocator *allocator, texture_pyramid *out,
                                    facet_error *error)
{
    *out = (texture_pyramid){.width = width,
                             .height = height,
                             .texel_size = {1.0f / (float)width, 1.0f / (float)height},
                             .first_level = first_level,
                             .level_count = texture_level_count(width, height),
                             .channel_count = source->channel_count,
                             .type = source->type,
                             .color_values = as_color ? tables->color : tables->data,
                             .alpha_values = tables->data};
    facet_result result = FACET_OK;
    uint16_t *work = NULL;
    if (as_color && source->type == IMAGE_U16 && source->is_srgb) {
        result = decode_16(source, allocator, error);
        if (result != FACET_OK)
            goto done;
    }
    bool keeps_source = source_level == first_level;
    if (source_level + 1 < out->level_count) {
        size_t size = levels_size(out, keeps_source ? source_level + 1 : first_level);
        out->blocks[1] = mem_alloc(allocator, size, 1);
        size_t level_1 = (size_t)level_size(width, source_level + 1) * level_size(height, source_level + 1);
        size_t work_size = (level_1 + level_1 / 2 + 1 + 3 * (size_t)source->width) * source->channel_count;
        work = mem_alloc(allocator, work_size, sizeof *work);
        if (!out->blocks[1] || !work) {
            result = fail_memory(error, "texture mips", size + work_size * sizeof *work);
            goto done;
        }
        build_levels(out, source, source_level, as_color, tables, work);
    }
    if (keeps_source) {
        unsigned char *at = source->pixels;
        out->blocks[0] = source->pixels;
        place_level(out, source_level, &at);
        *source = (image){0};
    }

done:
    mem_free(work);
    image_destroy(source);
    if (result != FACET_OK)
        texture_pyramid_destroy(out);
    return result;
}

void texture_pyramid_destroy(texture_pyramid *p)
{
    mem_free(p->blocks[0]);
    mem_free(p->blocks[1]);
    *p = (texture_pyramid){0};
}
