/* number.h - parses decimal numbers: fast, correctly rounded, the same in every locale. */
#ifndef BASE_NUMBER_H
#define BASE_NUMBER_H

#include <stdbool.h>
#include <stdint.h>
#include <string.h>

/* Bytes that must be readable behind the character that ends a number: digits are examined eight at a time. */
enum { NUMBER_TAIL = 8 };

/* The value of the leading digits of text, at most 8; returns their count. The digits of a word are found and
 * combined in parallel, without a loop and its mispredicted end, which dominates the time for short numbers. */
static inline unsigned number_read_digits(const char *text, uint32_t *value)
{
    uint64_t word;
    memcpy(&word, text, sizeof word);
#if defined(__BYTE_ORDER__) && __BYTE_ORDER__ == __ORDER_BIG_ENDIAN__
    word = __builtin_bswap64(word);
#endif
    word ^= 0x3030303030303030u;
    /* The top bit of each byte above 9; only such a byte carries, and affects only later ones. */
    uint64_t others = ((word + 0x7676767676767676u) | word) & 0x8080808080808080u;
    unsigned count = others ? (unsigned)__builtin_ctzll(others) / 8 : 8;
    *value = 0;
    if (count == 0)
        return 0;
    word <<= 64 - 8 * count; /* pads with leading zeros */
    word = word * 10 + (word >> 8);
    word = (word & 0x000000ff000000ffu) * 0x000f424000000064u +
           ((word >> 16) & 0x000000ff000000ffu) * 0x0000271000000001u;
    *value = (uint32_t)(word >> 32);
    return count;
}

/* Parses the number at the start of text: sign, digits, point, exponent (e or d); nan and inf in any case,
 * also as Windows writes them (1.#QNAN, 1.#INF). *value is the nearest float, ties to even; beyond the
 * largest it is infinite. Returns the position behind the number; NULL: no number, *value is unchanged. A
 * character that is not part of a number must follow somewhere. */
const char *number_read_float(const char *text, float *value);
/* The same in double, within a unit of its last place; infinite or NaN as the float is. */
const char *number_read_double(const char *text, double *value);

#endif
