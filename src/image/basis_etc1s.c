/* basis_etc1s.c - see basis_etc1s.h: global data, codebooks, and blocks to texels. */
#include "image/basis_etc1s.h"

#include <string.h>

#include "base/memory.h"
#include "base/result.h"
#include "image/block.h"
#include "image/codec.h"

/* ---- slices ---- */

enum { END_PREDICTION, END_DELTA, SELECTOR, SELECTOR_RUN }; /* tables of the codebook */
enum {
    PREDICTIONS_REPEAT = 256, /* the symbol after those of four 2-bit predictions */
    PREDICTIONS_MIN_RUN = 3,
    SELECTOR_MIN_RUN = 3,
    SELECTOR_LONG_RUN = 63,
    MAX_HISTORY = 8191
};

/* State of reading the blocks of a slice. */
typedef struct slice {
    const etc1s_codebook *c;
    bit_reader bits;
    huffman tables[ETC1S_TABLE_COUNT]; /* copies, because reading records damage in them */
    uint32_t columns;
    uint32_t last_end;
    uint32_t predictions, prediction_run; /* of the last 2 x 2 blocks */
    uint32_t selector_run;
    uint32_t rover; /* position of the next selector in the history */
    uint16_t history[MAX_HISTORY];
} slice;

/* The predictions of 2 x 2 blocks, two bits each: left above, right above, left below, right below. */
static uint32_t read_predictions(slice *s)
{
    if (s->prediction_run > 0) {
        s->prediction_run--;
        return s->predictions;
    }
    uint32_t symbol = huffman_read(&s->bits, &s->tables[END_PREDICTION]);
    if (symbol == PREDICTIONS_REPEAT)
        s->prediction_run = bits_read_vlc(&s->bits, 4) + PREDICTIONS_MIN_RUN - 1;
    else
        s->predictions = symbol & 255;
    return s->predictions;
}

/* Reads the block at block; the blocks before it have been read. */
static bool read_end(slice *s, uint32_t prediction, uint32_t x, uint32_t y, etc1s_block *block)
{
    uint32_t end = s->last_end;
    switch (prediction) {
    case 0:
        if (x == 0)
            return false;
        break;
    case 1:
        if (y == 0)
            return false;
        end = (block - s->columns)->end;
        break;
    case 2:
        if (x == 0 || y == 0)
            return false;
        end = (block - s->columns - 1)->end;
        break;
    default:
        end += huffman_read(&s->bits, &s->tables[END_DELTA]);
        if (end >= s->c->end_count)
            end -= s->c->end_count;
        if (end >= s->c->end_count)
            return false;
        break;
    }
    block->end = (uint16_t)end;
    s->last_end = end;
    return true;
}

/* Approximate move-to-front: a used entry is swapped with the one at half its index; new entries replace
 * those of the back half in turn. */
static uint16_t use_history(slice *s, uint32_t index)
{
    uint16_t selector = s->history[index];
    s->history[index] = s->history[index / 2];
    s->history[index / 2] = selector;
    return selector;
}

static void add_history(slice *s, uint32_t selector)
{
    if (s->c->history_size == 0)
        return;
    s->history[s->rover++] = (uint16_t)selector;
    if (s->rover == s->c->history_size)
        s->rover = s->c->history_size / 2;
}

static bool read_selector(slice *s, etc1s_block *block)
{
    const uint32_t first_history = s->c->selector_count, run_symbol = first_history + s->c->history_size;
    uint32_t symbol = first_history;
    if (s->selector_run > 0) {
        s->selector_run--;
    } else {
        symbol = huffman_read(&s->bits, &s->tables[SELECTOR]);
        if (symbol == run_symbol) {
            uint32_t run = huffman_read(&s->bits, &s->tables[SELECTOR_RUN]);
            if (run == SELECTOR_LONG_RUN)
                run = bits_read_vlc(&s->bits, 7);
            s->selector_run = run + SELECTOR_MIN_RUN - 1;
            symbol = first_history;
        }
    }
    if (symbol < first_history) {
        add_history(s, symbol);
        block->selector = (uint16_t)symbol;
        return true;
    }
    if (symbol - first_history >= s->c->history_size)
        return false;
    block->selector = use_history(s, symbol - first_history);
    return true;
}

static bool read_blocks(slice *s, uint32_t rows, etc1s_block *blocks, unsigned char *below)
{
    etc1s_block *block = blocks;
    uint32_t predictions = 0;
    for (uint32_t y = 0; y < rows; y++) {
        for (uint32_t x = 0; x < s->columns; x++, block++) {
            if (x % 2 == 0 && y % 2 == 0) {
                predictions = read_predictions(s);
                below[x / 2] = (unsigned char)(predictions >> 4);
            } else if (x % 2 == 0) {
                predictions = below[x / 2];
            }
            if (!read_end(s, predictions & 3, x, y, block) || !read_selector(s, block))
                return false;
            predictions >>= 2;
        }
        if (s->bits.is_past_end)
            return false;
    }
    return true;
}

facet_result etc1s_decode_slice(const etc1s_codebook *c, const unsigned char *bytes, size_t size,
                                uint32_t columns, uint32_t rows, const char *name,
                                const facet_allocator *allocator, etc1s_block *blocks, facet_error *error)
{
    slice *s = mem_zalloc(allocator, 1, sizeof *s);
    unsigned char *below = mem_alloc(allocator, ((size_t)columns + 1) / 2, 1);
    facet_result result = FACET_OK;
    if (!s || !below) {
        result = fail_memory(error, "BasisLZ slice", sizeof *s);
    } else {
        s->c = c;
        s->bits = bits_open(bytes, size);
        s->columns = columns;
        s->rover = c->history_size / 2;
        memcpy(s->tables, c->tables, sizeof s->tables);
        bool is_read = read_blocks(s, rows, blocks, below);
        for (int i = 0; i < ETC1S_TABLE_COUNT; i++)
            is_read = is_read && !s->tables[i].is_damaged;
        if (!is_read)
            result = fail(error, FACET_ERROR_INVALID, "%s: KTX2: a BasisLZ slice is damaged", name);
    }
    mem_free(below);
    mem_free(s);
    return result;
}

/* ---- global data ---- */

/* The four parts after the records of images. */
typedef struct parts {
    bit_reader ends, selectors, tables;
    uint32_t end_count, selector_count;
} parts;

static facet_result fail_global(facet_error *error, const char *name, const char *what)
{
    return fail(error, FACET_ERROR_INVALID, "%s: KTX2: BasisLZ global data: %s", name, what);
}

static facet_result find_parts(const unsigned char *global, size_t size, uint64_t image_count,
                               const char *name, parts *out, facet_error *error)
{
    if (size < ETC1S_GLOBAL_HEADER || image_count > (size - ETC1S_GLOBAL_HEADER) / ETC1S_IMAGE_RECORD)
        return fail_global(error, name, "is too small for the images of the file");
    const uint64_t sizes[3] = {load_u32_le(global + 4), load_u32_le(global + 8), load_u32_le(global + 12)};
    const size_t first = ETC1S_GLOBAL_HEADER + (size_t)image_count * ETC1S_IMAGE_RECORD;
    if (sizes[0] + sizes[1] + sizes[2] > size - first)
        return fail_global(error, name, "its parts are larger than the whole");
    const unsigned char *bytes = global + first;
    *out = (parts){.ends = bits_open(bytes, (size_t)sizes[0]),
                   .selectors = bits_open(bytes + sizes[0], (size_t)sizes[1]),
                   .tables = bits_open(bytes + sizes[0] + sizes[1], (size_t)sizes[2]),
                   .end_count = global[0] | (uint32_t)global[1] << 8,
                   .selector_count = global[2] | (uint32_t)global[3] << 8};
    if (out->end_count == 0 || out->selector_count == 0)
        return fail_global(error, name, "a codebook without entries");
    return FACET_OK;
}

facet_result etc1s_read_image(const unsigned char *global, size_t size, uint64_t image_count, uint64_t index,
                              const char *name, etc1s_image *out, facet_error *error)
{
    *out = (etc1s_image){0};
    if (size < ETC1S_GLOBAL_HEADER || image_count > (size - ETC1S_GLOBAL_HEADER) / ETC1S_IMAGE_RECORD)
        return fail_global(error, name, "is too small for the images of the file");
    const unsigned char *record = global + ETC1S_GLOBAL_HEADER + (size_t)index * ETC1S_IMAGE_RECORD;
    *out = (etc1s_image){load_u32_le(record), load_u32_le(record + 4), load_u32_le(record + 8),
                         load_u32_le(record + 12), load_u32_le(record + 16)};
    return FACET_OK;
}

/* ---- codebooks ---- */

/* Colors and tables, each as a difference from the one before; the last value selects one of three codes. */
static bool read_ends(bit_reader *b, huffman models[4], etc1s_codebook *c)
{
    for (int i = 0; i < 4; i++)
        if (!huffman_read_table(b, &models[i]))
            return false;
    const bool is_grey = bits_read(b, 1) != 0;
    etc1s_end last = {{16, 16, 16}, 0};
    for (uint32_t i = 0; i < c->end_count; i++) {
        last.table = (unsigned char)((last.table + huffman_read(b, &models[3])) & 7);
        for (int k = 0; k < (is_grey ? 1 : 3); k++) {
            huffman *model = &models[last.color[k] <= 9 ? 0 : last.color[k] <= 21 ? 1 : 2];
            last.color[k] = (unsigned char)((last.color[k] + huffman_read(b, model)) & 31);
        }
        if (is_grey)
            last.color[1] = last.color[2] = last.color[0];
        c->ends[i] = last;
    }
    return !b->is_past_end && !models[0].is_damaged && !models[1].is_damaged && !models[2].is_damaged &&
           !models[3].is_damaged;
}

/* Rows of four texels are bytes, raw or XORed with those of the entry before. */
static bool read_selectors(bit_reader *b, huffman *model, etc1s_codebook *c)
{
    if (bits_read(b, 2) != 0)
        return false;
    const bool is_raw = bits_read(b, 1) != 0;
    if (!is_raw && !huffman_read_table(b, model))
        return false;
    uint32_t last = 0;
    for (uint32_t i = 0; i < c->selector_count; i++) {
        uint32_t rows = 0;
        for (unsigned row = 0; row < 4; row++)
            rows |= (is_raw || i == 0 ? bits_read(b, 8) : huffman_read(b, model) & 255) << 8 * row;
        last = is_raw ? rows : last ^ rows;
        c->selectors[i] = last;
    }
    return !b->is_past_end && (is_raw || !model->is_damaged);
}

static bool read_tables(bit_reader *b, etc1s_codebook *c)
{
    for (int i = 0; i < ETC1S_TABLE_COUNT; i++)
        if (!huffman_read_table(b, &c->tables[i]))
            return false;
    c->history_size = bits_read(b, 13);
    return !b->is_past_end;
}

facet_result etc1s_codebook_create(const unsigned char *global, size_t size, uint64_t image_count,
                                   const char *name, const facet_allocator *allocator, etc1s_codebook *out,
                                   facet_error *error)
{
    *out = (etc1s_codebook){0};
    parts p;
    facet_result result = find_parts(global, size, image_count, name, &p, error);
    if (result != FACET_OK)
        return result;
    etc1s_codebook c = {.end_count = p.end_count, .selector_count = p.selector_count};
    c.ends = mem_alloc(allocator, c.end_count, sizeof *c.ends);
    c.selectors = mem_alloc(allocator, c.selector_count, sizeof *c.selectors);
    c.tables = mem_alloc(allocator, ETC1S_TABLE_COUNT, sizeof *c.tables);
    if (!c.ends || !c.selectors || !c.tables)
        result = fail_memory(error, "BasisLZ codebooks", ETC1S_TABLE_COUNT * sizeof *c.tables);
    else if (!read_ends(&p.ends, c.tables, &c)) /* the tables are unused until their own part is read */
        result = fail_global(error, name, "the endpoints are damaged");
    else if (!read_selectors(&p.selectors, c.tables, &c))
        result = fail_global(error, name, "the selectors are damaged");
    else if (!read_tables(&p.tables, &c))
        result = fail_global(error, name, "the Huffman tables are damaged");
    if (result != FACET_OK)
        etc1s_codebook_destroy(&c);
    *out = c;
    return result;
}

void etc1s_codebook_destroy(etc1s_codebook *c)
{
    mem_free(c->ends);
    mem_free(c->selectors);
    mem_free(c->tables);
    *c = (etc1s_codebook){0};
}

/* ---- blocks ---- */

static const int16_t modifiers[8][4] = {{-8, -2, 2, 8},       {-17, -5, 5, 17},    {-29, -9, 9, 29},
                                        {-42, -13, 13, 42},   {-60, -18, 18, 60},  {-80, -24, 24, 80},
                                        {-106, -33, 33, 106}, {-183, -47, 47, 183}};

static int extend5(int x)
{
    return x << 3 | x >> 2;
}

void etc1s_decode_color(const etc1s_codebook *c, etc1s_block block, unsigned char *tile)
{
    const etc1s_end *end = &c->ends[block.end];
    unsigned char colors[4][4];
    for (int i = 0; i < 4; i++) {
        for (int k = 0; k < 3; k++)
            colors[i][k] = clamp_u8(extend5(end->color[k]) + modifiers[end->table][i]);
        colors[i][3] = 255;
    }
    uint32_t selectors = c->selectors[block.selector];
    for (size_t i = 0; i < TILE_TEXELS; i++, selectors >>= 2)
        memcpy(tile + 4 * i, colors[selectors & 3], 4);
}

void etc1s_decode_alpha(const etc1s_codebook *c, etc1s_block block, unsigned char *tile)
{
    const etc1s_end *end = &c->ends[block.end];
    unsigned char values[4];
    for (int i = 0; i < 4; i++)
        values[i] = clamp_u8(extend5(end->color[1]) + modifiers[end->table][i]);
    uint32_t selectors = c->selectors[block.selector];
    for (size_t i = 0; i < TILE_TEXELS; i++, selectors >>= 2)
        tile[4 * i + 3] = values[selectors & 3];
}
