/* text.c - text that grows, JSON written into it, UTF-8 (utf8.h), and the shortest decimals of floats.
 *
 * A float is m 2^-s with whole m < 2^24. Its first k digits are n = round(m 10^p / 2^s), where p is chosen
 * so that n has k digits; they are a decimal that reads back as the float where n 2^s is within half a
 * unit of m, 10^p / 2, from m 10^p. All of these are whole numbers below 2^100, so that nothing is rounded
 * but what should be; the result is that of printf("%.*g") with the least precision from 6 on that reads
 * back, 20 times as fast. */
#include "base/text.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "base/utf8.h"

/* ---- UTF-8 ---- */

size_t utf8_length(const void *bytes, size_t size)
{
    const unsigned char *s = bytes;
    if (size == 0 || s[0] > 0xf4 || (s[0] >= 0x80 && s[0] < 0xc2))
        return 0;
    size_t length = s[0] < 0x80 ? 1 : s[0] < 0xe0 ? 2 : s[0] < 0xf0 ? 3 : 4;
    if (length > size)
        return 0;
    for (size_t i = 1; i < length; i++)
        if ((s[i] & 0xc0) != 0x80)
            return 0;
    bool is_overlong = (s[0] == 0xe0 && s[1] < 0xa0) || (s[0] == 0xf0 && s[1] < 0x90);
    bool is_outside = (s[0] == 0xed && s[1] > 0x9f) || (s[0] == 0xf4 && s[1] > 0x8f);
    return is_overlong || is_outside ? 0 : length;
}

bool utf8_is_valid(const char *bytes, size_t size)
{
    size_t i = 0;
    while (i < size) {
        size_t length = utf8_length(bytes + i, size - i);
        if (length == 0)
            return false;
        i += length;
    }
    return true;
}

size_t utf8_from_latin1(const char *bytes, size_t size, char *out)
{
    size_t used = 0;
    for (size_t i = 0; i < size;) {
        size_t length = utf8_length(bytes + i, size - i);
        if (length) {
            memcpy(out + used, bytes + i, length);
            used += length;
            i += length;
        } else {
            unsigned char c = (unsigned char)bytes[i++];
            out[used++] = (char)(0xc0 | c >> 6);
            out[used++] = (char)(0x80 | (c & 0x3f));
        }
    }
    return used;
}

/* ---- shortest decimals ---- */

__extension__ typedef unsigned __int128 wide;

/* In this range the numbers above fit; others are rare. */
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
    n += rest > half || (rest == half && (n & 1)); /* ties to even, as in printf() */
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

/* As %g: count digits, without trailing zeros, with the point after the first one, times 10^exponent. */
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

/* The slow path for any float. */
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
    uint32_t m = (bits & 0x7fffff) | 1u << 23; /* not denormal */
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

/* ---- text ---- */

void text_add_bytes(text *t, const void *bytes, size_t size)
{
    if (t->has_failed)
        return;
    if (!mem_reserve(&t->allocator, (void **)&t->data, &t->capacity, t->length + size + 1, 1)) {
        t->has_failed = true;
        return;
    }
    if (size > 0) /* bytes may be NULL */
        memcpy(t->data + t->length, bytes, size);
    t->length += size;
    t->data[t->length] = 0;
}

void text_add(text *t, const char *string)
{
    text_add_bytes(t, string, strlen(string));
}

void text_addf(text *t, const char *format, ...)
{
    char small[256];
    va_list arguments;
    va_start(arguments, format);
    int length = vsnprintf(small, sizeof small, format, arguments);
    va_end(arguments);
    if (length < 0)
        return;
    if ((size_t)length < sizeof small) {
        text_add_bytes(t, small, (size_t)length);
        return;
    }
    char *large = malloc((size_t)length + 1);
    if (!large) {
        t->has_failed = true;
        return;
    }
    va_start(arguments, format);
    vsnprintf(large, (size_t)length + 1, format, arguments);
    va_end(arguments);
    text_add_bytes(t, large, (size_t)length);
    free(large);
}

void text_destroy(text *t)
{
    mem_free(t->data);
    *t = (text){0};
}

/* ---- HTML and base64 ---- */

void text_add_html(text *t, const char *string)
{
    for (const unsigned char *s = (const unsigned char *)string; *s;) {
        size_t length = utf8_length(s, SIZE_MAX);
        const char *entity = *s == '&'                                                ? "&amp;"
                             : *s == '<'                                              ? "&lt;"
                             : *s == '>'                                              ? "&gt;"
                             : *s == '"'                                              ? "&quot;"
                             : length == 0 || (*s < 0x20 && *s != '\n' && *s != '\t') ? "\xef\xbf\xbd"
                                                                                      : NULL;
        if (entity)
            text_add(t, entity);
        else
            text_add_bytes(t, s, length);
        s += length ? length : 1;
    }
}

void text_add_url(text *t, const char *string)
{
    static const char plain[] = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-._~/";
    for (; *string; string++)
        if (strchr(plain, *string))
            text_add_bytes(t, string, 1);
        else
            text_addf(t, "%%%02X", (unsigned char)*string);
}

/* Writes the four digits of 1 to 3 bytes. */
static void base64_group(const unsigned char *bytes, size_t count, char out[4])
{
    static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    uint32_t bits = (uint32_t)bytes[0] << 16 | (uint32_t)(count > 1 ? bytes[1] : 0) << 8 |
                    (uint32_t)(count > 2 ? bytes[2] : 0);
    out[0] = digits[bits >> 18];
    out[1] = digits[bits >> 12 & 63];
    out[2] = count > 1 ? digits[bits >> 6 & 63] : '=';
    out[3] = count > 2 ? digits[bits & 63] : '=';
}

void text_add_base64(text *t, const void *bytes, size_t size)
{
    enum { GROUPS = 256 };
    const unsigned char *from = bytes;
    char out[4 * GROUPS];
    while (size) {
        size_t used = 0;
        for (; used < sizeof out && size; used += 4) {
            size_t count = size < 3 ? size : 3;
            base64_group(from, count, out + used);
            from += count;
            size -= count;
        }
        text_add_bytes(t, out, used);
    }
}

/* ---- JSON ---- */

static void add_quoted(text *t, const char *value)
{
    text_add(t, "\"");
    const unsigned char *s = (const unsigned char *)value;
    while (*s) {
        size_t length = utf8_length(s, SIZE_MAX);
        if (length == 0) {
            text_add(t, "\xef\xbf\xbd");
            length = 1;
        } else if (*s == '"' || *s == '\\') {
            text_addf(t, "\\%c", *s);
        } else if (*s < 0x20 || *s == 0x7f) {
            text_addf(t, "\\u%04x", *s);
        } else {
            text_add_bytes(t, s, length);
        }
        s += length;
    }
    text_add(t, "\"");
}

static void begin_value(text *t, const char *key)
{
    if (t->needs_comma)
        text_add(t, ",");
    t->needs_comma = true;
    if (key) {
        add_quoted(t, key);
        text_add(t, ":");
    }
}

static void begin_container(text *t, const char *key, const char *bracket)
{
    begin_value(t, key);
    text_add(t, bracket);
    t->needs_comma = false;
}

static void end_container(text *t, const char *bracket)
{
    text_add(t, bracket);
    t->needs_comma = true;
}

void text_json_begin_object(text *t, const char *key)
{
    begin_container(t, key, "{");
}

void text_json_end_object(text *t)
{
    end_container(t, "}");
}

void text_json_begin_array(text *t, const char *key)
{
    begin_container(t, key, "[");
}

void text_json_end_array(text *t)
{
    end_container(t, "]");
}

void text_json_string(text *t, const char *key, const char *value)
{
    begin_value(t, key);
    if (value)
        add_quoted(t, value);
    else
        text_add(t, "null");
}

void text_json_bool(text *t, const char *key, bool value)
{
    begin_value(t, key);
    text_add(t, value ? "true" : "false");
}

void text_json_integer(text *t, const char *key, int64_t value)
{
    begin_value(t, key);
    text_addf(t, "%lld", (long long)value);
}

void text_json_float(text *t, const char *key, float value)
{
    begin_value(t, key);
    if (!isfinite(value)) {
        text_add(t, "null");
        return;
    }
    char digits[TEXT_FLOAT_SIZE];
    text_shortest_float(value, digits);
    text_add(t, digits);
}

void text_json_floats(text *t, const char *key, const float *values, size_t count)
{
    text_json_begin_array(t, key);
    for (size_t i = 0; i < count; i++)
        text_json_float(t, NULL, values[i]);
    text_json_end_array(t);
}

void text_json_doubles(text *t, const char *key, const double *values, size_t count)
{
    text_json_begin_array(t, key);
    for (size_t i = 0; i < count; i++) {
        char digits[TEXT_FLOAT_SIZE] = "null";
        if (isfinite(values[i]))
            text_shortest_double(values[i], digits);
        text_json_raw(t, NULL, digits);
    }
    text_json_end_array(t);
}

void text_json_place(text *t, const char *key, const float values[3], const double origin[3])
{
    text_json_begin_array(t, key);
    for (size_t i = 0; i < 3; i++) {
        char digits[TEXT_FLOAT_SIZE];
        text_shortest_place(values[i], origin[i], digits);
        text_json_raw(t, NULL, digits);
    }
    text_json_end_array(t);
}

void text_json_raw(text *t, const char *key, const char *json)
{
    begin_value(t, key);
    text_add(t, json ? json : "null");
}
