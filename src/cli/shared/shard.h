/* shard.h - --shard: the part of a job that one of several processes does. Every process gets the same command
 * but for its shard, and none knows the others. */
#ifndef CLI_SHARD_H
#define CLI_SHARD_H

#include "cli/shared/command_line.h"

enum { SHARD_COUNT_MAX = 1000000 };

/* Shard index of count, index < count. {0, 1} is the whole job. */
typedef struct shard {
    uint32_t index, count;
} shard;

/* Reads "I/N" (I from 0 to N - 1), "auto" (index and count from the environment) or "auto/N" (the index from the
 * environment). The variables of cluster engines are tried in a fixed order, after FACET_SHARD=I/N. A count is
 * never guessed: where the engine gives only an index, it comes from auto/N or from FACET_SHARD_COUNT. Fails with
 * FACET_ERROR_ARGUMENT. */
facet_result shard_parse(const char *text, shard *out, facet_error *error);

/* The shard of --shard; {0, 1} where it is not given. */
facet_result shard_read(const command_line *c, shard *out, facet_error *error);

/* Whether an item, numbered from 0, belongs to the shard. Of each count successive items every shard has one, at a
 * place that differs from block to block, so that neither expensive neighbours nor a period in the list (each eighth
 * model is large) fall to one shard. The number of items is not needed: lists may be streams. */
bool shard_has(shard s, uint64_t item);

/* The number of items below item_count that belong to the shard. */
uint64_t shard_size(shard s, uint64_t item_count);

#endif
