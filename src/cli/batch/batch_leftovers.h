/* batch_leftovers.h - temporary files that killed processes have left beside outputs. */
#ifndef CLI_BATCH_LEFTOVERS_H
#define CLI_BATCH_LEFTOVERS_H

#include "cli/batch/batch_map.h"

/* Temporary files that were there when a folder was first visited. {0} initially. */
typedef struct batch_leftovers {
    batch_map folders; /* visited */
    char **paths;
    size_t count;
} batch_leftovers;

/* Removes the temporary files of an output that an earlier run has left. Each folder is listed once. */
void batch_leftovers_remove(batch_leftovers *l, const char *output);
void batch_leftovers_destroy(batch_leftovers *l);

/* Removes all temporary files of an output, whose process has been killed. */
void batch_remove_temporaries(const char *output);

#endif
