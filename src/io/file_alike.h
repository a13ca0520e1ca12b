/* file_alike.h - files whose names on the disk differ from those in a model in upper and lower case, or in the form of
 * their letters: e with acute is one character or two, as systems differ. */
#ifndef IO_FILE_ALIKE_H
#define IO_FILE_ALIKE_H

#include "facet/facet.h"

/* Whether two names differ in nothing else. Bytes that are no UTF-8 count as Latin-1. Knows the letters of Latin, Greek,
 * Cyrillic, kana and Hangul. */
bool file_names_are_alike(const char *a, const char *b);

/* The path below folder of the regular file that path means: part by part the name that is there, else the only one alike.
 * A block of mem_alloc(). NULL: there is none, there are several, or (*has_failed) no memory. *budget: entries of folders
 * that may still be looked at, so that a model that names many files that are not there takes no longer than it may. */
char *file_find_alike(const facet_allocator *allocator, const char *folder, const char *path, size_t *budget,
                      bool *has_failed);

#endif
