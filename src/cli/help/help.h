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

#endif
