/* verbs.c - the verbs of the command. */
#include "cli/shared/options.h"

#define VERB(name) &name##_verb,
const verb *const verbs[] = {
#include "cli/shared/verbs.def"
    NULL};
#undef VERB
