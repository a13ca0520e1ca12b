/* batch_results.h - the results of items: lines of JSON appended to a file, and what such files say about earlier runs. */
#ifndef CLI_BATCH_RESULTS_H
#define CLI_BATCH_RESULTS_H

#include "cli/batch/batch_item.h"
#include "cli/batch/batch_map.h"
#include "cli/jobs/job.h"

/* ---- writing ---- */

/* A file of lines that is appended to. {-1}: none. */
typedef struct batch_lines {
    int fd;
    const char *path;
} batch_lines;

/* Opens a file for appending, after the line that a killed process may have left incomplete. path NULL: none. Fails with
 * FACET_ERROR_WRITE. */
facet_result batch_lines_open(const char *path, batch_lines *out, facet_error *error);
void batch_lines_close(batch_lines *lines);
/* Appends object as one line by one call of the system, so that several processes may append to one file. Takes the
 * reference. Fails with FACET_ERROR_WRITE. */
facet_result batch_lines_add(batch_lines *lines, json_t *object, facet_error *error);

/* The line of a result. */
json_t *batch_result_json(const batch_item *item, const job_result *result, bool is_done);
/* The line of an item that an earlier run has finished. */
json_t *batch_kept_json(const batch_item *item);
/* The line of the manifest of a failed item, with the reason. */
json_t *batch_failed_json(const batch_item *item, int exit_code, const char *message);

/* ---- reading ---- */

typedef enum batch_known { KNOWN_NOT, KNOWN_DONE, KNOWN_FAILED } batch_known;

/* The last lines of items by their id: hashes of settings, and batch_known in the lowest two bits. {0}: empty. */
typedef batch_map batch_history;

/* Adds the lines of a file to history, and the messages of failed items by their id to messages (NULL: not wanted); lines that
 * are incomplete or of something else are ignored. A file that does not exist has none. Fails with FACET_ERROR_READ, _MEMORY. */
facet_result batch_history_read(batch_history *history, json_t *messages, const char *path,
                                facet_error *error);

/* Whether an earlier run has done the item with the same settings: the image has its tag, or the results know it and its output
 * is there. */
bool batch_is_done(const batch_history *history, const batch_item *item);

/* The entry of an item in a history. */
uint64_t batch_history_value(const batch_item *item, batch_known known);

/* What the last line about the item with the same settings says. */
batch_known batch_history_find(const batch_history *history, const batch_item *item);

#endif
