/* parallel.h - one loop over several threads. */
#ifndef BASE_PARALLEL_H
#define BASE_PARALLEL_H

#include "facet/facet.h"

/* Calls body(context, begin, end) for ranges of at most grain items (0: 1) that together are [0, count), on
 * thread_count threads (0: facet_thread_count()), and returns when all are done. Which thread takes which range
 * is open: a body must write only what belongs to its items. Runs on the calling thread alone where threads
 * cannot be had. Loops may be nested; an inner one takes threads of its own. */
void parallel_for(uint32_t thread_count, size_t count, size_t grain,
                  void (*body)(void *context, size_t begin, size_t end), void *context);

/* How many of wanted threads (at most 256 are tried) can be started beside one another now: for libraries that end the
 * process where a thread is refused. A limit on processes refuses them (ulimit -u). */
uint32_t parallel_startable(uint32_t wanted);

#endif
