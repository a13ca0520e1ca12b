/* embree_library.c - opens Embree; see embree.h. */
#include "cpu/embree.h"

#include <pthread.h>

#include "base/result.h"

embree_library embree;
static pthread_mutex_t lock = PTHREAD_MUTEX_INITIALIZER;
static void *handle; /* NULL: not open; set under the lock */

static facet_result open_once(facet_error *error)
{
    const library_symbol symbols[] = {EMBREE_FUNCTIONS(LIBRARY_SYMBOL, &embree)};
    const library_desc desc = {.subject = "Embree",
                               .advice = ", which traces rays on the CPU, is not installed",
                               .missing = FACET_ERROR_SYSTEM,
                               .stays = true,
                               .symbols = symbols,
                               .symbol_count = sizeof symbols / sizeof *symbols};
    void *opened = NULL;
    TRY(library_open(FACET_EMBREE_SONAME, &desc, &opened, error));
    handle = opened;
    return FACET_OK;
}

facet_result embree_open(facet_error *error)
{
    pthread_mutex_lock(&lock);
    const facet_result result = handle ? FACET_OK : open_once(error);
    pthread_mutex_unlock(&lock);
    return result;
}
