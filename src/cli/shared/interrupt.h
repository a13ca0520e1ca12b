/* interrupt.h - signals and the time limit: how the command is asked to stop, and how it then ends.
 *
 * SIGINT, SIGTERM, SIGHUP and SIGPIPE set a flag; long work polls it and cleans up. A second SIGINT kills. Between
 * interrupt_begin() and interrupt_end() nothing needs to be cleaned up, and a signal or the time limit ends the process
 * from the signal handler: reading a model cannot be cancelled in another way. Between interrupt_file_begin() and
 * interrupt_file_end() there is a file to complete or remove, and no section is open, whatever a command began: these
 * are called by what writes files (output.c, video.c), so that commands cannot get it wrong. */
#ifndef CLI_INTERRUPT_H
#define CLI_INTERRUPT_H

#include <stdbool.h>

#include "facet/facet.h"

/* tells_json: an end at the time limit is reported as one JSON object on standard output, too. */
void interrupt_install(bool tells_json);
/* The signal that came; 0: none. */
int interrupt_signal(void);

/* Begins a time limit for the process, s from now; 0: none. Without interrupt_install() there is no limit. */
void interrupt_set_deadline(double seconds);
/* Seconds that are left; a very large number where there is no limit. */
double interrupt_seconds_left(void);

/* From now on a signal or the time limit ends the process at once; the sentence for the latter is "NAME: the time limit
 * (--time-limit) was reached while DOING". has_bar: it replaces a progress bar. A section takes the place of one that is
 * open. */
void interrupt_begin(const char *name, const char *doing, bool has_bar);
void interrupt_begin_reading(const char *name);
/* The same for work that asks for signals and the time by itself, to end with a sentence of its own: it has 0.3 s for that. A
 * part of it that does not ask, as the ray tracer's construction of its tree, cannot hold the process up longer. */
void interrupt_begin_polling(const char *name, const char *doing, bool has_bar);
/* Ends the section, if one is open. */
void interrupt_end(void);

/* A file is begun, and later complete or removed. These nest. */
void interrupt_file_begin(void);
void interrupt_file_end(void);

/* FACET_ERROR_CANCELLED after a signal, FACET_ERROR_LIMIT after the time limit; name is the file in work. */
facet_result interrupt_check(const char *name, facet_error *error);

/* The exit code after an interruption: EXIT_AGAIN for SIGTERM, 128+N for others. */
int interrupt_exit_code(void);
/* Ends an interrupted command: returns the exit code for SIGTERM; for other signals the process ends here by that signal. */
int interrupt_exit(void);

/* Seconds since the process began, as far as it matters. */
double interrupt_clock(void);

#endif
