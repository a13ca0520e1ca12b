/* commands.h - what each verb of verbs.def defines in its folder: NAME_verb, its options and texts, and cmd_NAME(), which
 * runs it. cmd_NAME() returns the exit code and has reported what went wrong. */
#ifndef CLI_COMMANDS_H
#define CLI_COMMANDS_H

#include "cli/shared/command_line.h"

#define VERB(name)                                                                                           \
    extern const verb name##_verb;                                                                           \
    int cmd_##name(command_line *c);
#include "cli/shared/verbs.def"
#undef VERB

#endif
