/* help.h - help text from the table of options. */
#ifndef CLI_HELP_H
#define CLI_HELP_H

#include "cli/shared/options.h"

#include <stdio.h>

extern const char help_summary[];   /* facet in one line */
extern const char help_first_use[]; /* the first example, for the overview and facet(1) */

enum { HELP_TEXT_COLUMN = 31 }; /* column of the description of an option */

void help_print_overview(FILE *stream);
/* Prints the first examples and the main options; all: everything. */
void help_print_verb(FILE *stream, const verb *v, bool all);
/* Prints an option and its description. */
void help_print_option_line(FILE *stream, const option *o);
void help_print_exit_codes(FILE *stream);

/* ---- man pages and completions, for the build: generate.c ---- */

/* Prints facet-VERB(1); v NULL: facet(1). version is "0.2.0". */
void man_page_print(FILE *stream, const verb *v, const char *version);

/* Prints a script for "bash", "zsh" or "fish". False, without output: another shell. */
bool completion_print(FILE *stream, const char *shell);

#endif
