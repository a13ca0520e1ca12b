/* utf8.h - UTF-8 (RFC 3629), and text of another encoding made UTF-8. */
#ifndef BASE_UTF8_H
#define BASE_UTF8_H

#include <stdbool.h>
#include <stddef.h>

/* Length of the sequence at s in bytes, 1 to 4; 0: it is none (overlong, a surrogate, above U+10FFFF), or goes on beyond
 * size. In text that ends with a 0 size may be SIZE_MAX: no sequence contains a 0. */
size_t utf8_length(const void *s, size_t size);
bool utf8_is_valid(const char *text, size_t size);
/* Copies text and takes bytes that are no UTF-8 for Latin-1; returns the length of the copy. out has 2 * size bytes and
 * gets no 0 at the end. */
size_t utf8_from_latin1(const char *text, size_t size, char *out);

#endif
