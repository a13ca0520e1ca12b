/* failure.h - failures of the command: exit codes, sentences, JSON. */
#ifndef CLI_FAILURE_H
#define CLI_FAILURE_H

#include "base/result.h"

#include <jansson.h>

/* Exit codes; exit_meanings describes them, docs/cli.md gives reasons. */
enum {
    EXIT_DONE = 0,
    EXIT_NEGATIVE = 1,
    EXIT_USAGE = 2,
    EXIT_READ = 3,
    EXIT_INVALID = 4,
    EXIT_UNSUPPORTED = 5,
    EXIT_WRITE = 6,
    EXIT_LIMIT = 7,
    EXIT_ENVIRONMENT = 8,
    EXIT_BUG = 70,
    EXIT_AGAIN = 75
};

/* One row of the table that help and the man pages print. */
typedef struct exit_meaning {
    const char *code;
    const char *meaning;
} exit_meaning;
extern const exit_meaning exit_meanings[]; /* ends with {NULL} */

/* The exit code of a result. FACET_ERROR_CANCELLED gives EXIT_AGAIN; interrupt_exit_code() has that of the
 * signal. */
int exit_code_of(facet_result result);

/* Prepends the name of the input to a general failure (memory, limit) unless the sentence begins with it,
 * and appends
 * --max-memory, limit bytes (0: none), to a lack of memory. */
void failure_complete(facet_error *error, const char *name, uint64_t limit);

/* A JSON string; null where text is NULL. Bytes that are not UTF-8, as names of files may have, become
 * U+FFFD. */
json_t *report_string_json(const char *text);
json_t *report_error_json(const facet_error *error, const char *model /* NULL: none */, int exit_code);

/* Prints root as one line on standard output. */
void report_print_json(const json_t *root);
/* Prints the JSON object of a command that failed before its work: facet, failures, exit_code. */
void report_print_failure_json(const facet_error *error, int exit_code);

#endif
