/* suggest.h - suggestions for mistyped options, verbs and words. */
#ifndef CLI_SUGGEST_H
#define CLI_SUGGEST_H

#include "cli/shared/options.h"
#include "facet/facet.h"

/* Number of edits (insertion, deletion, substitution, transposition) from a to b, ignoring case and the
 * difference of "-" and "_"; words are cut at 63 characters. */
unsigned edit_distance(const char *a, const char *b);

/* The word of a NULL-terminated list that is most similar to text; NULL: none. */
const char *suggest_word(const char *text, const char *const *words);
/* The verb that is most similar to text; NULL: none. */
const char *suggest_verb(const char *text);

/* FACET_ERROR_ARGUMENT for an unknown option name (without the dashes, length characters) of v, with a
 * suggestion: the counterpart of another tool's option, a planned option, the verb that has the option, or
 * a similar name. */
facet_result suggest_option(const verb *v, const char *name, size_t length, facet_error *error);
/* The same for a letter. */
facet_result suggest_letter(const verb *v, char letter, facet_error *error);
/* The counterpart of another tool's option; NULL: none. */
const char *suggest_foreign(const verb *v, const char *name, size_t length);

#endif
