/* base64.c - see base64.h. */
#include "base/base64.h"

/* 0 to 63; 64: invalid. Accepts the URL-safe alphabet as well, which some writers use. */
static unsigned base64_value(unsigned char c)
{
    if (c >= 'A' && c <= 'Z')
        return c - 'A';
    if (c >= 'a' && c <= 'z')
        return c - 'a' + 26u;
    if (c >= '0' && c <= '9')
        return c - '0' + 52u;
    return c == '+' || c == '-' ? 62u : c == '/' || c == '_' ? 63u : 64u;
}

bool base64_decode(const char *text, size_t length, unsigned char *out, size_t *size)
{
    unsigned char values[256];
    for (unsigned i = 0; i < 256; i++)
        values[i] = (unsigned char)base64_value((unsigned char)i);
    while (length && text[length - 1] == '=')
        length--;
    size_t count = 0;
    size_t i = 0;
    for (; i + 4 <= length; i += 4) {
        unsigned a = values[(unsigned char)text[i]];
        unsigned b = values[(unsigned char)text[i + 1]];
        unsigned c = values[(unsigned char)text[i + 2]];
        unsigned d = values[(unsigned char)text[i + 3]];
        if ((a | b | c | d) > 63)
            return false;
        unsigned bits = a << 18 | b << 12 | c << 6 | d;
        out[count++] = (unsigned char)(bits >> 16);
        out[count++] = (unsigned char)(bits >> 8);
        out[count++] = (unsigned char)bits;
    }
    unsigned bits = 0;
    size_t rest = length - i;
    if (rest == 1)
        return false;
    for (size_t k = 0; k < rest; k++) {
        unsigned value = values[(unsigned char)text[i + k]];
        if (value > 63)
            return false;
        bits |= value << (18 - 6 * k);
    }
    if (rest >= 2)
        out[count++] = (unsigned char)(bits >> 16);
    if (rest == 3)
        out[count++] = (unsigned char)(bits >> 8);
    *size = count;
    return true;
}
