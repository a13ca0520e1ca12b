/* name_table.h - the names that a file uses, and numbered suffixes that make others unique. */
#ifndef IO_NAME_TABLE_H
#define IO_NAME_TABLE_H

#include "base/index_table.h"

typedef struct name_table {
    const facet_allocator *allocator;
    struct name_entry *entries; /* block of mem_alloc() */
    index_table by_name;        /* with room for all entries */
    bool ignores_case;          /* ASCII letters only */
} name_table;

enum { NAME_NUMBER_ROOM = 24 }; /* for "_NUMBER" and the terminating 0 */

/* For up to count names, whose text must outlive the table. False: no memory. */
bool name_table_create(name_table *table, size_t count, bool ignores_case, const facet_allocator *allocator);
void name_table_destroy(name_table *table); /* {0} is allowed; leaves {0} */
bool name_table_has(const name_table *table, const char *name);
/* False: the name is in the table already. */
bool name_table_add(name_table *table, const char *name);
/* Adds name, unchanged or with the first free suffix "_NUMBER" from number on, for which the buffer has
 * NAME_NUMBER_ROOM bytes behind its end. Constant time on average: each name remembers the last suffix tried. */
void name_table_add_numbered(name_table *table, char *name, size_t number);

#endif
