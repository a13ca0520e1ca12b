/* messages.c - what the command says to people: one sentence a line, file and place first. */
#define _POSIX_C_SOURCE 200809L
#include "cli/shared/messages.h"

#include "cli/shared/progress.h"
#include "cli/shared/terminal.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define RED "1;31"
#define YELLOW "1;33"

/* Prints text as one line; control characters of files must not reach the terminal. */
static void print_line(const char *said, const char *color)
{
    char disarmed[2048];
    snprintf(disarmed, sizeof disarmed, "%s", said);
    terminal_disarm(disarmed);
    const char *text = disarmed;
    progress_clear();
    const char *colon = strstr(text, ": ");
    bool has_color = color && colon && terminal_has_color(stderr);
    char line[2048];
    size_t n = 0;
    for (; *text && n < sizeof line - 16; text++) {
        if (has_color && n == 0)
            n = (size_t)snprintf(line, sizeof line, "\033[%sm", color);
        if (has_color && text == colon)
            n += (size_t)snprintf(line + n, sizeof line - n, "\033[0m");
        line[n++] = *text;
    }
    line[n++] = '\n';
    fwrite(line, 1, n, stderr);
}

static void print_formatted(const char *color, const char *format, va_list arguments)
{
    char text[2048];
    vsnprintf(text, sizeof text, format, arguments);
    print_line(text, color);
}

void message_error(const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    print_formatted(RED, format, arguments);
    va_end(arguments);
}

void message_at(const messages *m, verbosity least, const char *format, ...)
{
    if (m->verbosity < least)
        return;
    va_list arguments;
    va_start(arguments, format);
    print_formatted(NULL, format, arguments);
    va_end(arguments);
}

/* ---- warnings ---- */

static void add_warning(messages *m, const char *text)
{
    for (size_t i = 0; i < m->warning_count; i++)
        if (strcmp(m->warnings[i].text, text) == 0) {
            m->warnings[i].count++;
            return;
        }
    if (m->warning_count == m->warning_capacity) {
        size_t capacity = m->warning_capacity ? 2 * m->warning_capacity : 16;
        warning *grown = realloc(m->warnings, capacity * sizeof *grown);
        if (!grown)
            return;
        m->warnings = grown;
        m->warning_capacity = capacity;
    }
    char *copy = strdup(text);
    if (copy)
        m->warnings[m->warning_count++] = (warning){.text = copy, .count = 1};
}

static void receive(void *user, facet_log_level level, const char *text)
{
    messages *m = user;
    if (level == FACET_LOG_LEVEL_WARNING)
        add_warning(m, text);
    else
        message_at(m, VERBOSITY_DETAILS, "%s", text);
}

verbosity messages_verbosity(const command_line *c)
{
    return is_given(c, OPT_QUIET)             ? VERBOSITY_QUIET
           : c->values[OPT_VERBOSE].count > 1 ? VERBOSITY_TIMINGS
           : is_given(c, OPT_VERBOSE)         ? VERBOSITY_DETAILS
                                              : VERBOSITY_NORMAL;
}

facet_log messages_log(messages *m)
{
    return (facet_log){.user = m, .message = receive};
}

void messages_flush(messages *m)
{
    for (size_t i = 0; i < m->warning_count; i++) {
        warning *w = &m->warnings[i];
        if (w->is_printed || m->verbosity < VERBOSITY_NORMAL)
            continue;
        char text[2048];
        snprintf(text, sizeof text, w->count > 1 ? "%s (%u times)" : "%s", w->text, w->count);
        print_line(text, YELLOW);
        w->is_printed = true;
    }
}

void messages_clear(messages *m)
{
    for (size_t i = 0; i < m->warning_count; i++)
        free(m->warnings[i].text);
    free(m->warnings);
    m->warnings = NULL;
    m->warning_count = m->warning_capacity = 0;
}
