/* base64.h - reads base64 (RFC 4648); text_add_base64() of text.h writes it. */
#ifndef BASE_BASE64_H
#define BASE_BASE64_H

#include <stdbool.h>
#include <stddef.h>

/* Bytes that length characters decode to, at most. */
static inline size_t base64_bound(size_t length)
{
    return (length / 4 + 1) * 3;
}

/* Decodes length characters into out, base64_bound(length) bytes, and writes the number of bytes to *size. The
 * URL-safe alphabet, which some writers use, is accepted as well; padding may be missing. False: there are
 * other characters. */
bool base64_decode(const char *text, size_t length, unsigned char *out, size_t *size);

#endif
