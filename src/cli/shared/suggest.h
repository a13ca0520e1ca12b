/* suggest.h - what the user may have meant. */
#ifndef CLI_SUGGEST_H
#define CLI_SUGGEST_H

#include "cli/shared/options.h"
#include "facet/facet.h"

/* Edits (insert, delete, replace, swap neighbours) that turn a into b, ignoring case, "-" and "_"; words longer
 * than 63 characters are cut. */
unsigned edit_distance(const char *a, const char *b);

/* The word of a NULL-terminated list that is near to text; NULL: none is. */
const char *suggest_word(const char *text, const char *const *words);
/* The verb that is near to text; NULL: none is. */
const char *suggest_verb(const char *text);

/* FACET_ERROR_ARGUMENT that says that v has no option name (without the dashes, length characters), and which one
 * does the same: under the name of another tool, planned, or mistyped. */
facet_result suggest_option(const verb *v, const char *name, size_t length, facet_error *error);
/* The same for a letter. */
facet_result suggest_letter(const verb *v, char letter, facet_error *error);
/* What to write for name, an option of another tool; NULL: none is called so. */
const char *suggest_foreign(const verb *v, const char *name, size_t length);

#endif
