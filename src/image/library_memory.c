/* library_memory.c - see library_memory.h. */
#include "image/library_memory.h"

#include "base/memory.h"

/* The only variables outside of objects: such a hook is told a size and nothing else. They live as long as a call
 * into the library does. */
static _Thread_local const facet_allocator *current;
static _Thread_local bool has_failed;

static void *noted(void *block)
{
    has_failed = has_failed || !block;
    return block;
}

const facet_allocator *library_memory_begin(const facet_allocator *allocator)
{
    const facet_allocator *previous = current;
    current = allocator;
    has_failed = false;
    return previous;
}

void library_memory_end(const facet_allocator *previous)
{
    current = previous;
}

bool library_memory_has_failed(void)
{
    return has_failed;
}

void *library_malloc(size_t size)
{
    return noted(mem_alloc(current, size, 1));
}

void *library_calloc(size_t count, size_t size)
{
    return noted(mem_zalloc(current, count, size));
}

void *library_realloc(void *block, size_t size)
{
    return block ? noted(mem_resize(block, size, 1)) : library_malloc(size);
}

void library_free(void *block)
{
    mem_free(block);
}
