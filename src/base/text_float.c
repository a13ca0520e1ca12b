/* text_float.c - the shortest decimal of a float.
 *
 * A float is m 2^-s with whole m < 2^24. Its first k digits are n = round(m 10^p / 2^s), where p is chosen so that n has k
 * digits; they are a decimal that reads back as the float where n 2^s is within half a unit of m, 10^p / 2, from m 10^p.
 * All of these are whole numbers below 2^100, so that nothing is rounded but what should be; the result is that of
 * printf("%.*g") with the least precision from 6 on that reads back, 20 times as fast. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/text.h"

__extension__ typedef unsigned __int128 wide;

/* Within these the numbers above fit; others are rare. */
static const float SMALLEST = 1e-10f;
static const float LARGEST = 1e6f;

static const uint64_t POWERS[] = {1u,
                                  10u,
                                  100u,
                                  1000u,
                                  10000u,
                                  100000u,
                                  1000000u,
                                  10000000u,
                                  100000000u,
                                  1000000000u,
                                  10000000000u,
                                  100000000000u,
                                  1000000000000u,
                                  10000000000000u,
                                  100000000000000u,
                                  1000000000000000u,
                                  10000000000000000u,
                                  100000000000000000u,
                                  1000000000000000000u,
                                  10000000000000000000u};

/* floor(log10(value)), -10 to 5. */
static int decimal_exponent(double value)
{
    static const double below_one[] = {1e0, 1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10};
    int exponent = 0;
    if (value >= 1.0)
        while (value >= (double)POWERS[exponent + 1])
            exponent++;
    else
        while (exponent > -10 && value < below_one[-exponent])
            exponent--;
    return exponent;
}

/* The digits of m 2^-s to a precision. False: they do not read back. */
static bool round_digits(uint32_t m, int s, int p, uint64_t *digits)
{
    wide exact = (wide)m * POWERS[p];
    wide half = (wide)1 << (s - 1);
    wide n = exact >> s;
    wide rest = exact - (n << s);
    n += rest > half || (rest == half && (n & 1)); /* ties to even, as printf() */
    *digits = (uint64_t)n;
    wide back = n << s;
    wide error = back > exact ? back - exact : exact - back;
    /* Below a power of two floats are twice as dense. */
    bool is_boundary = m == 1u << 23 && back < exact;
    return is_boundary ? 4 * error < POWERS[p]
                       : 2 * error < POWERS[p] || (2 * error == POWERS[p] && !(m & 1));
}

static char *put_digits(char *out, uint64_t n, int count)
{
    for (int i = count - 1; i >= 0; i--) {
        out[i] = (char)('0' + n % 10);
        n /= 10;
    }
    return out + count;
}

/* As %g: digits (count of them, without zeros at the end) with the point behind the first one times 10^exponent. */
static void put_decimal(char *out, uint64_t digits, int count, int exponent)
{
    if (exponent < -4) {
        out = put_digits(out, digits / POWERS[count - 1], 1);
        if (count > 1) {
            *out++ = '.';
            out = put_digits(out, digits % POWERS[count - 1], count - 1);
        }
        *out++ = 'e';
        *out++ = '-';
        out = put_digits(out, (uint64_t)-exponent, 2);
    } else if (exponent < 0) {
        memcpy(out, "0.0000", 6);
        out = put_digits(out + 1 - exponent, digits, count);
    } else if (count <= exponent + 1) {
        out = put_digits(out, digits * POWERS[exponent + 1 - count], exponent + 1);
    } else {
        out = put_digits(out, digits / POWERS[count - exponent - 1], exponent + 1);
        *out++ = '.';
        out = put_digits(out, digits % POWERS[count - exponent - 1], count - exponent - 1);
    }
    *out = 0;
}

/* Any float, slowly. */
static void print_shortest(float value, char digits[TEXT_FLOAT_SIZE])
{
    for (int precision = 6; precision <= 9; precision++) {
        snprintf(digits, TEXT_FLOAT_SIZE, "%.*g", precision, (double)value);
        if (strtof(digits, NULL) == value)
            break;
    }
}

void text_shortest_float(float value, char digits[TEXT_FLOAT_SIZE])
{
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    float size = value < 0.0f ? -value : value;
    if (size == 0.0f) {
        strcpy(digits, bits >> 31 ? "-0" : "0");
        return;
    }
    if (!(size >= SMALLEST && size < LARGEST)) {
        print_shortest(value, digits);
        return;
    }
    if (value < 0.0f)
        *digits++ = '-';
    uint32_t m = (bits & 0x7fffff) | 1u << 23; /* no denormals here */
    int s = 150 - (int)(bits >> 23 & 0xff);
    int exponent = decimal_exponent((double)size);
    uint64_t n = 0;
    int count = 6;
    while (!round_digits(m, s, count - 1 - exponent, &n) && count < 9)
        count++;
    if (n == POWERS[count]) { /* 9.9999999 became 10 */
        n /= 10;
        exponent++;
    }
    for (; count > 1 && n % 10 == 0; count--)
        n /= 10;
    put_decimal(digits, n, count, exponent);
}

void text_shortest_double(double value, char digits[TEXT_FLOAT_SIZE])
{
    const double plain = 4096.0;
    if (value > -plain && value < plain && (double)(float)value == value) {
        text_shortest_float((float)value, digits);
        return;
    }
    for (int precision = 15; precision <= 17; precision++) {
        snprintf(digits, TEXT_FLOAT_SIZE, "%.*g", precision, value);
        if (strtod(digits, NULL) == value)
            return;
    }
}

void text_shortest_place(float value, double origin, char digits[TEXT_FLOAT_SIZE])
{
    if (origin == 0.0) {
        text_shortest_float(value, digits);
        return;
    }
    double place = origin + (double)value;
    int decimals = value != 0.0f ? (int)floor(-log10(fabs((double)value))) + 5 : 0;
    decimals = decimals < 0 ? 0 : decimals;
    for (int last = decimals + 5; decimals < last && decimals < 16 && fabs(place) < 1e17; decimals++) {
        snprintf(digits, TEXT_FLOAT_SIZE, "%.*f", decimals, place);
        if ((float)(strtod(digits, NULL) - origin) != value)
            continue;
        if (decimals > 0) {
            size_t length = strlen(digits);
            while (digits[length - 1] == '0')
                length--;
            digits[length - (digits[length - 1] == '.')] = 0;
        }
        return;
    }
    text_shortest_double(place, digits);
}
