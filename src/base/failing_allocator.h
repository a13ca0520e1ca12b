/* failing_allocator.h - for tests: memory that runs out at a chosen call, and a count of what is not given back. */
#ifndef BASE_FAILING_ALLOCATOR_H
#define BASE_FAILING_ALLOCATOR_H

#include <stdatomic.h>
#include <stdlib.h>

#include "facet/facet.h"

/* {.fail_at = n} refuses call number n (from 0); negative: none. */
typedef struct failing_allocator {
    long fail_at;
    atomic_long calls;  /* of allocate, so far */
    atomic_long blocks; /* that were given and not returned */
} failing_allocator;

static inline void *failing_allocate(void *user, size_t size)
{
    failing_allocator *f = user;
    if (atomic_fetch_add(&f->calls, 1) == f->fail_at)
        return NULL;
    atomic_fetch_add(&f->blocks, 1);
    return malloc(size);
}

static inline void failing_release(void *user, void *memory, size_t size)
{
    (void)size;
    atomic_fetch_sub(&((failing_allocator *)user)->blocks, 1);
    free(memory);
}

static inline facet_allocator failing_allocator_get(failing_allocator *f)
{
    return (facet_allocator){.user = f, .allocate = failing_allocate, .release = failing_release};
}

#endif
