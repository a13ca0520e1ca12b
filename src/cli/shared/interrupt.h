/* interrupt.h - signals and the time limit. SIGINT, SIGTERM, SIGHUP and SIGPIPE set a flag; long work
 * polls it and cleans up. A second SIGINT kills. Between interrupt_begin() and interrupt_end() there is
 * nothing to clean up, and a signal or the time limit ends the process from the signal handler: reading a
 * model cannot be cancelled in another way. Between interrupt_file_begin() and interrupt_file_end() a file
 * must be completed or removed, and no section is open. Only the writers of files (output.c, video.c) call
 * these two. */
#ifndef CLI_INTERRUPT_H
#define CLI_INTERRUPT_H

#include <stdbool.h>

#include "facet/facet.h"

/* Installs the signal handlers. reports_json: an end at the time limit is also reported as a JSON object on
 * standard output. */
void interrupt_install(bool reports_json);
/* Forgets all of the state, for the child of a fork: no pending signal, no time limit. It resets no handler. */
void interrupt_reset(void);
/* The pending signal; 0: none. */
int interrupt_signal(void);

/* Sets the time limit of the process, seconds from now; 0: none. Has no effect without interrupt_install(). */
void interrupt_set_deadline(double seconds);
/* Remaining time, s; a very large number without a limit. */
double interrupt_seconds_left(void);

/* Opens a section, in which a signal or the time limit ends the process at once; at the time limit with
 * "NAME: the time limit (--time-limit) was reached while DOING". has_bar: the sentence replaces a progress
 * bar. A new section replaces an open one. */
void interrupt_begin(const char *name, const char *doing, bool has_bar);
void interrupt_begin_reading(const char *name);
/* The same for work that polls signals and time and ends with its own sentence: it has 0.3 s for that.
 * Stages that do not poll, such as a BVH build, cannot delay the end longer. */
void interrupt_begin_polling(const char *name, const char *doing, bool has_bar);
/* Ends the section, if one is open. */
void interrupt_end(void);

/* Bracket the writing of a file, at whose end it is complete or removed. They nest. */
void interrupt_file_begin(void);
void interrupt_file_end(void);

/* FACET_ERROR_CANCELLED after a signal, FACET_ERROR_LIMIT after the time limit; name is the current file. */
facet_result interrupt_check(const char *name, facet_error *error);

/* The exit code after an interruption: EXIT_AGAIN for SIGTERM, 128+N for others. */
int interrupt_exit_code(void);
/* Ends an interrupted command: returns the exit code for SIGTERM; for other signals the process ends here
 * by that signal. */
int interrupt_exit(void);

/* A monotonic clock, s. */
double interrupt_clock(void);

#endif
