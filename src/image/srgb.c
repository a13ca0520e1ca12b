/* srgb.c - see srgb.h. */
#include "image/srgb.h"

#include "facet/facet.h"

#include <math.h>

double srgb_encode(double linear)
{
    return linear <= 0.0031308 ? 12.92 * linear : 1.055 * pow(linear, 1.0 / 2.4) - 0.055;
}

double srgb_decode(double encoded)
{
    return encoded <= 0.04045 ? encoded / 12.92 : pow((encoded + 0.055) / 1.055, 2.4);
}

void srgb_tables_prepare(srgb_tables *tables)
{
    for (int code = 0; code < 256; code++) {
        tables->decoded[code] = (float)srgb_decode(code / 255.0);
        tables->begins[code] = code ? (float)srgb_decode((code - 0.5) / 255.0) : 0.0f;
    }
    tables->begins[256] = INFINITY;
    int code = 0;
    for (int part = 0; part < SRGB_PARTS; part++) {
        float lower = float_from_bits(((uint32_t)(127 - SRGB_OCTAVES) << 23) +
                                      ((uint32_t)part << (23 - SRGB_PARTS_LOG2)));
        while (lower >= tables->begins[code + 1])
            code++;
        tables->codes[part] = (uint8_t)code;
    }
}

float facet_linear_from_srgb(float encoded)
{
    return (float)srgb_decode((double)encoded);
}
