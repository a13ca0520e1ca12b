/* commands.h - the verbs; cmd_NAME.c each. They return the exit code and have said what went wrong. */
#ifndef CLI_COMMANDS_H
#define CLI_COMMANDS_H

#include "cli/command_line.h"

int cmd_render(command_line *c);
int cmd_ocean(command_line *c);
int cmd_view(command_line *c);
int cmd_bake(command_line *c);
int cmd_convert(command_line *c);
int cmd_inspect(command_line *c);
int cmd_plot(command_line *c);
int cmd_compare(command_line *c);
int cmd_shaders(command_line *c);
int cmd_version(command_line *c);
int cmd_help(command_line *c);

#endif
