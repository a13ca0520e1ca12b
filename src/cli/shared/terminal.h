/* terminal.h - what the standard streams are attached to. */
#ifndef CLI_TERMINAL_H
#define CLI_TERMINAL_H

#include <stddef.h>
#include <stdbool.h>
#include <stdio.h>

bool terminal_is(FILE *stream);
/* Whether escape sequences for color are welcome there: a terminal, not a dumb one, and NO_COLOR is not set. */
bool terminal_has_color(FILE *stream);
/* Replaces what a terminal would act on by "?": control characters of ASCII, those from U+0080 to U+009F (U+009B begins
 * an escape sequence as ESC [ does), and such bytes outside of UTF-8. */
void terminal_disarm(char *text);
/* Columns to write text in: COLUMNS or the terminal's, at most 100; 100 where neither is known. */
int terminal_width(FILE *stream);

/* Prints text at column indent in lines of at most width columns, continued at the same column; *column is where
 * the stream stands and will stand. Words are separated by single blanks. */
void terminal_wrap(FILE *stream, const char *text, int indent, int width, int *column);

enum { TABLE_COLUMNS = 10 };

/* Cells row by row; {.column_count} starts it. A column is as wide as its widest cell, at most 40. */
typedef struct table {
    size_t column_count;
    char **cells;
    size_t cell_count, cell_capacity;
} table;

/* Adds a cell; control characters, which names in files may have, become "?". */
void table_add(table *t, const char *format, ...) __attribute__((format(printf, 2, 3)));
/* Prints the rows, each after indent blanks, and empties the table. */
void table_print(table *t, FILE *stream, int indent);

#endif
