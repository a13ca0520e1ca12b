/* generate.h - what the build makes of the table of options: man pages and completions. */
#ifndef CLI_GENERATE_H
#define CLI_GENERATE_H

#include "cli/shared/options.h"
#include <stdio.h>
#include <stdbool.h>

/* facet-VERB(1); v NULL: facet(1). version is "0.2.0". */
void man_page_print(FILE *stream, const verb *v, const char *version);

/* A script for "bash", "zsh" or "fish". False: another shell; nothing is printed. */
bool completion_print(FILE *stream, const char *shell);

#endif
