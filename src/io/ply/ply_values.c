/* ply_values.c - numbers of a PLY file, in its form. */
#include <math.h>
#include <string.h>

#include "image/codec.h"
#include "io/ply/ply_reader.h"

static bool is_space(unsigned char c)
{
    return c == ' ' || (c >= '\t' && c <= '\r');
}

static bool read_text(ply_reader *r, double *value)
{
    const char *after;
    while (r->at < r->end && is_space(*r->at))
        r->at++;
    if (r->at == r->end)
        return false;
    const char *text = (const char *)r->at;
    *value = codec_parse_number(text, (const char *)r->end, &after);
    r->at = (const unsigned char *)after;
    if (after == text) /* no number: nan, or nonsense, counts as not finite */
        *value = (double)NAN;
    while (r->at < r->end && !is_space(*r->at))
        r->at++;
    return true;
}

/* The bits of a value of that size, whatever the order of its bytes. */
static uint64_t read_bits(const unsigned char *p, size_t size, bool is_big)
{
    uint64_t bits = 0;
    for (size_t i = 0; i < size; i++)
        bits = bits << 8 | p[is_big ? i : size - 1 - i];
    return bits;
}

bool ply_read_value(ply_reader *r, ply_type type, double *value)
{
    if (r->form == PLY_TEXT)
        return read_text(r, value);
    size_t size = ply_type_size(type);
    if ((size_t)(r->end - r->at) < size)
        return false;
    uint64_t bits = read_bits(r->at, size, r->form == PLY_BIG);
    uint32_t word = (uint32_t)bits;
    float single;
    r->at += size;
    switch (type) {
    case PLY_INT8:
        *value = (double)(bits & 0x80 ? (int)bits - 0x100 : (int)bits);
        break;
    case PLY_INT16:
        *value = (double)(bits & 0x8000 ? (int)bits - 0x10000 : (int)bits);
        break;
    case PLY_INT32:
        *value = bits & 0x80000000u ? (double)bits - 4294967296.0 : (double)bits;
        break;
    case PLY_FLOAT:
        memcpy(&single, &word, sizeof single);
        *value = (double)single;
        break;
    case PLY_DOUBLE:
        memcpy(value, &bits, sizeof *value);
        break;
    case PLY_NONE:
    case PLY_UINT8:
    case PLY_UINT16:
    case PLY_UINT32:
        *value = (double)bits;
        break;
    }
    return true;
}

uint64_t ply_most_elements(const ply_reader *r, const ply_element *e)
{
    uint64_t least = 0;
    for (size_t i = 0; i < e->property_count; i++) {
        const ply_property *p = &e->properties[i];
        least += r->form == PLY_TEXT ? 2 : ply_type_size(p->count_type != PLY_NONE ? p->count_type : p->type);
    }
    uint64_t left = (uint64_t)(r->end - r->at) + (r->form == PLY_TEXT); /* the last has no blank behind it */
    return least ? left / least : 0;
}
