/* shell_line.h - a command line for a shell, word by word. */
#ifndef CLI_SHELL_LINE_H
#define CLI_SHELL_LINE_H

#include "cli/shared/options.h"

/* {0} initially. */
typedef struct shell_line {
    char *text; /* malloc() memory; NULL: empty */
    size_t length, capacity;
    bool has_failed; /* no memory */
} shell_line;

void shell_line_add_bytes(shell_line *l, const char *bytes, size_t size);
/* Appends a word, quoted if necessary. */
void shell_line_add_word(shell_line *l, const char *word);
/* Appends --name=value if the value could be taken for an option, else --name value, or a flag. */
void shell_line_add_option(shell_line *l, const option *o, const char *value);

#endif
