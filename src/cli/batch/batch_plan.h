/* batch_plan.h - what facet batch is to do: its options, and the words that all items share. */
#ifndef CLI_BATCH_PLAN_H
#define CLI_BATCH_PLAN_H

#include "cli/shared/command_line.h"
#include "cli/shared/shard.h"

typedef enum batch_resume { RESUME_NOTHING, RESUME_SETTINGS, RESUME_CONTENT } batch_resume;

typedef struct batch_plan {
    const verb *verb;         /* of items that name no other */
    const char *output;       /* pattern of names; NULL: none */
    const char *const *words; /* options of every item: the arguments after "--" */
    size_t word_count;
    unsigned job_count;        /* items at a time */
    uint32_t core_count;       /* CPUs that this process may use */
    uint64_t max_memory_bytes; /* of an item beside others; 0: no limit */
    uint64_t alone_bytes;      /* of an item that runs alone; 0: no limit */
    const char *time_text;     /* --time-limit; NULL: not given */
    double time_limit_s;       /* after which an item is ended at the latest; 0: no limit */
    batch_resume resume;
    shard shard;
    bool has_shard;
    const char *manifest, *gallery; /* NULL: none */
    bool verifies, is_dry;
    const char *result_pattern; /* --results; NULL: none */
    char *results, *failed;     /* files with the number of the shard; NULL: none */
} batch_plan;

/* Reads the options of the command line, with which most of the text stays. Fails with FACET_ERROR_ARGUMENT. */
facet_result batch_plan_read(const command_line *c, batch_plan *out, facet_error *error);

void batch_plan_destroy(batch_plan *plan);

/* The verb of an item by its name; NULL: it is none of batch_commands. */
const verb *batch_find_command(const char *name);
extern const char *const batch_commands[]; /* ends with NULL */

#endif
