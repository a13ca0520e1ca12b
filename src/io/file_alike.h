/* file_alike.h - finds files whose names on disk differ from those in a model in case or in Unicode
 * normalization (e with acute is one code point or two). */
#ifndef IO_FILE_ALIKE_H
#define IO_FILE_ALIKE_H

#include "facet/facet.h"

/* Whether two names differ in nothing else. Bytes that are not UTF-8 count as Latin-1. Covers Latin,
 * Greek, Cyrillic, kana and Hangul. */
bool file_names_are_alike(const char *a, const char *b);

/* The path below folder of the regular file that path refers to; for each part the exact name, else the
 * only alike one. A block of mem_alloc(). NULL: no file or several, or (*has_failed) no memory. *budget:
 * folder entries that may still be examined, which bounds the time for a model with many missing files. */
char *file_find_alike(const facet_allocator *allocator, const char *folder, const char *path, size_t *budget,
                      bool *has_failed);

#endif
