/* obj_table.h - a hash table of vertices by their indices of position, texture coordinate and normal. */
#ifndef IO_OBJ_TABLE_H
#define IO_OBJ_TABLE_H

#include <string.h>

#include "base/memory.h"

typedef struct obj_key {
    uint32_t v, t, n;
    uint32_t vertex; /* the value; not part of the key */
} obj_key;

/* Slots hold indices of keys; UINT32_MAX: none. The first slot follows the position, since most positions
 * have one vertex, and consecutive corners have positions that are near in memory; further slots are
 * spread by all three indices, so that a position with a million vertices is not slower. */
typedef struct obj_table {
    const facet_allocator *allocator;
    uint32_t *slots;
    obj_key *keys;
    size_t size, slot_room, key_room, count;
} obj_table;

static inline uint32_t obj_key_step(const obj_key *k)
{
    uint64_t h = k->v * 0x9e3779b97f4a7c15u ^ k->t * 0xbf58476d1ce4e5b9u ^ k->n * 0x94d049bb133111ebu;
    h ^= h >> 32;
    h *= 0xd6e8feb86659fd93u;
    return (uint32_t)(h >> 32) | 1u; /* odd: visits all slots */
}

static inline bool obj_table_resize(obj_table *t, size_t size)
{
    if (!mem_reserve(t->allocator, (void **)&t->slots, &t->slot_room, size, sizeof *t->slots) ||
        !mem_reserve(t->allocator, (void **)&t->keys, &t->key_room, size / 2, sizeof *t->keys))
        return false;
    memset(t->slots, 0xff, size * sizeof *t->slots);
    t->size = size;
    return true;
}

/* Clears the table for about that many lookups. */
static inline bool obj_table_reset(obj_table *t, size_t lookups)
{
    size_t size = 16;
    while (size < 2 * lookups && size < (size_t)1 << 15)
        size *= 2;
    t->count = 0;
    return obj_table_resize(t, size);
}

static inline void obj_table_place(obj_table *t, uint32_t number)
{
    size_t slot = t->keys[number].v & (t->size - 1);
    uint32_t step = obj_key_step(&t->keys[number]);
    while (t->slots[slot] != UINT32_MAX)
        slot = (slot + step) & (t->size - 1);
    t->slots[slot] = number;
}

/* The value of the first lookup of the key, which k.vertex becomes if it is new. UINT32_MAX: no memory. */
static inline uint32_t obj_table_find(obj_table *t, obj_key k)
{
    size_t slot = k.v & (t->size - 1);
    uint32_t step = 0;
    for (uint32_t i; (i = t->slots[slot]) != UINT32_MAX;) {
        if (t->keys[i].v == k.v && t->keys[i].t == k.t && t->keys[i].n == k.n)
            return t->keys[i].vertex;
        step = step ? step : obj_key_step(&k);
        slot = (slot + step) & (t->size - 1);
    }
    if (2 * (t->count + 1) > t->size) {
        if (!obj_table_resize(t, 2 * t->size))
            return UINT32_MAX;
        for (uint32_t i = 0; i < t->count; i++)
            obj_table_place(t, i);
    }
    t->keys[t->count] = k;
    obj_table_place(t, (uint32_t)t->count++);
    return k.vertex;
}

static inline void obj_table_release(obj_table *t)
{
    mem_free(t->slots);
    mem_free(t->keys);
}

#endif
