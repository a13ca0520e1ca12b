/* table.c - text in columns. */
#include "cli/shared/table.h"

#include "cli/shared/terminal.h"

#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

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

/* Code points of UTF-8 text: as wide as it looks, nearly always. */
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
    int missing = indent; /* blanks that stand before the next text: none at the end of a line */
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
