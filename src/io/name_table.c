/* name_table.c - see name_table.h. */
#include "io/name_table.h"

#include <stdio.h>
#include <string.h>
#include <strings.h>

#include "base/memory.h"

typedef struct name_entry {
    const char *name; /* NULL: free */
    size_t next;      /* numbers below it are taken; 0: none was tried */
} name_entry;

/* FNV-1a. */
static size_t hash_name(const name_table *table, const char *name)
{
    uint64_t hash = 0xcbf29ce484222325u;
    for (; *name; name++) {
        unsigned char c = (unsigned char)*name;
        if (table->ignores_case && c >= 'A' && c <= 'Z')
            c = (unsigned char)(c | 0x20);
        hash = (hash ^ c) * 0x100000001b3u;
    }
    return (size_t)(hash ^ hash >> 32);
}

/* The entry of a name, or the free one that it would have. */
static name_entry *find(const name_table *table, const char *name)
{
    size_t at = hash_name(table, name) & (table->size - 1);
    for (; table->entries[at].name; at = (at + 1) & (table->size - 1))
        if ((table->ignores_case ? strcasecmp : strcmp)(table->entries[at].name, name) == 0)
            break;
    return &table->entries[at];
}

bool name_table_create(name_table *table, size_t count, bool ignores_case, const facet_allocator *allocator)
{
    *table = (name_table){.size = 16, .ignores_case = ignores_case};
    while (table->size / 2 < count)
        table->size *= 2;
    table->entries = mem_zalloc(allocator, table->size, sizeof *table->entries);
    return table->entries != NULL;
}

void name_table_destroy(name_table *table)
{
    mem_free(table->entries);
    *table = (name_table){0};
}

bool name_table_has(const name_table *table, const char *name)
{
    return find(table, name)->name != NULL;
}

bool name_table_add(name_table *table, const char *name)
{
    name_entry *entry = find(table, name);
    if (entry->name)
        return false;
    entry->name = name;
    return true;
}

void name_table_add_numbered(name_table *table, char *name, size_t number)
{
    name_entry *base = find(table, name);
    if (!base->name) {
        base->name = name;
        return;
    }
    char *end = name + strlen(name);
    if (number < base->next)
        number = base->next;
    do
        snprintf(end, NAME_NUMBER_ROOM, "_%zu", number++);
    while (!name_table_add(table, name));
    base->next = number;
}
