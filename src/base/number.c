/* number.c - see number.h.
 *
 * A decimal is converted to a double with an error of a few units in the last place, which determines the
 * float unless the double is that close to the midpoint of two floats: once in 2^26 numbers. Those, and
 * results that are not normal floats, are compared with the midpoint in big integers (as in Clinger 1990,
 * "How to read floating point numbers accurately", algorithm R, with the neighbors in place of a search). */
#include "base/number.h"

#include <float.h>
#include <math.h>
#include <strings.h>

/* Powers of ten that a double represents exactly. */
static const double TENS[] = {1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,  1e8,  1e9,  1e10, 1e11,
                              1e12, 1e13, 1e14, 1e15, 1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22};
enum { MAX_TENS = 22 };

/* ---- integers of many digits ---- */

/* Significant digits that are kept. The midpoint of two floats has at most 112; further digits are
 * replaced by a 1 unless all are zeros. */
enum { MAX_DIGITS = 128 };
/* The larger side of a comparison is below 2^25 10^(46 + MAX_DIGITS + 1), which has 607 bits. */
enum { BIG_WORDS = 24 };

typedef struct big {
    uint32_t words[BIG_WORDS]; /* little-endian */
} big;

static void big_multiply_add(big *b, uint32_t factor, uint32_t addend)
{
    uint64_t carry = addend;
    for (int i = 0; i < BIG_WORDS; i++) {
        carry += (uint64_t)b->words[i] * factor;
        b->words[i] = (uint32_t)carry;
        carry >>= 32;
    }
}

static void big_multiply_ten(big *b, int power)
{
    for (; power >= 9; power -= 9)
        big_multiply_add(b, 1000000000u, 0);
    for (; power > 0; power--)
        big_multiply_add(b, 10, 0);
}

static void big_shift(big *b, int bits)
{
    for (; bits >= 31; bits -= 31)
        big_multiply_add(b, 1u << 31, 0);
    big_multiply_add(b, 1u << bits, 0);
}

static int big_compare(const big *a, const big *b)
{
    for (int i = BIG_WORDS - 1; i >= 0; i--)
        if (a->words[i] != b->words[i])
            return a->words[i] < b->words[i] ? -1 : 1;
    return 0;
}

/* ---- a decimal as it stands ---- */

/* digits[0] digits[1] .. times 10^exponent, without leading zeros. */
typedef struct decimal {
    int count;
    long exponent;
    unsigned char digits[MAX_DIGITS + 1];
} decimal;

/* The sign of a decimal minus the midpoint of the positive float with these bits and the next one. */
static int compare_with_middle(const decimal *d, uint32_t bits)
{
    uint32_t fraction = bits & 0x7fffffu;
    int exponent = (int)(bits >> 23);
    uint32_t significand = exponent ? fraction | 0x800000u : fraction;
    int power = (exponent ? exponent : 1) - 150 - 1; /* of the midpoint, 2 significand + 1 */
    big left = {{0}};
    big right = {{2 * significand + 1}};
    for (int i = 0; i < d->count; i++)
        big_multiply_add(&left, 10, d->digits[i]);
    if (d->exponent >= 0)
        big_multiply_ten(&left, (int)d->exponent);
    else
        big_multiply_ten(&right, (int)-d->exponent);
    big_shift(power < 0 ? &left : &right, power < 0 ? -power : power);
    return big_compare(&left, &right);
}

/* Times 10^power. */
static double scale(double value, long power)
{
    for (; power > 0; power -= power > MAX_TENS ? MAX_TENS : power)
        value *= TENS[power > MAX_TENS ? MAX_TENS : power];
    for (; power<0; power += -power> MAX_TENS ? MAX_TENS : -power)
        value /= TENS[-power > MAX_TENS ? MAX_TENS : -power];
    return value;
}

/* The nearest float of a nonzero decimal. */
static float round_exactly(const decimal *d)
{
    if (d->count + d->exponent > 40)
        return INFINITY;
    if (d->count + d->exponent < -46)
        return 0.0f;
    double guess = 0.0;
    for (int i = 0; i < d->count && i < 19; i++)
        guess = 10.0 * guess + (double)d->digits[i];
    guess = scale(guess, d->exponent + (d->count > 19 ? d->count - 19 : 0));

    float value = guess < (double)FLT_MAX ? (float)guess : FLT_MAX;
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    int sign = compare_with_middle(d, bits);
    if (sign > 0 || (sign == 0 && (bits & 1u))) {
        bits++; /* above the largest float: infinity */
    } else if (bits > 0) {
        sign = compare_with_middle(d, bits - 1);
        if (sign < 0 || (sign == 0 && (bits & 1u)))
            bits--;
    }
    memcpy(&value, &bits, sizeof value);
    return value;
}

/* Parses a number that is known to be valid, from its first digit or point on. */
static decimal collect(const char *p, long exponent)
{
    decimal d = {.exponent = exponent};
    bool is_behind_point = false;
    bool has_more = false;
    for (;; p++) {
        if (*p == '.' && !is_behind_point) {
            is_behind_point = true;
            continue;
        }
        unsigned digit = (unsigned char)*p - (unsigned)'0';
        if (digit > 9)
            break;
        if (d.count < MAX_DIGITS && (d.count || digit))
            d.digits[d.count++] = (unsigned char)digit;
        else if (d.count) {
            has_more |= digit != 0;
            d.exponent++;
        }
        d.exponent -= is_behind_point;
    }
    if (has_more) {
        d.digits[d.count++] = 1;
        d.exponent--;
    }
    return d;
}

/* ---- the fast path ---- */

/* m 10^power as a float; false: round_exactly() is needed. */
static bool round_quickly(uint64_t m, long power, float *value)
{
    if (m == 0) {
        *value = 0.0f;
        return true;
    }
    if (power < -MAX_TENS || power > MAX_TENS)
        return false;
    double d = power < 0 ? (double)m / TENS[-power] : (double)m * TENS[power];
    if (!(d >= (double)FLT_MIN && d <= (double)FLT_MAX))
        return false;
    /* Two roundings, and the digits after the 19th: d is off by less than 2 units in its last place. */
    uint64_t bits;
    memcpy(&bits, &d, sizeof bits);
    uint64_t from_middle = (bits & 0x1fffffffu) - 0x10000000u + 4;
    if (from_middle <= 8)
        return false;
    *value = (float)d;
    return true;
}

/* nan, inf, infinity; NULL: none of them. */
static const char *read_word(const char *p, float *value)
{
    static const struct {
        const char *word;
        size_t length;
        float value;
    } words[] = {{"infinity", 8, INFINITY}, {"inf", 3, INFINITY}, {"nan", 3, NAN}};
    for (size_t i = 0; i < sizeof words / sizeof *words; i++)
        if (strncasecmp(p, words[i].word, words[i].length) == 0) {
            *value = words[i].value;
            p += words[i].length;
            if (strncasecmp(p, "(ind)", 5) == 0 || strncasecmp(p, "(snan)", 6) == 0)
                p += p[1] == 's' || p[1] == 'S' ? 6 : 5;
            return p;
        }
    return NULL;
}

/* #INF, #IND, #QNAN, #SNAN after "1.", and zeros that may follow. */
static const char *read_windows_word(const char *p, float *value)
{
    *value = strncasecmp(p, "#inf", 4) == 0 ? INFINITY : NAN;
    for (p++; (*p >= 'A' && *p <= 'Z') || (*p >= 'a' && *p <= 'z') || (*p >= '0' && *p <= '9'); p++)
        ;
    return p;
}

/* The exponent of a number; 0 if no digit follows. Exponents beyond a million are clamped. */
static const char *read_exponent(const char *p, long *exponent)
{
    const char *q = p + 1;
    bool is_negative = *q == '-';
    q += *q == '-' || *q == '+';
    if (*q < '0' || *q > '9')
        return p;
    long value = 0;
    for (; *q >= '0' && *q <= '9'; q++)
        value = value < 100000 ? 10 * value + (*q - '0') : value;
    *exponent += is_negative ? -value : value;
    return q;
}

/* Appends any number of digits to *m; *count grows by them. Beyond 19 in all *m is meaningless. */
static inline const char *read_run(const char *p, uint64_t *m, size_t *count)
{
    static const uint32_t tens[] = {1, 10, 100, 1000, 10000, 100000, 1000000, 10000000, 100000000};
    unsigned got;
    do {
        uint32_t value;
        got = number_read_digits(p, &value);
        *m = *m * tens[got] + value;
        *count += got;
        p += got;
    } while (got == 8);
    return p;
}

const char *number_read_float(const char *text, float *value)
{
    bool is_negative = *text == '-';
    const char *digits = text + (*text == '-' || *text == '+');
    uint64_t m = 0;
    size_t count = 0;
    float result;
    const char *p = read_run(digits, &m, &count);
    long power = 0;
    if (*p == '.') {
        size_t before = count;
        p = read_run(p + 1, &m, &count);
        power = -(long)(count - before);
    }
    if (count == 0) {
        p = read_word(digits, &result);
        if (!p)
            return NULL;
    } else if (*p == '#' && p[-1] == '.') {
        p = read_windows_word(p, &result);
    } else {
        long exponent = 0;
        if ((*p | 0x20) == 'e' || (*p | 0x20) == 'd')
            p = read_exponent(p, &exponent);
        if (count > 19 || !round_quickly(m, power + exponent, &result)) {
            decimal d = collect(digits, exponent);
            result = d.count ? round_exactly(&d) : 0.0f;
        }
    }
    *value = is_negative ? -result : result;
    return p;
}

/* Digits, point and exponent of a number that number_read_float() has accepted. */
static double read_finite(const char *digits)
{
    const char *p = digits;
    long exponent = 0;
    while ((*p >= '0' && *p <= '9') || *p == '.')
        p++;
    if ((*p | 0x20) == 'e' || (*p | 0x20) == 'd')
        read_exponent(p, &exponent);
    const decimal d = collect(digits, exponent);
    uint64_t m = 0;
    for (int i = 0; i < d.count && i < 19; i++)
        m = 10 * m + d.digits[i];
    return scale((double)m, d.exponent + (d.count > 19 ? d.count - 19 : 0));
}

const char *number_read_double(const char *text, double *value)
{
    float rounded;
    const char *end = number_read_float(text, &rounded);
    if (!end)
        return NULL;
    const char *digits = text + (*text == '-' || *text == '+');
    *value = (double)rounded;
    if (fabsf(rounded) <= FLT_MAX)
        *value = *text == '-' ? -read_finite(digits) : read_finite(digits);
    return end;
}
