/* index_table.h - a hash table of indices by 32-bit keys, for arrays that are searched by content: the key
 * is a hash of it, and the caller compares the elements that index_table_next() gives. */
#ifndef BASE_INDEX_TABLE_H
#define BASE_INDEX_TABLE_H

#include <string.h>

#include "base/memory.h"

#define INDEX_TABLE_NONE UINT32_MAX

typedef struct index_entry {
    uint32_t key, index; /* index INDEX_TABLE_NONE: a free slot */
} index_entry;

/* {0}: empty. */
typedef struct index_table {
    index_entry *entries;
    size_t size; /* slots: a power of two, 0 or at least twice count */
    size_t count;
} index_table;

/* Fibonacci hashing: the multiplier is 2^64 over the golden ratio, made odd, so that consecutive keys are
 * spread. */
static inline size_t index_table_place(const index_table *t, uint32_t key)
{
    return (size_t)(key * UINT64_C(0x9e3779b97f4a7c15) >> 32) & (t->size - 1);
}

static inline void index_table_put(index_table *t, index_entry entry)
{
    size_t at = index_table_place(t, entry.key);
    while (t->entries[at].index != INDEX_TABLE_NONE)
        at = (at + 1) & (t->size - 1);
    t->entries[at] = entry;
}

/* Room for `more` entries. False: no memory, and the table is unchanged. */
static inline bool index_table_reserve(index_table *t, const facet_allocator *allocator, size_t more)
{
    size_t size = t->size ? t->size : 16;
    while (size / 2 < t->count + more)
        size *= 2;
    if (size == t->size)
        return true;
    index_table larger = {.size = size, .count = t->count};
    larger.entries = (index_entry *)mem_alloc(allocator, larger.size, sizeof *larger.entries);
    if (!larger.entries)
        return false;
    memset(larger.entries, 0xff, larger.size * sizeof *larger.entries);
    for (size_t i = 0; i < t->size; i++)
        if (t->entries[i].index != INDEX_TABLE_NONE)
            index_table_put(&larger, t->entries[i]);
    mem_free(t->entries);
    *t = larger;
    return true;
}

/* False: no memory. */
static inline bool index_table_add(index_table *t, const facet_allocator *allocator, uint32_t key,
                                   uint32_t index)
{
    if (!index_table_reserve(t, allocator, 1))
        return false;
    index_table_put(t, (index_entry){key, index});
    t->count++;
    return true;
}

/* Iterates over the entries of a key; *cursor starts at 0. INDEX_TABLE_NONE: no more. */
static inline uint32_t index_table_next(const index_table *t, uint32_t key, size_t *cursor)
{
    while (*cursor < t->size) {
        const index_entry *entry = &t->entries[(index_table_place(t, key) + (*cursor)++) & (t->size - 1)];
        if (entry->index == INDEX_TABLE_NONE)
            break;
        if (entry->key == key)
            return entry->index;
    }
    return INDEX_TABLE_NONE;
}

/* An entry of the key. */
static inline uint32_t index_table_find(const index_table *t, uint32_t key)
{
    size_t cursor = 0;
    return index_table_next(t, key, &cursor);
}

static inline void index_table_release(index_table *t)
{
    mem_free(t->entries);
    *t = (index_table){0};
}

/* FNV-1a of bytes; hash is INDEX_TABLE_HASH, or that of the bytes before. */
#define INDEX_TABLE_HASH UINT32_C(0x811c9dc5)
static inline uint32_t index_table_hash(uint32_t hash, const void *bytes, size_t size)
{
    for (size_t i = 0; i < size; i++)
        hash = (hash ^ ((const unsigned char *)bytes)[i]) * UINT32_C(0x01000193);
    return hash;
}

#endif
