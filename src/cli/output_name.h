/* output_name.h - the names of pictures: {stem}, #### and %04d. */
#ifndef CLI_OUTPUT_NAME_H
#define CLI_OUTPUT_NAME_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Whether pattern has a place for a frame number: two or more # in a row, %d, %04d. */
bool output_name_has_frame(const char *pattern);
bool output_name_has_stem(const char *pattern);

/* Writes pattern with {stem} and the frame number put in, the latter filled with 0 to the width of the place, to
 * name (size bytes). False: it does not fit. */
bool output_name_expand(const char *pattern, const char *stem, uint32_t frame, char *name, size_t size);

/* The same for names of which there is one per model: {stem} only, #### and %04d stay. */
bool output_name_expand_stem(const char *pattern, const char *stem, char *name, size_t size);

/* Whether path ends in one of types, extensions separated by blanks ("png jpg"), in upper or lower case. */
bool output_name_has_type(const char *path, const char *types);

/* Base name of path without its extension, "model" where that is empty. False: it does not fit. */
bool output_name_stem(const char *path, char *stem, size_t size);

#endif
