/* farm_program.h - runs other programs: those of Slurm, and facet itself. */
#ifndef CLI_FARM_PROGRAM_H
#define CLI_FARM_PROGRAM_H

#include "base/result.h"

/* Runs words (NULL-terminated; words[0] is found by PATH) in folder and waits for its end. *output is what it printed, a
 * text for free(). is_quiet: its messages are discarded, for programs that may be missing or fail. Fails with
 * FACET_ERROR_SYSTEM where it cannot be run, ends by a signal, or exits with a code above max_exit_code. */
facet_result farm_program_run(const char *const *words, const char *folder, bool is_quiet, int max_exit_code,
                              char **output, facet_error *error);

#endif
