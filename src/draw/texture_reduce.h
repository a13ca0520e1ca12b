/* texture_reduce.h - one row of a mip level from the rows of the next finer one that it covers. */
#ifndef DRAW_TEXTURE_REDUCE_H
#define DRAW_TEXTURE_REDUCE_H

#include "draw/texture_pyramid.h"

/* The texels of an axis of size texels that texel i of the next level (max(1, size / 2)) covers: count of
 * them, from begin on; weights sum to total. */
typedef struct texture_coverage {
    uint32_t begin, count, weights[3], total;
} texture_coverage;

texture_coverage texture_cover(uint32_t size, uint32_t i);

/* From a row of width * channel_count codes to 16 bits, linear by the tables. */
void texture_row_from_8(const texture_tables *tables, bool as_color, const unsigned char *codes,
                        uint32_t width, uint32_t channel_count, uint16_t *out);
/* The inverse: the nearest codes. */
void texture_row_to_8(const texture_tables *tables, bool as_color, const uint16_t *values, uint32_t width,
                      uint32_t channel_count, unsigned char *out);

/* The row of width texels made from vertical.count rows of source_width each: means of 2 x 2 texels where
 * both sizes are even. Writes up to TEXTURE_ROW_TAIL values beyond it. room: source_width texels. */
enum { TEXTURE_ROW_TAIL = 4 };
void texture_reduce_rows(const uint16_t *const rows[3], texture_coverage vertical, uint32_t source_width,
                         uint32_t width, uint32_t channel_count, uint16_t *room, uint16_t *out);
/* The same from two rows of codes, for a source_width that is even. */
void texture_halve_codes(const texture_tables *tables, bool as_color, const unsigned char *const rows[2],
                         uint32_t source_width, uint32_t channel_count, uint16_t *room, uint16_t *out);

#endif
