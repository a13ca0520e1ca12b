/* obj_names.c - names and other keys, numbered as they come: a hash table over their bytes. */
#include <string.h>

#include "io/obj/obj_reader.h"

struct obj_name {
    size_t offset; /* in bytes */
    uint32_t size;
    uint32_t hash;
};

/* Multiplications spread each 8 bytes over the word. */
static uint32_t hash_bytes(const void *bytes, size_t size)
{
    const unsigned char *p = bytes;
    uint64_t hash = 0x9e3779b97f4a7c15u ^ size;
    for (size_t i = 0; i < size; i += 8) {
        uint64_t word = 0;
        memcpy(&word, p + i, size - i < 8 ? size - i : 8);
        hash = (hash ^ word) * 0xbf58476d1ce4e5b9u;
        hash ^= hash >> 29;
    }
    hash *= 0x94d049bb133111ebu;
    return (uint32_t)(hash >> 32);
}

/* A table of at least twice as many slots as there are names; UINT32_MAX: free. */
static bool make_table(obj_names *names)
{
    size_t size = names->table_size ? 2 * names->table_size : 64;
    uint32_t *table = mem_alloc(&names->allocator, size, sizeof *table);
    if (!table)
        return false;
    memset(table, 0xff, size * sizeof *table);
    for (size_t i = 0; i < names->count; i++) {
        size_t slot = names->names[i].hash & (size - 1);
        while (table[slot] != UINT32_MAX)
            slot = (slot + 1) & (size - 1);
        table[slot] = (uint32_t)i;
    }
    mem_free(names->table);
    names->table = table;
    names->table_size = size;
    return true;
}

uint32_t obj_names_add(obj_names *names, const void *bytes, size_t size, bool *is_new)
{
    *is_new = false;
    if (2 * names->count >= names->table_size && !make_table(names))
        return UINT32_MAX;
    uint32_t hash = hash_bytes(bytes, size);
    size_t slot = hash & (names->table_size - 1);
    for (; names->table[slot] != UINT32_MAX; slot = (slot + 1) & (names->table_size - 1)) {
        const struct obj_name *name = &names->names[names->table[slot]];
        if (name->hash == hash && name->size == size && memcmp(names->bytes + name->offset, bytes, size) == 0)
            return names->table[slot];
    }
    if (names->count >= UINT32_MAX - 1 || size >= UINT32_MAX ||
        !mem_reserve(&names->allocator, (void **)&names->bytes, &names->byte_capacity, names->size + size + 1,
                     1) ||
        !mem_reserve(&names->allocator, (void **)&names->names, &names->capacity, names->count + 1,
                     sizeof *names->names))
        return UINT32_MAX;
    names->names[names->count] =
        (struct obj_name){.offset = names->size, .size = (uint32_t)size, .hash = hash};
    memcpy(names->bytes + names->size, bytes, size);
    names->size += size;
    names->bytes[names->size++] = 0;
    *is_new = true;
    return names->table[slot] = (uint32_t)names->count++;
}

const char *obj_names_get(const obj_names *names, uint32_t number, size_t *size)
{
    *size = names->names[number].size;
    return names->bytes + names->names[number].offset;
}

void obj_names_release(obj_names *names)
{
    mem_free(names->names);
    mem_free(names->bytes);
    mem_free(names->table);
    *names = (obj_names){.allocator = names->allocator};
}
