/* batch_item.h - an item of facet batch: one run of a verb. */
#ifndef CLI_BATCH_ITEM_H
#define CLI_BATCH_ITEM_H

#include "cli/batch/batch_plan.h"
#include "cli/jobs/job_options.h"
#include "cli/shared/output.h"

#include <jansson.h>

enum { BATCH_NAME_SIZE = 4096, BATCH_HASH_SIZE = 40 };

typedef struct batch_item {
    uint64_t number; /* from 0, over all items of all shards */
    json_t *source;  /* the object of the manifest; of an argument one with its input */
    char *place;     /* of a manifest, "jobs.jsonl: line 3"; NULL: an argument */
    char *id;        /* of the manifest, else the output, else the input */
    char *name;      /* the first input, for messages */
    char *output;    /* NULL: none */
    char *problem;   /* why there is nothing to run: the line is wrong; NULL: nothing is wrong */
    const verb *verb;
    job_words words;              /* of the job, without --threads */
    char hash[BATCH_HASH_SIZE];   /* of version and settings, and with RESUME_CONTENT of the first input */
    bool has_threads, has_memory; /* the words name them */
    bool writes_sequence, has_metadata; /* several files; the file can carry the hash */
    double time_limit_s;                /* 0: none */

    unsigned tries;          /* so far */
    bool is_alone;           /* it runs, or is to run, without others */
    double due;              /* interrupt_clock() from which on it may be tried again */
    struct batch_item *next; /* of a list */
} batch_item;

/* An item for the model of an argument. NULL: no memory. */
batch_item *batch_item_from_model(const batch_plan *plan, const model_name *model, uint64_t number);

/* An item for a line of a manifest, of length bytes; place is "jobs.jsonl: line 3". line NULL: it is too long. A wrong
 * line gives an item with a problem. NULL: no memory. */
batch_item *batch_item_from_line(const batch_plan *plan, const char *line, size_t length, const char *place,
                                 uint64_t number);

void batch_item_destroy(batch_item *item); /* NULL is allowed */

#endif
