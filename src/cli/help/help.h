/* help.h - the option table as text for people. */
#ifndef CLI_HELP_H
#define CLI_HELP_H

#include "cli/shared/options.h"

#include <stdio.h>

extern const char help_summary[];   /* what facet is, in one line */
extern const char help_first_use[]; /* how it begins, for the overview and facet(1) */

enum { HELP_TEXT_COLUMN = 31 }; /* where the text of an option stands */

void help_print_overview(FILE *stream);
/* The first examples and the options that matter most; all: everything. */
void help_print_verb(FILE *stream, const verb *v, bool all);
/* One option with its text. */
void help_print_option_line(FILE *stream, const option *o);
void help_print_exit_codes(FILE *stream);

#endif
