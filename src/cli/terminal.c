/* terminal.c - what the standard streams are attached to, and text in columns. */
#define _DEFAULT_SOURCE
#include "cli/terminal.h"

#include <stdlib.h>
#include <string.h>
#include <sys/ioctl.h>
#include <unistd.h>

enum { WIDEST = 100, NARROWEST = 40 };

bool terminal_is(FILE *stream)
{
    return isatty(fileno(stream)) == 1;
}

bool terminal_has_color(FILE *stream)
{
    const char *no_color = getenv("NO_COLOR"), *term = getenv("TERM");
    return terminal_is(stream) && !(no_color && *no_color) && term && strcmp(term, "dumb") != 0;
}

int terminal_width(FILE *stream)
{
    const char *columns = getenv("COLUMNS");
    int width = columns ? atoi(columns) : 0;
    struct winsize size;
    if (width <= 0 && terminal_is(stream) && ioctl(fileno(stream), TIOCGWINSZ, &size) == 0)
        width = size.ws_col;
    if (width <= 0 || width > WIDEST)
        return WIDEST;
    return width < NARROWEST ? NARROWEST : width;
}

/* Columns that length bytes of UTF-8 take, one per code point. */
static int columns_of(const char *text, size_t length)
{
    int columns = 0;
    for (size_t i = 0; i < length; i++)
        columns += ((unsigned char)text[i] & 0xc0) != 0x80;
    return columns;
}

void terminal_wrap(FILE *stream, const char *text, int indent, int width, int *column)
{
    bool is_first = true;
    while (*(text += strspn(text, " "))) {
        size_t length = strcspn(text, " ");
        int word = columns_of(text, length);
        if (!is_first && *column + 1 + word > width) {
            fputc('\n', stream);
            *column = 0;
            is_first = true;
        }
        if (is_first && *column < indent) {
            fprintf(stream, "%*s", indent - *column, "");
            *column = indent;
        } else if (!is_first) {
            fputc(' ', stream);
            ++*column;
        }
        fwrite(text, 1, length, stream);
        *column += word;
        text += length;
        is_first = false;
    }
}
