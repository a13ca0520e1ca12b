/* texture_pyramid.c - see texture_pyramid.h. */
#include "draw/texture_reduce.h"

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

/* Linear values of 16-bit sRGB codes; NULL: out of memory. */
static uint16_t *make_linear(const facet_allocator *allocator, facet_error *error)
{
    uint16_t *linear = mem_alloc(allocator, 65536, sizeof *linear);
    if (!linear)
        fail_memory(error, "table of 16-bit colors", 65536 * sizeof *linear);
    for (uint32_t v = 0; linear && v < 65536; v++)
        linear[v] = (uint16_t)(srgb_decode(v / 65535.0) * 65535.0 + 0.5);
    return linear;
}

/* Makes the colors of 16-bit texels linear, in place. */
static void decode_16(uint16_t *texel, size_t texel_count, uint32_t channel_count, const uint16_t *linear)
{
    uint32_t color_count = channel_count < 3 ? 1 : 3;
    for (size_t t = 0; t < texel_count; t++, texel += channel_count)
        for (uint32_t c = 0; c < color_count; c++)
            texel[c] = linear[texel[c]];
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

/* Bytes of the levels from first on. */
static size_t levels_size(const texture_pyramid *p, uint32_t first)
{
    size_t size = 0;
    for (uint32_t level = first; level < p->level_count; level++)
        size += (size_t)level_size(p->width, level) * level_size(p->height, level) * p->channel_count *
                image_type_size(p->type);
    return size;
}

/* Sets p->levels[level] and returns where its texels go in the block *at, which advances past them. */
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

/* ---- all levels at once ---- */

enum { WINDOW_ROWS = 3 };

/* A level whose rows arrive, from the top. Only three rows of 16 bits are kept of it. */
typedef struct growing_level {
    uint32_t width, height;
    uint16_t *rows[WINDOW_ROWS]; /* row y is rows[y % WINDOW_ROWS] */
    uint32_t next_row;           /* of the next level, not made yet */
    unsigned char *out;          /* where its texels are stored; NULL: nowhere */
} growing_level;

/* All levels are made row by row at the same time: a row is made as soon as the rows it covers are there.
 * So only the result leaves the cache, and the source need not be held as a whole. */
struct texture_growth {
    texture_pyramid *pyramid;
    uint32_t source_level;
    bool as_color;
    const texture_tables *tables;
    uint16_t *work;                /* block of growth_room() values, divided into room and levels */
    uint16_t *room;                /* a row of the source */
    const unsigned char *source;   /* row y of the source is row y % source_rows here */
    size_t source_row_size;        /* bytes */
    uint32_t source_rows;          /* all, or WINDOW_ROWS while rows are added */
    unsigned char *window;         /* block of the latest rows that were added */
    uint16_t *linear;              /* block: linear values of their codes; NULL: the codes are kept */
    uint32_t added_rows, next_row; /* next_row: of the level after the source, not made yet */
    growing_level levels[TEXTURE_MAX_LEVELS];
};
typedef struct texture_growth growth;

/* Values of a row of a level, with the overrun of texture_reduce_rows(). */
static size_t row_room(const texture_pyramid *p, uint32_t level)
{
    return (size_t)level_size(p->width, level) * p->channel_count + TEXTURE_ROW_TAIL;
}

/* Number of values that a growth works in. */
static size_t growth_room(const texture_pyramid *p, uint32_t source_level)
{
    size_t count = (1 + WINDOW_ROWS) * row_room(p, source_level);
    for (uint32_t level = source_level + 1; level < p->level_count; level++)
        count += WINDOW_ROWS * row_room(p, level);
    return count;
}

/* Stores row y of a level, given in 16 bits. */
static void store_row(const growth *g, const growing_level *level, uint32_t y)
{
    const texture_pyramid *p = g->pyramid;
    const uint16_t *row = level->rows[y % WINDOW_ROWS];
    size_t count = (size_t)level->width * p->channel_count;
    if (!level->out)
        return;
    if (p->type == IMAGE_U16)
        memcpy(level->out + y * count * sizeof *row, row, count * sizeof *row);
    else
        texture_row_to_8(g->tables, g->as_color, row, level->width, p->channel_count, level->out + y * count);
}

/* Row y of a level has arrived: stores it and makes the rows of further levels that are now complete. */
static void add_row(growth *g, uint32_t number, uint32_t y)
{
    for (;;) {
        growing_level *here = &g->levels[number];
        store_row(g, here, y);
        if (number + 1 == g->pyramid->level_count)
            return;
        texture_coverage covered = texture_cover(here->height, here->next_row);
        if (y + 1 != covered.begin + covered.count)
            return;
        const uint16_t *rows[3] = {NULL, NULL, NULL};
        for (uint32_t j = 0; j < covered.count; j++)
            rows[j] = here->rows[(covered.begin + j) % WINDOW_ROWS];
        y = here->next_row++;
        number++;
        growing_level *below = &g->levels[number];
        texture_reduce_rows(rows, covered, here->width, below->width, g->pyramid->channel_count, g->room,
                            below->rows[y % WINDOW_ROWS]);
    }
}

/* Makes row y of the level after the source. */
static void make_first_row(growth *g, uint32_t y)
{
    const texture_pyramid *p = g->pyramid;
    growing_level *above = &g->levels[g->source_level];
    growing_level *below = above + 1;
    uint16_t *out = below->rows[y % WINDOW_ROWS];
    texture_coverage covered = texture_cover(above->height, y);
    const unsigned char *codes[3] = {NULL, NULL, NULL};
    for (uint32_t j = 0; j < covered.count; j++)
        codes[j] = g->source + (covered.begin + j) % g->source_rows * g->source_row_size;
    if (p->type == IMAGE_U8 && covered.count == 2 && above->width % 2 == 0) {
        texture_halve_codes(g->tables, g->as_color, codes, above->width, p->channel_count, g->room, out);
        return;
    }
    const uint16_t *rows[3] = {NULL, NULL, NULL};
    for (uint32_t j = 0; j < covered.count; j++) {
        if (p->type == IMAGE_U16) {
            rows[j] = (const uint16_t *)(const void *)codes[j];
            continue;
        }
        texture_row_from_8(g->tables, g->as_color, codes[j], above->width, p->channel_count, above->rows[j]);
        rows[j] = above->rows[j];
    }
    texture_reduce_rows(rows, covered, above->width, below->width, p->channel_count, g->room, out);
}

/* Makes and stores everything that the source's first row_count rows suffice for. */
static void grow(growth *g, uint32_t row_count)
{
    const uint32_t first = g->source_level + 1;
    for (; g->next_row < g->levels[first].height; g->next_row++) {
        texture_coverage covered = texture_cover(g->levels[g->source_level].height, g->next_row);
        if (covered.begin + covered.count > row_count)
            return;
        make_first_row(g, g->next_row);
        add_row(g, first, g->next_row);
    }
}

/* Allocates what growing p from source_level on needs, where there is a further level. On failure
 * growth_end() releases it. */
static facet_result growth_begin(growth *g, texture_pyramid *p, uint32_t source_level, bool as_color,
                                 const texture_tables *tables, const facet_allocator *allocator,
                                 facet_error *error)
{
    const uint32_t first_kept = source_level == p->first_level ? source_level + 1 : p->first_level;
    const size_t size = levels_size(p, first_kept), work_size = growth_room(p, source_level);
    *g = (growth){.pyramid = p, .source_level = source_level, .as_color = as_color, .tables = tables};
    p->blocks[1] = mem_alloc(allocator, size, 1);
    uint16_t *work = g->work = mem_alloc(allocator, work_size, sizeof *work);
    if (!p->blocks[1] || !work)
        return fail_memory(error, "texture mips", size + work_size * sizeof *work);
    g->room = work;
    work += row_room(p, source_level);
    unsigned char *at = p->blocks[1];
    for (uint32_t number = source_level; number < p->level_count; number++) {
        growing_level *level = &g->levels[number];
        level->width = level_size(p->width, number);
        level->height = level_size(p->height, number);
        for (int i = 0; i < WINDOW_ROWS; i++, work += row_room(p, number))
            level->rows[i] = work;
        if (number >= first_kept)
            level->out = place_level(p, number, &at);
    }
    g->source_row_size = (size_t)g->levels[source_level].width * p->channel_count * image_type_size(p->type);
    return FACET_OK;
}

static void growth_end(growth *g)
{
    mem_free(g->work);
    mem_free(g->window);
    mem_free(g->linear);
}

/* Images that have red usually show it early; only those without are scanned to the end. */
static bool lacks_red(const texture_pyramid *p)
{
    const texture_level *l = &p->levels[p->first_level];
    size_t count = (size_t)l->width * l->height * p->channel_count;
    for (size_t i = 0; i < count; i += p->channel_count) {
        float red = p->type == IMAGE_U8 ? (float)l->texels[i] / 255.0f
                                        : (float)((const uint16_t *)(const void *)l->texels)[i] / 65535.0f;
        if (red > TEXTURE_BLACK)
            return false;
    }
    return true;
}

/* A pyramid without levels yet. */
static texture_pyramid describe(const image *source, uint32_t width, uint32_t height, uint32_t first_level,
                                bool as_color, const texture_tables *tables)
{
    return (texture_pyramid){.width = width,
                             .height = height,
                             .texel_size = {1.0f / (float)width, 1.0f / (float)height},
                             .first_level = first_level,
                             .level_count = texture_level_count(width, height),
                             .channel_count = source->channel_count,
                             .type = source->type,
                             .color_values = as_color ? tables->color : tables->data,
                             .alpha_values = tables->data};
}

/* Whether codes must be made linear before they are averaged: only those of 8 bits have tables for that. */
static bool is_coded_16(const image *source, bool as_color)
{
    return as_color && source->type == IMAGE_U16 && source->is_srgb;
}

facet_result texture_pyramid_create(image *source, uint32_t source_level, uint32_t width, uint32_t height,
                                    uint32_t first_level, bool as_color, const texture_tables *tables,
                                    const facet_allocator *allocator, texture_pyramid *out,
                                    facet_error *error)
{
    *out = describe(source, width, height, first_level, as_color, tables);
    facet_result result = FACET_OK;
    growth g = {0};
    if (is_coded_16(source, as_color)) {
        uint16_t *linear = make_linear(allocator, error);
        if (!linear) {
            result = FACET_ERROR_MEMORY;
            goto done;
        }
        decode_16(source->pixels, (size_t)source->width * source->height, source->channel_count, linear);
        mem_free(linear);
    }
    if (source_level + 1 < out->level_count) {
        result = growth_begin(&g, out, source_level, as_color, tables, allocator, error);
        if (result != FACET_OK)
            goto done;
        g.source = source->pixels;
        g.source_rows = source->height;
        grow(&g, source->height);
    }
    if (source_level == first_level) {
        unsigned char *at = source->pixels;
        out->blocks[0] = source->pixels;
        place_level(out, source_level, &at);
        *source = (image){0};
    }

    out->lacks_red = !as_color && lacks_red(out);

done:
    growth_end(&g);
    image_destroy(source);
    if (result != FACET_OK)
        texture_pyramid_destroy(out);
    return result;
}

/* ---- row by row ---- */

facet_result texture_growth_create(const image *header, uint32_t first_level, bool as_color,
                                   const texture_tables *tables, const facet_allocator *allocator,
                                   texture_pyramid *out, texture_growth **grown, facet_error *error)
{
    *out = describe(header, header->width, header->height, first_level, as_color, tables);
    *grown = NULL;
    growth *g = mem_alloc(allocator, 1, sizeof *g);
    if (!g)
        return fail_memory(error, "texture mips", sizeof *g);
    facet_result result = growth_begin(g, out, 0, as_color, tables, allocator, error);
    if (result == FACET_OK) {
        g->source_rows = WINDOW_ROWS;
        g->source = g->window = mem_alloc(allocator, WINDOW_ROWS, g->source_row_size);
        result = g->window ? FACET_OK : fail_memory(error, "texture mips", WINDOW_ROWS * g->source_row_size);
    }
    if (result == FACET_OK && is_coded_16(header, as_color)) {
        g->linear = make_linear(allocator, error);
        result = g->linear ? FACET_OK : FACET_ERROR_MEMORY;
    }
    if (result == FACET_OK) {
        *grown = g;
        return FACET_OK;
    }
    texture_growth_destroy(g);
    texture_pyramid_destroy(out);
    return result;
}

void texture_growth_add_row(texture_growth *g, const void *texels)
{
    unsigned char *row = g->window + g->added_rows % WINDOW_ROWS * g->source_row_size;
    memcpy(row, texels, g->source_row_size);
    if (g->linear)
        decode_16((uint16_t *)(void *)row, g->pyramid->width, g->pyramid->channel_count, g->linear);
    grow(g, ++g->added_rows);
    if (g->added_rows == g->pyramid->height)
        g->pyramid->lacks_red = !g->as_color && lacks_red(g->pyramid);
}

void texture_growth_destroy(texture_growth *g)
{
    if (g)
        growth_end(g);
    mem_free(g);
}

void texture_pyramid_destroy(texture_pyramid *p)
{
    mem_free(p->blocks[0]);
    mem_free(p->blocks[1]);
    *p = (texture_pyramid){0};
}
