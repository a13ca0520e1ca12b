/* help_verb.c - facet help: its arguments, options and help. */
#include "cli/shared/commands.h"

const verb help_verb = {
    .name = "help",
    .summary = "explain facet or one of its commands",
    .arguments = "[COMMAND|OPTION|WORD]",
    .max_arguments = 1,
    .words =
        (const char *const[]){
#define VERB(name) #name,
#include "cli/shared/verbs.def"
#undef VERB
            "exit-codes", "documents", NULL},
    .description =
        "Prints what facet --help or facet COMMAND --help print; of an option what it means and "
        "which commands have it; of another word all that mentions it. exit-codes and documents are "
        "topics.",
    .examples =
        (const example[]){{"facet help render", "render in short; with --help-all all of its options"},
                          {"facet help orbit", "an option, in all commands that have it"},
                          {"facet help --search ground", "all that mentions a word"},
                          {"facet help documents", "where the manual is"},
                          {"facet help exit-codes", "what 0 to 75 mean"},
                          {NULL, NULL}},
    .groups =
        (const option_group *const[]){OPTION_GROUP("Options", OPT_SEARCH, OPT_HELP, OPT_HELP_ALL), NULL},
};
