/* completion.h - the option table as completions for shells. */
#ifndef CLI_COMPLETION_H
#define CLI_COMPLETION_H

#include <stdbool.h>
#include <stdio.h>

/* A script for "bash", "zsh" or "fish". False: another shell; nothing is printed. */
bool completion_print(FILE *stream, const char *shell);

#endif
