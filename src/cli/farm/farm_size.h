/* farm_size.h - the number of shards for which a shard takes minutes: from the costs in a manifest, or from a sample of its
 * items that is rendered here. */
#ifndef CLI_FARM_SIZE_H
#define CLI_FARM_SIZE_H

#include "base/result.h"

#include <stdint.h>

/* The items of a manifest, and what they cost. */
typedef struct farm_items {
    uint64_t count;
    uint64_t cost_count; /* items with a cost */
    double cost_s;       /* sum of their costs, core seconds */
} farm_items;

/* Counts the lines of a manifest that are not empty, and adds the members "cost". Fails with FACET_ERROR_READ, or with
 * FACET_ERROR_INVALID for a manifest without items and a cost that is no number. */
facet_result farm_items_count(const char *path, farm_items *out, facet_error *error);

/* Core seconds of all items: the costs, and their mean for items without cost. 0: no item has a cost. */
double farm_items_cost(const farm_items *items);

/* The number of shards that take target_s each on cpu_count cores, from 1 to shard_max. */
uint32_t farm_shard_count(double core_seconds, double target_s, uint32_t cpu_count, uint64_t shard_max);

/* The number of shards of which one is a sample: enough items for cpu_count cores to be busy, or all of them. */
uint32_t farm_sample_count(uint64_t item_count, uint32_t cpu_count);

#endif
