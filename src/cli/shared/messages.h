/* messages.h - what the command says to people, on standard error. */
#ifndef CLI_MESSAGES_H
#define CLI_MESSAGES_H

#include "cli/shared/command_line.h"
#include "facet/facet.h"

typedef enum verbosity { VERBOSITY_QUIET, VERBOSITY_NORMAL, VERBOSITY_DETAILS, VERBOSITY_TIMINGS } verbosity;

typedef struct warning {
    char *text;
    unsigned count;
    bool is_printed;
} warning;

/* Where messages of the library go. {.verbosity} starts it. */
typedef struct messages {
    verbosity verbosity;
    warning *warnings; /* each cause once, in the order they came */
    size_t warning_count, warning_capacity;
} messages;

/* What --quiet and --verbose ask for. */
verbosity messages_verbosity(const command_line *c);
/* A log that keeps warnings and prints details as the verbosity says. */
facet_log messages_log(messages *m);
/* Prints the warnings that were not yet, each with how often it came. */
void messages_flush(messages *m);
/* Forgets the warnings: another model begins. */
void messages_clear(messages *m);

/* One line on standard error; what stands before the first ": " is the subject, in color on a terminal. */
void message_error(const char *format, ...) __attribute__((format(printf, 1, 2)));
/* The same where at least that much is wanted. */
void message_at(const messages *m, verbosity least, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

/* ---- progress: a bar, lines, or JSON ---- */

typedef enum progress_mode { PROGRESS_NONE, PROGRESS_BAR, PROGRESS_PLAIN, PROGRESS_JSON } progress_mode;

/* mode_index is the position in the table's list: auto, plain, json, none. A bar is shown on a terminal, after
 * 0.3 s: what is done sooner needs none. */
progress_mode progress_choose(int mode_index, bool is_quiet);

/* One operation, perhaps one of several pictures. */
typedef struct progress {
    progress_mode mode;
    const char *subject;       /* the file that it is about */
    double start;              /* interrupt_clock() */
    double done_before, share; /* what this operation is of the whole: fraction = done_before + share * f */
    double last_shown;         /* interrupt_clock() */
    int last_percent;
    const char *last_stage;
} progress;

/* A callback that shows p and cancels when a signal has come. */
facet_progress progress_callback(progress *p);

/* Takes the bar off the terminal, if one is shown; for whoever writes to it. */
void progress_clear(void);

#endif
