/* srgb.h - the sRGB transfer function (IEC 61966-2-1) between linear values and codes of 8 or 16 bits,
 * tabulated. In double, so that every code is exact; shade/color.h has it in float for shaders. */
#ifndef IMAGE_SRGB_H
#define IMAGE_SRGB_H

#include "image/half.h"

double srgb_encode(double linear);  /* [0, 1] to [0, 1] */
double srgb_decode(double encoded); /* its inverse */

/* Octaves below 1 down to code 1, and parts of each, fine enough that at most one code begins in a part
 * (codes are densest at 0.5, 1 / (255 * 0.66) apart; a part there is 0.5 / 128 wide). */
enum { SRGB_OCTAVES = 13, SRGB_PARTS_LOG2 = 7, SRGB_PARTS = SRGB_OCTAVES << SRGB_PARTS_LOG2 };

/* Takes about 20 us to prepare; may then be read by all threads. */
typedef struct srgb_tables {
    float decoded[256];        /* linear value of each code */
    float begins[257];         /* least linear value of each code; begins[256] is infinite */
    uint8_t codes[SRGB_PARTS]; /* code at the lower end of each part of an octave */
} srgb_tables;

void srgb_tables_prepare(srgb_tables *tables);

/* The nearest 8-bit code, equal to rounding srgb_encode() for every float. Below 0 and NaN: 0; above 1: 255. */
static inline uint8_t srgb_encode_u8(const srgb_tables *tables, float linear)
{
    const uint32_t lowest = (uint32_t)(127 - SRGB_OCTAVES) << 23;
    if (!(linear >= 0x1p-13f))
        return 0;
    if (linear >= 1.0f)
        return 255;
    uint8_t code = tables->codes[(float_bits(linear) - lowest) >> (23 - SRGB_PARTS_LOG2)];
    return (uint8_t)(code + (linear >= tables->begins[code + 1]));
}

#endif
