/* job_options.h - the words of a job, from JSON objects whose members are long option names. */
#ifndef CLI_JOB_OPTIONS_H
#define CLI_JOB_OPTIONS_H

#include "cli/shared/options.h"
#include "facet/facet.h"

#include <jansson.h>

/* A command line being composed. {0} initially; words is NULL or NULL-terminated and holds copies. Running out of memory
 * sets has_failed. */
typedef struct job_words {
    char **words;
    size_t count, capacity;
    bool has_failed;
} job_words;

void job_words_add(job_words *w, const char *word);
void job_words_addf(job_words *w, const char *format, ...) __attribute__((format(printf, 2, 3)));
void job_words_add_all(job_words *w, const char *const *words); /* NULL-terminated; NULL: none */
void job_words_destroy(job_words *w);                           /* {0} is allowed */

/* Adds an option of v for each member of object but those in skipped (NULL-terminated; NULL: none): true for a flag, text, a
 * number, or an array for a value with commas, as in a file of --config. place begins messages: "jobs.jsonl: line 3". Fails
 * with FACET_ERROR_ARGUMENT for an unknown option or another type; job_words_check() checks the values. */
facet_result job_options_add(job_words *w, const verb *v, const json_t *object, const char *const *skipped,
                             const char *place, facet_error *error);

/* Parses the words, of which the first is the verb, by the table of its options. Fails with FACET_ERROR_ARGUMENT, and
 * FACET_ERROR_MEMORY if has_failed is set. */
facet_result job_words_check(const job_words *w, facet_error *error);

#endif
