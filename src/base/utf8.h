/* utf8.h - UTF-8 (RFC 3629), and text of another encoding converted to it. */
#ifndef BASE_UTF8_H
#define BASE_UTF8_H

#include <stdbool.h>
#include <stddef.h>

/* Length of the UTF-8 sequence at s in bytes, 1 to 4; 0: invalid (overlong, a surrogate, above U+10FFFF)
 * or longer than size. For text that ends with a 0, size may be SIZE_MAX: no sequence contains a 0. */
size_t utf8_length(const void *s, size_t size);
bool utf8_is_valid(const char *bytes, size_t size);
/* Copies text, taking bytes that are not UTF-8 as Latin-1, and returns the length of the copy. out has 2 *
 * size bytes and is not terminated. */
size_t utf8_from_latin1(const char *bytes, size_t size, char *out);

#endif
