/* terminal.c - see terminal.h. */
#define _DEFAULT_SOURCE
#include "cli/shared/terminal.h"

#include <stdarg.h>
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

/* Length of the UTF-8 sequence at c; 1 for ASCII and invalid bytes. */
static size_t sequence_length(const unsigned char *c)
{
    size_t length = *c >= 0xf0 && *c < 0xf8 ? 4 : *c >= 0xe0 ? 3 : *c >= 0xc2 ? 2 : 1;
    if (*c >= 0xf8)
        return 1;
    for (size_t i = 1; i < length; i++)
        if ((c[i] & 0xc0) != 0x80)
            return 1;
    return length;
}

void terminal_disarm(char *text)
{
    const unsigned char *in = (const unsigned char *)text;
    char *out = text;
    while (*in) {
        size_t length = sequence_length(in);
        bool is_control = *in < 0x20 || *in == 0x7f || (length == 1 && *in >= 0x80 && *in < 0xa0) ||
                          (length == 2 && in[0] == 0xc2 && in[1] < 0xa0);
        if (is_control)
            *out++ = '?';
        for (size_t i = 0; i < length && !is_control; i++)
            *out++ = (char)in[i];
        in += length;
    }
    *out = 0;
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

/* Columns of length bytes of UTF-8, one per code point. */
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

/* ---- tables ---- */

enum { WIDEST_COLUMN = 40 };

void table_add(table *t, const char *format, ...)
{
    if (t->cell_count == t->cell_capacity) {
        size_t capacity = t->cell_capacity ? 2 * t->cell_capacity : 64;
        char **grown = realloc(t->cells, capacity * sizeof *grown);
        if (!grown)
            return;
        t->cells = grown;
        t->cell_capacity = capacity;
    }
    char text[512];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    terminal_disarm(text);
    size_t size = strlen(text) + 1;
    char *cell = malloc(size);
    if (cell)
        t->cells[t->cell_count++] = memcpy(cell, text, size);
}

/* Code points of UTF-8 text, which is nearly always its width. */
static int width_of(const char *text)
{
    int width = 0;
    for (; *text; text++)
        width += ((unsigned char)*text & 0xc0) != 0x80;
    return width;
}

void table_print(table *t, FILE *stream, int indent)
{
    int widths[TABLE_COLUMNS] = {0};
    for (size_t i = 0; i < t->cell_count; i++) {
        int width = width_of(t->cells[i]), *widest = &widths[i % t->column_count];
        if (width > *widest)
            *widest = width < WIDEST_COLUMN ? width : WIDEST_COLUMN;
    }
    int missing = indent; /* blanks before the next text: none at the end of a line */
    for (size_t i = 0; i < t->cell_count; i++) {
        size_t column = i % t->column_count;
        int width = width_of(t->cells[i]);
        if (width)
            fprintf(stream, "%*s%s", missing, "", t->cells[i]);
        missing = (width ? 0 : missing) + (width < widths[column] ? widths[column] - width : 0) + 2;
        if (column + 1 == t->column_count) {
            fputc('\n', stream);
            missing = indent;
        }
        free(t->cells[i]);
    }
    free(t->cells);
    *t = (table){.column_count = t->column_count};
}
