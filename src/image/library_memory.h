/* library_memory.h - a caller's allocator for a library whose hooks carry no context (libspng). */
#ifndef IMAGE_LIBRARY_MEMORY_H
#define IMAGE_LIBRARY_MEMORY_H

#include "facet/facet.h"

/* Between begin and end the functions below take memory from allocator, on the calling thread. Returns what was
 * in force, for end. A block may be released on any thread and after end: it knows its allocator. */
const facet_allocator *library_memory_begin(const facet_allocator *allocator);
void library_memory_end(const facet_allocator *previous);
/* Whether the allocator had nothing to give since begin. */
bool library_memory_has_failed(void);

void *library_malloc(size_t size);
void *library_calloc(size_t count, size_t size);
void *library_realloc(void *block, size_t size);
void library_free(void *block);

#endif
