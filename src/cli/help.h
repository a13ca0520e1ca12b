/* help.h - the option table as text for people. */
#ifndef CLI_HELP_H
#define CLI_HELP_H

#include "cli/options.h"

#include <stdio.h>

extern const char help_summary[];   /* what facet is, in one line */
extern const char help_first_use[]; /* how it begins, for the overview and facet(1) */

void help_print_overview(FILE *stream);
void help_print_verb(FILE *stream, const verb *v);
void help_print_exit_codes(FILE *stream);

#endif
