/* generate.h - man pages and completions from the table of options, for the build. */
#ifndef CLI_GENERATE_H
#define CLI_GENERATE_H

#include "cli/shared/options.h"
#include <stdio.h>
#include <stdbool.h>

/* Prints facet-VERB(1); v NULL: facet(1). version is "0.2.0". */
void man_page_print(FILE *stream, const verb *v, const char *version);

/* Prints a script for "bash", "zsh" or "fish". False, without output: another shell. */
bool completion_print(FILE *stream, const char *shell);

#endif
