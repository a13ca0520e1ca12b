/* name_table.c - see name_table.h. */
#include "io/name_table.h"

#include <stdio.h>
#include <string.h>
#include <strings.h>

struct name_entry {
    const char *name;
    size_t next; /* suffixes below it are taken; 0: none was tried */
};

static uint32_t hash_name(const name_table *table, const char *name)
{
    uint32_t hash = INDEX_TABLE_HASH;
    for (; *name; name++) {
        unsigned char c = (unsigned char)*name;
        if (table->ignores_case && c >= 'A' && c <= 'Z')
            c = (unsigned char)(c | 0x20);
        hash = index_table_hash(hash, &c, 1);
    }
    return hash;
}

/* NULL: not in the table. */
static struct name_entry *find(const name_table *table, const char *name)
{
    uint32_t hash = hash_name(table, name);
    size_t cursor = 0;
    for (uint32_t i; (i = index_table_next(&table->by_name, hash, &cursor)) != INDEX_TABLE_NONE;)
        if ((table->ignores_case ? strcasecmp : strcmp)(table->entries[i].name, name) == 0)
            return &table->entries[i];
    return NULL;
}

bool name_table_create(name_table *table, size_t count, bool ignores_case, const facet_allocator *allocator)
{
    *table = (name_table){.allocator = allocator, .ignores_case = ignores_case};
    table->entries = mem_alloc(allocator, count, sizeof *table->entries);
    if (table->entries && count < INDEX_TABLE_NONE && index_table_reserve(&table->by_name, allocator, count))
        return true;
    name_table_destroy(table);
    return false;
}

void name_table_destroy(name_table *table)
{
    mem_free(table->entries);
    index_table_release(&table->by_name);
    *table = (name_table){0};
}

bool name_table_has(const name_table *table, const char *name)
{
    return find(table, name) != NULL;
}

bool name_table_add(name_table *table, const char *name)
{
    if (find(table, name))
        return false;
    uint32_t number = (uint32_t)table->by_name.count;
    table->entries[number] = (struct name_entry){.name = name};
    return index_table_add(&table->by_name, table->allocator, hash_name(table, name), number);
}

void name_table_add_numbered(name_table *table, char *name, size_t number)
{
    struct name_entry *base = find(table, name);
    if (!base) {
        name_table_add(table, name);
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
