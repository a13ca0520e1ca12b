/* terminal.h - terminals, wrapped text and tables. */
#ifndef CLI_TERMINAL_H
#define CLI_TERMINAL_H

#include <stddef.h>
#include <stdbool.h>
#include <stdio.h>

bool terminal_is(FILE *stream);
/* Whether to use color: a terminal that is not dumb, without NO_COLOR. */
bool terminal_has_color(FILE *stream);
/* Replaces control characters by "?": those of ASCII, U+0080 to U+009F (U+009B begins an escape sequence
 * as ESC [ does), and such bytes outside of UTF-8. */
void terminal_disarm(char *text);
/* Width of text: COLUMNS or the terminal's, at most 100; 100 if neither is known. */
int terminal_width(FILE *stream);

/* Prints text from column indent on, wrapped at width; *column is the column of the stream before and
 * after. Words are separated by single blanks. */
void terminal_wrap(FILE *stream, const char *text, int indent, int width, int *column);

enum { TABLE_COLUMNS = 10 };

/* Cells row by row; {.column_count} initially. A column is as wide as its widest cell, at most 40. */
typedef struct table {
    size_t column_count;
    char **cells;
    size_t cell_count, cell_capacity;
} table;

/* Adds a cell; control characters become "?". */
void table_add(table *t, const char *format, ...) __attribute__((format(printf, 2, 3)));
/* Prints the rows, indented by blanks, and clears the table. */
void table_print(table *t, FILE *stream, int indent);

#endif
