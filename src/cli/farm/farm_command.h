/* farm_command.h - the command that a run does in shards: "batch --manifest jobs.jsonl -- --size 256". */
#ifndef CLI_FARM_COMMAND_H
#define CLI_FARM_COMMAND_H

#include "cli/shared/command_line.h"

/* {0} initially. */
typedef struct farm_command {
    const verb *verb;   /* one with --shard */
    const char **words; /* behind the verb, without the output of an image in parts */
    size_t word_count;
    command_line line; /* of all words */
    /* Options of facet merge, where shards are parts of an image, which have taken them from words: the output first. */
    const option *merge_options[4];
    size_t merge_option_count; /* 0: no merging */
} farm_command;

/* Checks and parses the words of a command, the verb first: it must have --shard and leave to facet farm what a run sets
 * itself. Fails with FACET_ERROR_ARGUMENT. */
facet_result farm_command_read(const char *const *words, size_t word_count, farm_command *out,
                               facet_error *error);
void farm_command_destroy(farm_command *c); /* {0} is allowed */

/* The value of an option of the command; NULL: not given, or it has none. */
const char *farm_command_option(const farm_command *c, const char *name);
/* Whether the command could have an option that it does not have. */
bool farm_command_lacks(const farm_command *c, const char *name);
/* Whether the command renders a catalog. */
bool farm_command_is_catalog(const farm_command *c);

#endif
