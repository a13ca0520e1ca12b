/* verbs.c - the verbs whose options the viewer parses. */
#include "cli/shared/options.h"

const verb *const verbs[] = {&render_verb, NULL};
