/* man_page.h - the option table as man pages in roff. */
#ifndef CLI_MAN_PAGE_H
#define CLI_MAN_PAGE_H

#include "cli/shared/options.h"

#include <stdio.h>

/* facet-VERB(1); v NULL: facet(1). version is "0.2.0". */
void man_page_print(FILE *stream, const verb *v, const char *version);

#endif
