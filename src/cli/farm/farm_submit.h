/* farm_submit.h - facet farm submit: from the command to the folder of the run with its scripts. */
#ifndef CLI_FARM_SUBMIT_H
#define CLI_FARM_SUBMIT_H

#include "cli/farm/farm_command.h"
#include "cli/farm/farm_script.h"
#include "cli/farm/farm_size.h"

#define FARM_DEFAULT_FOLDER "facet-run"

/* {0} initially. */
typedef struct farm_submission {
    const command_line *line; /* of facet farm */
    farm_command command;
    farm_items items; /* of a catalog */
    farm_script script;
    double target_s;
    char program[FARM_PATH_SIZE], place[FARM_PATH_SIZE];
} farm_submission;

/* Reads the options and the command, and counts the items of a catalog. */
facet_result farm_submission_read(const command_line *c, farm_submission *out, facet_error *error);
void farm_submission_destroy(farm_submission *s); /* {0} is allowed */

/* Makes the folder of the run, which must not hold another one, chooses the number of shards and writes the scripts. A
 * sample of a catalog without costs is rendered. */
facet_result farm_submission_prepare(farm_submission *s, farm_run *run, facet_error *error);

/* Prints the scripts. A catalog without costs is taken to need a second for each item. */
facet_result farm_submission_print(farm_submission *s, facet_error *error);

#endif
