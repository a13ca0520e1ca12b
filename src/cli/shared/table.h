/* table.h - text in columns. */
#ifndef CLI_TABLE_H
#define CLI_TABLE_H

#include <stddef.h>
#include <stdio.h>

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
