/* output_name.h - the names of outputs: what {stem}, {name}, {dir}, {index}, #### and %04d in them become. */
#ifndef CLI_OUTPUT_NAME_H
#define CLI_OUTPUT_NAME_H

#include "base/result.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* The model that an output is of. */
typedef struct model_name {
    const char *path;     /* "-": standard input; NULL: the built-in scene */
    const char *folder;   /* {dir}, without slash at either end; "", NULL: none */
    size_t number, count; /* {index} is number, from 1 on, as wide as count is; 0: 1 of 1 */
} model_name;

/* Whether pattern has a place for a frame number: two or more # in a row, %d, %04d. */
bool output_name_has_frame(const char *pattern);
/* Whether pattern may have several models: one of {stem}, {name}, {dir}, {index} is in it. */
bool output_name_has_model(const char *pattern);

/* FACET_ERROR_ARGUMENT where pattern has a {word} that is none of words, separated by blanks; place begins the message. */
#define OUTPUT_NAME_WORDS "stem name dir index"
facet_result output_name_check(const char *place, const char *pattern, const char *words, facet_error *error);

/* Writes pattern with all places filled to name (size bytes): {stem} is the model's name without folder and extension,
 * {name} with its extension, and the frame number is filled with 0 to the width of its place. frame NULL: those places
 * stay. False: it does not fit. */
bool output_name_expand(const char *pattern, const model_name *model, const uint32_t *frame, char *name,
                        size_t size);

/* Whether path ends in one of types, extensions separated by blanks ("png jpg"), in upper or lower case. */
bool output_name_has_type(const char *path, const char *types);

/* Base name of path without its extension, "model" where that is empty. False: it does not fit. */
bool output_name_stem(const char *path, char *stem, size_t size);

#endif
