/* batch_source.h - the items of facet batch, one after the other: of arguments, folders and lists, then of a manifest, which
 * is read as a stream. */
#ifndef CLI_BATCH_SOURCE_H
#define CLI_BATCH_SOURCE_H

#include "cli/batch/batch_item.h"
#include "cli/shared/model_list.h"

typedef enum batch_next {
    NEXT_ITEM,
    NEXT_LATER, /* standard input has no complete line yet: poll its descriptor */
    NEXT_END,
    NEXT_FAILED
} batch_next;

typedef struct batch_source batch_source;

/* Opens the items of the plan; models may be NULL. Both stay with the caller. FACET_ERROR_READ, _MEMORY. */
facet_result batch_source_open(const batch_plan *plan, const model_list *models, batch_source **source,
                               facet_error *error);
void batch_source_close(batch_source *source); /* NULL is allowed */

/* The next item of the plan's shard, which the caller owns. A line that is too long, above 1 MiB, is an item with a
 * problem. NEXT_FAILED: the manifest cannot be read (FACET_ERROR_READ), or there is no memory (_MEMORY). */
batch_next batch_source_next(batch_source *source, batch_item **item, facet_error *error);

/* The descriptor to poll after NEXT_LATER. */
int batch_source_descriptor(const batch_source *source);

/* The number of items of the shard; UINT64_MAX: unknown, as the manifest is a stream. */
uint64_t batch_source_count(const batch_source *source);

#endif
