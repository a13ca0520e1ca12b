/* inspect_text.h - the description of a model, laid out for reading. */
#ifndef CLI_INSPECT_TEXT_H
#define CLI_INSPECT_TEXT_H

#include <jansson.h>
#include <stdbool.h>
#include <stdio.h>

/* Prints what facet_scene_describe_json() said of the model name (docs/inspect.md has the members). Lists end after
 * 20 rows unless all. Members that are missing are left out. */
void inspect_print_text(FILE *stream, const char *name, const json_t *model, bool all);

#endif
