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

#endif
