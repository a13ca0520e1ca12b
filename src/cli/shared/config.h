/* config.h - options from elsewhere than the command line: presets and JSON files. */
#ifndef CLI_CONFIG_H
#define CLI_CONFIG_H

#include "cli/shared/command_line.h"

/* Sets what --preset stands for, where it is not set already. */
facet_result preset_apply(command_line *c, facet_error *error);

/* Text that values of a config file live in. {0} starts it. */
typedef struct config {
    char **texts;
    size_t text_count;
} config;

/* Sets what the file of --config says, where it is not set already: an object whose members are long names of options;
 * true for flags (a number for those that count), text, numbers, or arrays that stand for values with commas. Fails
 * with FACET_ERROR_READ, _LIMIT, or _ARGUMENT (no JSON object, no such option, wrong value). */
facet_result config_apply(command_line *c, config *storage, facet_error *error);
void config_destroy(config *storage);

#endif
