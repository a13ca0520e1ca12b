/* memory.h - blocks from a caller's allocator, and arenas of them. */
#ifndef BASE_MEMORY_H
#define BASE_MEMORY_H

#include "facet/facet.h"

enum { MEM_TAIL = 16 };

/* count * size bytes, aligned to 64 (a cache line, and every vector type), followed by MEM_TAIL readable
 * bytes, so that loops can load whole words; contents undefined, mem_zalloc: zero. NULL: no memory, or the
 * product overflows. A block of 0 bytes is not NULL. Every block stores its allocator (NULL and {0}:
 * malloc). */
void *mem_alloc(const facet_allocator *allocator, size_t count, size_t size);
void *mem_zalloc(const facet_allocator *allocator, size_t count, size_t size);
/* Resizes a block (never NULL) with its allocator; the common first bytes are kept and the old block is
 * released. On NULL block is unchanged. */
void *mem_resize(void *block, size_t count, size_t size);
void mem_free(void *block);         /* NULL is allowed */
size_t mem_size(const void *block); /* requested bytes */
/* Counts bytes that a library allocated by itself (negative: released) against the limit of allocator, if
 * that is a facet_budget's. False: over the limit; nothing is counted. */
bool mem_account(const facet_allocator *allocator, ptrdiff_t bytes);

/* Grows the array *items (NULL at first; *capacity elements of item_size bytes) to hold at least count. */
bool mem_reserve(const facet_allocator *allocator, void **items, size_t *capacity, size_t count,
                 size_t item_size);

/* Many small blocks with a common lifetime. One thread at a time may use an arena. */
typedef struct arena arena;
arena *arena_create(const facet_allocator *allocator);
void arena_destroy(arena *a);                            /* NULL is allowed */
void *arena_alloc(arena *a, size_t count, size_t size);  /* aligned to 16, undefined; NULL as mem_alloc() */
void *arena_zalloc(arena *a, size_t count, size_t size); /* zero */
char *arena_strdup(arena *a, const char *text);

/* a * b and a + b; false: overflow, *out is undefined. */
static inline bool checked_mul(size_t a, size_t b, size_t *out)
{
    return !__builtin_mul_overflow(a, b, out);
}
static inline bool checked_add(size_t a, size_t b, size_t *out)
{
    return !__builtin_add_overflow(a, b, out);
}

#endif
