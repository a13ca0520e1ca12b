/* version_verb.c - facet version: its arguments, options and help. */
#include "cli/shared/commands.h"

const verb version_verb = {
    .name = "version",
    .summary = "say which facet this is",
    .arguments = "",
    .description = "Prints the version; with -v also how it was built and what it found on this machine.",
    .examples = (const example[]){{"facet version -v", "for a bug report"}, {NULL, NULL}},
    .groups =
        (const option_group *const[]){OPTION_GROUP("Options", OPT_VERBOSE, OPT_JSON, OPT_HELP, OPT_HELP_ALL),
                                      NULL},
};
