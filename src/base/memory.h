/* memory.h - blocks from a caller's allocator, and arenas of them. */
#ifndef BASE_MEMORY_H
#define BASE_MEMORY_H

#include "facet/facet.h"

enum { MEM_TAIL = 16 };

/* count * size bytes, aligned to 64 (a cache line, and every vector type), with MEM_TAIL more behind them that may
 * be read, not written, so that loops can load whole words; contents undefined, mem_zalloc: zero. NULL: there is
 * none, or the product overflows. A block of 0 bytes is a block. Every block remembers its allocator (NULL and {0}:
 * malloc). */
void *mem_alloc(const facet_allocator *allocator, size_t count, size_t size);
void *mem_zalloc(const facet_allocator *allocator, size_t count, size_t size);
/* A larger or smaller block with the same first bytes, from the allocator of block (never NULL); block is
 * released. On NULL block stays as it was. */
void *mem_resize(void *block, size_t count, size_t size);
void mem_free(void *block);         /* NULL is allowed */
size_t mem_size(const void *block); /* bytes that were asked for */
/* Counts bytes that another library took by itself (negative: gave back) against the limit of allocator, where
 * allocator is that of a facet_budget. False: over the limit; they are not counted then. */
bool mem_account(const facet_allocator *allocator, ptrdiff_t bytes);

/* Grows the array *items (NULL at first; item_size bytes each, *capacity of them) to hold at least count. */
bool mem_reserve(const facet_allocator *allocator, void **items, size_t *capacity, size_t count,
                 size_t item_size);

/* Many small blocks that go together. One arena is used by one thread at a time. */
typedef struct arena arena;
arena *arena_create(const facet_allocator *allocator);
void arena_destroy(arena *a);                            /* NULL is allowed */
void *arena_alloc(arena *a, size_t count, size_t size);  /* aligned to 16, undefined; NULL as mem_alloc() */
void *arena_zalloc(arena *a, size_t count, size_t size); /* zero */
char *arena_strdup(arena *a, const char *text);

/* a * b and a + b; false: the result does not fit, *out is undefined. */
static inline bool checked_mul(size_t a, size_t b, size_t *out)
{
    return !__builtin_mul_overflow(a, b, out);
}
static inline bool checked_add(size_t a, size_t b, size_t *out)
{
    return !__builtin_add_overflow(a, b, out);
}

#endif
