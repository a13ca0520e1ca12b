/* messages.h - messages and progress on standard error. */
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

/* Receiver of the library's messages. {.verbosity} initially. */
typedef struct messages {
    verbosity verbosity;
    warning *warnings; /* each text once, in order of occurrence */
    size_t warning_count, warning_capacity;
} messages;

/* The verbosity of --quiet and --verbose. */
verbosity messages_verbosity(const command_line *c);
/* A log that collects warnings, and prints details by verbosity. */
facet_log messages_log(messages *m);
/* Prints the warnings that have not been printed, each with its count. */
void messages_flush(messages *m);
/* Clears the warnings, for the next model. */
void messages_clear(messages *m);

/* Prints a line on standard error; the text before the first ": " is the subject, in color on a terminal. */
void message_error(const char *format, ...) __attribute__((format(printf, 1, 2)));
/* The same, at that verbosity or above. */
void message_at(const messages *m, verbosity least, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

/* ---- progress: a bar, lines, or JSON ---- */

typedef enum progress_mode { PROGRESS_NONE, PROGRESS_BAR, PROGRESS_PLAIN, PROGRESS_JSON } progress_mode;

/* mode_index is the index in --progress' choices: auto, plain, json, none. A bar is shown on a terminal,
 * after 0.3 s. */
progress_mode progress_choose(int mode_index, bool is_quiet);

/* Progress of an operation, which may be one of several images. */
typedef struct progress {
    progress_mode mode;
    const char *subject;       /* name of the file */
    double start;              /* interrupt_clock() */
    double done_before, share; /* part of the whole: fraction = done_before + share * f */
    double last_shown;         /* interrupt_clock() */
    int last_percent;
    const char *last_stage;
} progress;

/* A callback that shows progress and cancels after a signal. */
facet_progress progress_callback(progress *p);

/* Shows a line in place of the bar; it is cut at the width of the terminal. */
void progress_line(const char *text);

/* Clears the bar, if one is shown, before other output. */
void progress_clear(void);

#endif
