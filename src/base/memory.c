/* memory.c - see memory.h. */
#define _GNU_SOURCE
#include "base/memory.h"

#include <stdatomic.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>

#include "base/result.h"

enum { ALIGNMENT = 64 };
static const size_t HUGE_PAGE = (size_t)2 << 20;

/* Precedes each block. */
typedef struct header {
    facet_allocator allocator;
    void *base;        /* what the allocator returned */
    size_t base_size;  /* its size */
    size_t block_size; /* size of the caller's block */
} header;

_Static_assert(sizeof(header) <= ALIGNMENT, "the header stands in one alignment unit before the block");
/* A base is 2 * ALIGNMENT larger than its block, which starts at most this far behind it. */
_Static_assert(sizeof(header) + ALIGNMENT - 1 + MEM_TAIL <= 2 * ALIGNMENT, "the tail is inside the base");

static header *header_of(const void *block)
{
    return (header *)((uintptr_t)block - sizeof(header));
}

/* Memory for free(). Page faults of 4 KiB dominate the first use of a large block, and translating addresses
 * its random use: blocks are requested in huge pages where the system has them, whole ones for blocks between 5/8 of a
 * page and two pages, of which at most 3/8 of a page remain unused. */
static void *allocate(size_t size)
{
    if (size < HUGE_PAGE / 8 * 5)
        return malloc(size);
    const size_t rounding = size < 2 * HUGE_PAGE ? HUGE_PAGE / 8 * 3 : 0;
    const size_t advised = (size + rounding) & ~(HUGE_PAGE - 1);
    void *memory = NULL;
    if (posix_memalign(&memory, HUGE_PAGE, size < advised ? advised : size) != 0)
        return NULL;
#ifdef MADV_HUGEPAGE
    madvise(memory, advised, MADV_HUGEPAGE); /* only advice: failure is fine */
#endif
    return memory;
}

void *mem_alloc(const facet_allocator *allocator, size_t count, size_t size)
{
    size_t block_size;
    size_t base_size;
    if (!checked_mul(count, size, &block_size) || !checked_add(block_size, 2 * ALIGNMENT, &base_size) ||
        base_size > PTRDIFF_MAX)
        return NULL;
    bool is_custom = allocator && allocator->allocate;
    void *base = is_custom ? allocator->allocate(allocator->user, base_size) : allocate(base_size);
    if (!base)
        return NULL;
    void *block = (void *)(((uintptr_t)base + sizeof(header) + ALIGNMENT - 1) & ~(uintptr_t)(ALIGNMENT - 1));
    *header_of(block) = (header){.allocator = is_custom ? *allocator : (facet_allocator){0},
                                 .base = base,
                                 .base_size = base_size,
                                 .block_size = block_size};
    return block;
}

void *mem_zalloc(const facet_allocator *allocator, size_t count, size_t size)
{
    void *block = mem_alloc(allocator, count, size);
    if (block)
        memset(block, 0, count * size);
    return block;
}

void mem_free(void *block)
{
    if (!block)
        return;
    header h = *header_of(block);
    if (h.allocator.release)
        h.allocator.release(h.allocator.user, h.base, h.base_size);
    else
        free(h.base);
}

size_t mem_size(const void *block)
{
    return header_of(block)->block_size;
}

void *mem_resize(void *block, size_t count, size_t size)
{
    header h = *header_of(block);
    void *larger = mem_alloc(&h.allocator, count, size);
    if (!larger)
        return NULL;
    size_t wanted = count * size;
    memcpy(larger, block, wanted < h.block_size ? wanted : h.block_size);
    mem_free(block);
    return larger;
}

bool mem_reserve(const facet_allocator *allocator, void **items, size_t *capacity, size_t count,
                 size_t item_size)
{
    if (count <= *capacity)
        return true;
    size_t wanted = *capacity + *capacity / 2 > count ? *capacity + *capacity / 2 : count;
    if (wanted < 16)
        wanted = 16;
    void *larger = *items ? mem_resize(*items, wanted, item_size) : mem_alloc(allocator, wanted, item_size);
    if (!larger)
        return false;
    *items = larger;
    *capacity = wanted;
    return true;
}

/* ---- arena ---- */

typedef struct chunk {
    struct chunk *next;
    size_t used, capacity; /* bytes behind this header */
} chunk;

enum { CHUNK_HEADER = 64, CHUNK_SIZE = 64 * 1024 - 256, ARENA_ALIGNMENT = 16 };

struct arena {
    facet_allocator allocator;
    chunk *chunks; /* the first chunk has room */
};

arena *arena_create(const facet_allocator *allocator)
{
    arena *a = mem_zalloc(allocator, 1, sizeof *a);
    if (a && allocator)
        a->allocator = *allocator;
    return a;
}

void arena_destroy(arena *a)
{
    if (!a)
        return;
    for (chunk *c = a->chunks, *next; c; c = next) {
        next = c->next;
        mem_free(c);
    }
    mem_free(a);
}

void *arena_alloc(arena *a, size_t count, size_t size)
{
    size_t wanted;
    if (!checked_mul(count, size, &wanted) || wanted > PTRDIFF_MAX - 4 * CHUNK_HEADER)
        return NULL;
    wanted = (wanted + ARENA_ALIGNMENT - 1) & ~(size_t)(ARENA_ALIGNMENT - 1);
    chunk *c = a->chunks;
    if (!c || c->capacity - c->used < wanted) {
        size_t capacity = wanted > CHUNK_SIZE / 4 ? wanted : CHUNK_SIZE;
        c = mem_alloc(&a->allocator, 1, CHUNK_HEADER + capacity);
        if (!c)
            return NULL;
        c->used = 0;
        c->capacity = capacity;
        if (a->chunks &&
            capacity == wanted) { /* a large block gets its own chunk, behind the one with room */
            c->next = a->chunks->next;
            a->chunks->next = c;
        } else {
            c->next = a->chunks;
            a->chunks = c;
        }
    }
    void *block = (unsigned char *)c + CHUNK_HEADER + c->used;
    c->used += wanted;
    return block;
}

void *arena_zalloc(arena *a, size_t count, size_t size)
{
    void *block = arena_alloc(a, count, size);
    if (block)
        memset(block, 0, count * size);
    return block;
}

char *arena_strdup(arena *a, const char *text)
{
    size_t size = strlen(text) + 1;
    char *copy = arena_alloc(a, size, 1);
    if (copy)
        memcpy(copy, text, size);
    return copy;
}

/* ---- budget ---- */

struct facet_budget {
    uint64_t limit;
    _Atomic uint64_t used;
    _Atomic uint64_t peak;
};

facet_result facet_budget_create(uint64_t limit_bytes, facet_budget **budget, facet_error *error)
{
    *budget = calloc(1, sizeof **budget);
    if (!*budget)
        return fail_memory(error, "memory budget", sizeof **budget);
    (*budget)->limit = limit_bytes;
    return FACET_OK;
}

void facet_budget_destroy(facet_budget *budget)
{
    free(budget);
}

/* False: size more bytes would exceed the limit. */
static bool budget_take(facet_budget *budget, uint64_t size)
{
    uint64_t used = atomic_fetch_add(&budget->used, size) + size;
    if (budget->limit && used > budget->limit) {
        atomic_fetch_sub(&budget->used, size);
        return false;
    }
    uint64_t peak = atomic_load(&budget->peak);
    while (used > peak && !atomic_compare_exchange_weak(&budget->peak, &peak, used))
        ;
    return true;
}

static void *budget_allocate(void *user, size_t size)
{
    facet_budget *budget = user;
    if (!budget_take(budget, size))
        return NULL;
    void *memory = allocate(size);
    if (!memory)
        atomic_fetch_sub(&budget->used, size);
    return memory;
}

static void budget_release(void *user, void *memory, size_t size)
{
    facet_budget *budget = user;
    free(memory);
    atomic_fetch_sub(&budget->used, size);
}

bool mem_account(const facet_allocator *allocator, ptrdiff_t bytes)
{
    if (!allocator || allocator->allocate != budget_allocate)
        return true;
    facet_budget *budget = allocator->user;
    if (bytes > 0)
        return budget_take(budget, (uint64_t)bytes);
    atomic_fetch_sub(&budget->used, (uint64_t)-bytes);
    return true;
}

facet_allocator facet_budget_allocator(facet_budget *budget)
{
    return (facet_allocator){.user = budget, .allocate = budget_allocate, .release = budget_release};
}

uint64_t facet_budget_used_bytes(const facet_budget *budget)
{
    return atomic_load(&budget->used);
}

uint64_t facet_budget_peak_bytes(const facet_budget *budget)
{
    return atomic_load(&budget->peak);
}
