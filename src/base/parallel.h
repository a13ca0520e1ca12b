/* parallel.h - a parallel loop. */
#ifndef BASE_PARALLEL_H
#define BASE_PARALLEL_H

#include "facet/facet.h"

/* Calls body(context, begin, end) for ranges of at most grain items (0: 1) that together are [0, count),
 * on thread_count threads (0: facet_thread_count()), and returns when all are done. The assignment of
 * ranges to threads is unspecified: a body must only write what belongs to its items. Runs on the calling
 * thread alone if threads cannot be created. Loops may be nested; an inner one creates threads of its own. */
void parallel_for(uint32_t thread_count, size_t count, size_t grain,
                  void (*body)(void *context, size_t begin, size_t end), void *context);

/* The number of threads, up to wanted (at most 256 are tried), that can be started concurrently now: for
 * libraries that end the process if a thread cannot be created. A limit on processes (ulimit -u) may
 * prevent that. */
uint32_t parallel_startable(uint32_t wanted);

#endif
