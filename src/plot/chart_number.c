/* chart_number.c - see chart_number.h. */
#include "plot/chart_number.h"

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Replaces the decimal point of any locale by ".". */
static void set_point(char *text)
{
    char *p = text + (*text == '-');
    while (*p >= '0' && *p <= '9')
        p++;
    if (*p == 0 || *p == 'e' || *p == '.')
        return;
    char *after = p;
    while (*after && *after != 'e' && !(*after >= '0' && *after <= '9'))
        after++;
    *p = '.';
    memmove(p + 1, after, strlen(after) + 1);
}

/* Adds one to the last digit of the significand of text, "d.ddde-dd"; false: all are 9. */
static bool add_one(char *text)
{
    char *e = strchr(text, 'e');
    if (!e)
        return false;
    for (char *p = e - 1; p >= text && *p != '-'; p--) {
        if (*p < '0' || *p > '9')
            continue;
        if (*p != '9') {
            (*p)++;
            return true;
        }
        *p = '0';
    }
    return false;
}

/* A decimal of that many digits that reads back as value. The nearest decimal may not: below a power of
 * two doubles are twice as dense, so the next one above may read back where the nearest, below, does not. */
static bool find_digits(double value, int digits, char out[NUMBER_SIZE])
{
    snprintf(out, NUMBER_SIZE, "%.*g", digits, value);
    if (strtod(out, NULL) == value)
        return true;
    int exponent;
    if (fabs(frexp(value, &exponent)) != 0.5)
        return false;
    char next[NUMBER_SIZE];
    snprintf(next, sizeof next, "%.*e", digits - 1, value);
    if (!add_one(next) || strtod(next, NULL) != value)
        return false;
    memcpy(out, next, sizeof next);
    return true;
}

void number_shortest(double value, char out[NUMBER_SIZE])
{
    if (isnan(value) || isinf(value)) {
        strcpy(out, isnan(value) ? "" : value > 0.0 ? "inf" : "-inf");
        return;
    }
    /* 15 digits hold every shorter decimal, except where doubles have fewer bits */
    for (int digits = fabs(value) < DBL_MIN ? 1 : 15; digits <= 17; digits++)
        if (find_digits(value, digits, out))
            break;
    set_point(out);
}

void number_label(double value, int decimals, char out[NUMBER_SIZE])
{
    char digits[NUMBER_SIZE];
    decimals = decimals < 0 ? 0 : decimals > 17 ? 17 : decimals;
    /* too long for a label: a power of ten is used instead */
    int length = fabs(value) < 1e9 ? snprintf(digits, sizeof digits, "%.*f", decimals, value)
                                   : snprintf(digits, sizeof digits, "%.6g", value);
    if (length < 0 || length >= NUMBER_SIZE - 4)
        snprintf(digits, sizeof digits, "%.6g", value);
    set_point(digits);
    const char *p = digits;
    bool is_negative = *p == '-';
    p += is_negative;
    if (strspn(p, "0.") == strlen(p))
        is_negative = false;
    snprintf(out, NUMBER_SIZE, "%s%.27s", is_negative ? "\xe2\x88\x92" : "", p);
}
