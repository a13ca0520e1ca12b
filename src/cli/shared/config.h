/* config.h - options from presets and JSON files. */
#ifndef CLI_CONFIG_H
#define CLI_CONFIG_H

#include "cli/shared/command_line.h"

/* Sets the options of --preset that are not set already. */
facet_result preset_apply(command_line *c, facet_error *error);

/* Storage of the values of a configuration file. {0} initially. */
typedef struct config {
    char **texts;
    size_t text_count;
} config;

/* Sets the options in the file of --config that are not set already: an object whose members are long
 * option names, with true for flags (a number for those that count), text, numbers, or arrays for values
 * with commas. Fails with FACET_ERROR_READ, _LIMIT, or _ARGUMENT (not a JSON object, unknown option, wrong
 * value). */
facet_result config_apply(command_line *c, config *storage, facet_error *error);
void config_destroy(config *storage);

#endif
