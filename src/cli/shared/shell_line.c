/* shell_line.c - see shell_line.h. */
#include "cli/shared/shell_line.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

void shell_line_add_bytes(shell_line *l, const char *bytes, size_t size)
{
    if (l->length + size + 1 > l->capacity) {
        size_t capacity = 2 * (l->length + size) + 256;
        char *grown = l->has_failed ? NULL : realloc(l->text, capacity);
        l->has_failed = !grown;
        if (!grown)
            return;
        l->text = grown;
        l->capacity = capacity;
    }
    memcpy(l->text + l->length, bytes, size);
    l->length += size;
    l->text[l->length] = 0;
}

void shell_line_add_word(shell_line *l, const char *word)
{
    static const char harmless[] =
        "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-./,:=+@%^";
    if (l->length)
        shell_line_add_bytes(l, " ", 1);
    if (*word && strspn(word, harmless) == strlen(word)) {
        shell_line_add_bytes(l, word, strlen(word));
        return;
    }
    shell_line_add_bytes(l, "'", 1);
    for (; *word; word++)
        if (*word == '\'')
            shell_line_add_bytes(l, "'\\''", 4);
        else
            shell_line_add_bytes(l, word, 1);
    shell_line_add_bytes(l, "'", 1);
}

void shell_line_add_option(shell_line *l, const option *o, const char *value)
{
    char word[4300];
    bool is_joined = value[0] == '-';
    snprintf(word, sizeof word, "--%s%s%s", o->name, is_joined ? "=" : "", is_joined ? value : "");
    shell_line_add_word(l, word);
    if (!is_joined && option_takes_value(o))
        shell_line_add_word(l, value);
}
