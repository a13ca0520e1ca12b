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

/* ---- all levels at once ---- */

enum { WINDOW_ROWS = 3 };

/* A level while its rows come, from above. Three rows of 16 bits are all that is ever held of it. */
typedef struct growing_level {
    uint32_t width, height;
    uint16_t *rows[WINDOW_ROWS]; /* row y is rows[y % WINDOW_ROWS] */
    uint32_t next_row;           /* of the level below, which is not made yet */
    unsigned char *out;          /* where its texels are kept; NULL: they are not */
} growing_level;

/* Levels are made row by row, all of them at once: as soon as a row has all that it covers of the level above, it
 * is there. So nothing but the result leaves the cache. */
typedef struct growth {
    const texture_pyramid *pyramid;
    const image *source;
    uint32_t source_level;
    bool as_color;
    const texture_tables *tables;
    uint16_t *room; /* a row of the source */
    growing_level levels[TEXTURE_MAX_LEVELS];
} growth;

/* Values of a row of a level, with what texture_reduce_rows() writes behind it. */
static size_t row_room(const texture_pyramid *p, uint32_t level)
{
    return (size_t)level_size(p->width, level) * p->channel_count + TEXTURE_ROW_TAIL;
}

/* Values that a growth works in. */
static size_t growth_room(const texture_pyramid *p, uint32_t source_level)
{
    size_t count = (1 + WINDOW_ROWS) * row_room(p, source_level);
    for (uint32_t level = source_level + 1; level < p->level_count; level++)
        count += WINDOW_ROWS * row_room(p, level);
    return count;
}

/* Keeps row y of a level that has come out in 16 bits. */
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

/* Row y of level number has come: stores it and makes the rows below that now can be made. */
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

/* Makes row y of the level below the source. */
static void make_first_row(growth *g, uint32_t y)
{
    const texture_pyramid *p = g->pyramid;
    const image *source = g->source;
    growing_level *above = &g->levels[g->source_level];
    growing_level *below = above + 1;
    uint16_t *out = below->rows[y % WINDOW_ROWS];
    texture_coverage covered = texture_cover(source->height, y);
    size_t row_count = (size_t)source->width * p->channel_count;
    if (p->type == IMAGE_U8 && covered.count == 2 && source->width % 2 == 0) {
        const unsigned char *codes = source->pixels;
        const unsigned char *const rows[2] = {codes + covered.begin * row_count,
                                              codes + (covered.begin + 1) * row_count};
        texture_halve_codes(g->tables, g->as_color, rows, source->width, p->channel_count, g->room, out);
        return;
    }
    const uint16_t *rows[3] = {NULL, NULL, NULL};
    for (uint32_t j = 0; j < covered.count; j++) {
        size_t first = (covered.begin + j) * row_count;
        if (p->type == IMAGE_U16) {
            rows[j] = (const uint16_t *)source->pixels + first;
            continue;
        }
        texture_row_from_8(g->tables, g->as_color, (const unsigned char *)source->pixels + first,
                           source->width, p->channel_count, above->rows[j]);
        rows[j] = above->rows[j];
    }
    texture_reduce_rows(rows, covered, source->width, below->width, p->channel_count, g->room, out);
}

/* Makes and stores all levels below source, which is level number source_level and there is one below.
 * work: growth_room() values. */
static void grow_levels(texture_pyramid *p, const image *source, uint32_t source_level, bool as_color,
                        const texture_tables *tables, uint16_t *work)
{
    growth g = {.pyramid = p,
                .source = source,
                .source_level = source_level,
                .as_color = as_color,
                .tables = tables,
                .room = work};
    work += row_room(p, source_level);
    unsigned char *at = p->blocks[1];
    for (uint32_t number = source_level; number < p->level_count; number++) {
        growing_level *level = &g.levels[number];
        level->width = level_size(p->width, number);
        level->height = level_size(p->height, number);
        for (int i = 0; i < WINDOW_ROWS; i++, work += row_room(p, number))
            level->rows[i] = work;
        if (number > source_level && number >= p->first_level)
            level->out = place_level(p, number, &at);
    }
    for (uint32_t y = 0; y < g.levels[source_level + 1].height; y++) {
        make_first_row(&g, y);
        add_row(&g, source_level + 1, y);
    }
}

/* Images that have red show it soon; only those without are looked at to the end. */
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
        size_t work_size = growth_room(out, source_level);
        work = mem_alloc(allocator, work_size, sizeof *work);
        if (!out->blocks[1] || !work) {
            result = fail_memory(error, "texture mips", size + work_size * sizeof *work);
            goto done;
        }
        grow_levels(out, source, source_level, as_color, tables, work);
    }
    if (keeps_source) {
        unsigned char *at = source->pixels;
        out->blocks[0] = source->pixels;
        place_level(out, source_level, &at);
        *source = (image){0};
    }

    out->lacks_red = !as_color && lacks_red(out);

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
