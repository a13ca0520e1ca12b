/* batch_survey.h - the state of all items, in their order, without running any: for --verify and --gallery. */
#ifndef CLI_BATCH_SURVEY_H
#define CLI_BATCH_SURVEY_H

#include "cli/batch/batch_results.h"
#include "cli/batch/batch_source.h"

typedef struct batch_survey {
    const batch_plan *plan;
    const model_list *models;     /* NULL: none */
    const batch_history *history; /* of all runs so far */
    const json_t *messages;       /* of failed items by their id */
    uint64_t done, failed, missing;
} batch_survey;

/* Calls each() with every item, what is known about it (KNOWN_NOT: it is missing) and why it failed (NULL: unknown). Fails as
 * the source does; a manifest on standard input cannot be read again (FACET_ERROR_ARGUMENT). */
facet_result batch_survey_all(batch_survey *survey, void *user,
                              void (*each)(void *user, const batch_item *item, batch_known known,
                                           const char *message),
                              facet_error *error);

/* Prints a line on standard output for each item that is missing or failed. */
facet_result batch_verify(batch_survey *survey, bool is_quiet, facet_error *error);

/* Writes a page of images and failures to path, whose images are files beside it. */
facet_result batch_gallery_write(batch_survey *survey, const char *path, facet_error *error);

#endif
