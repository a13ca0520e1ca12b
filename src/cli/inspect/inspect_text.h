/* inspect_text.h - the description of a model as text. */
#ifndef CLI_INSPECT_TEXT_H
#define CLI_INSPECT_TEXT_H

#include <jansson.h>
#include <stdbool.h>
#include <stdio.h>

/* Prints the result of facet_scene_describe_json() for the model name (docs/inspect.md has the members).
 * Lists end after 20 rows unless all. Missing members are skipped. */
void inspect_print_text(FILE *stream, const char *name, const json_t *model, bool all);

#endif
