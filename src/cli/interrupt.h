/* interrupt.h - signals and the time limit: how the command is asked to stop, and how it then ends.
 *
 * SIGINT, SIGTERM, SIGHUP and SIGPIPE set a flag; whoever works on something long asks for it and cleans up. A second SIGINT
 * kills. While nothing that must be cleaned up is open (interrupt_set_safe()), the time limit ends the process from
 * the signal handler: reading a model cannot be cancelled in another way. */
#ifndef CLI_INTERRUPT_H
#define CLI_INTERRUPT_H

#include <stdbool.h>

#include "facet/facet.h"

/* tells_json: what ends the process at the time limit is told as one JSON object on standard output, too. */
void interrupt_install(bool tells_json);
/* The signal that came; 0: none. */
int interrupt_signal(void);

/* Begins a time limit for the process, s from now; 0: none. */
void interrupt_set_deadline(double seconds);
/* Seconds that are left; a very large number where there is no limit. */
double interrupt_seconds_left(void);

/* From now on it is safe to end the process at once, with exit code and the static sentence message, when a signal
 * or the time limit says so; message NULL: no longer. */
void interrupt_set_safe(const char *message_at_deadline);

/* The same with a sentence that the limit came while something was done for name; has_bar: over a bar of progress. */
void interrupt_begin(const char *name, const char *doing, bool has_bar);
void interrupt_begin_reading(const char *name);

/* FACET_ERROR_CANCELLED after a signal, FACET_ERROR_LIMIT after the time limit; name is the file in work. */
facet_result interrupt_check(const char *name, facet_error *error);

/* The exit code after an interruption: EXIT_AGAIN for SIGTERM; for others the process ends here by that signal. */
int interrupt_exit(void);

/* Seconds since the process began, as far as it matters. */
double interrupt_clock(void);

#endif
