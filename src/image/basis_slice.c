/* basis_slice.c - the blocks of one BasisLZ slice: ends predicted from the blocks left, above and above left, selectors
 * from a history of recent ones (KTX 2.0, "ETC1S Slice Decoding"). See basis_etc1s.h. */
#include "image/basis_etc1s.h"

#include <string.h>

#include "base/memory.h"
#include "base/result.h"

enum { END_PREDICTION, END_DELTA, SELECTOR, SELECTOR_RUN }; /* tables of the codebook */
enum {
    PREDICTIONS_REPEAT = 256, /* the symbol behind those of four predictions of 2 bits */
    PREDICTIONS_MIN_RUN = 3,
    SELECTOR_MIN_RUN = 3,
    SELECTOR_LONG_RUN = 63,
    MAX_HISTORY = 8191
};

/* What of a slice is known while its blocks are read. */
typedef struct slice {
    const etc1s_codebook *c;
    bit_reader bits;
    huffman tables[ETC1S_TABLE_COUNT]; /* copies: reading notes damage in them */
    uint32_t columns;
    uint32_t last_end;
    uint32_t predictions, prediction_run; /* of the last 2 x 2 blocks */
    uint32_t selector_run;
    uint32_t rover; /* where the history takes the next selector */
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

/* block: where it will stand; the blocks before it are there. */
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

/* The history is moved to the front approximately: what is used changes places with what stands at half its index; new
 * entries replace those of the back half in turn. */
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
