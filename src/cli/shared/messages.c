/* messages.c - messages, one sentence per line, and progress. */
#define _POSIX_C_SOURCE 200809L
#include "cli/shared/messages.h"

#include "cli/shared/interrupt.h"
#include "cli/shared/terminal.h"

#include <stdarg.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---- progress ---- */

enum { BAR_WIDTH = 24 };

/* Whether the terminal shows a bar; there is one terminal. */
static atomic_bool is_bar_shown;
/* Reports come from several threads; one of them prints, the others continue. */
static atomic_flag is_showing = ATOMIC_FLAG_INIT;

progress_mode progress_choose(int mode_index, bool is_quiet)
{
    switch (mode_index) {
    case 1:
        return PROGRESS_PLAIN;
    case 2:
        return PROGRESS_JSON;
    case 3:
        return PROGRESS_NONE;
    default:
        return !is_quiet && terminal_is(stderr) ? PROGRESS_BAR : PROGRESS_NONE;
    }
}

void progress_clear(void)
{
    if (atomic_exchange(&is_bar_shown, false))
        fputs("\r\033[K", stderr);
}

void progress_line(const char *text)
{
    char line[512];
    snprintf(line, sizeof line, "%.*s", terminal_width(stderr) - 1, text);
    terminal_disarm(line);
    fprintf(stderr, "\r%s\033[K", line);
    fflush(stderr);
    atomic_store(&is_bar_shown, true);
}

static void format_time(double seconds, char *text, size_t size)
{
    unsigned s = (unsigned)(seconds + 0.5);
    if (s >= 3600)
        snprintf(text, size, "%u:%02u:%02u", s / 3600, s / 60 % 60, s % 60);
    else
        snprintf(text, size, "%u:%02u", s / 60, s % 60);
}

static void show_bar(progress *p, const char *stage, double fraction, double now)
{
    if (now - p->start < 0.3 || now - p->last_shown < 0.1)
        return;
    char bar[BAR_WIDTH + 1], left[32] = "";
    int filled = (int)(fraction * BAR_WIDTH);
    for (int i = 0; i < BAR_WIDTH; i++)
        bar[i] = i < filled ? '#' : '.';
    bar[BAR_WIDTH] = 0;
    if (fraction > 0.02)
        format_time((now - p->start) * (1.0 - fraction) / fraction, left, sizeof left);
    fprintf(stderr, "\r%s: [%s] %3d %% %s%s%s\033[K", p->subject, bar, (int)(100.0 * fraction), stage,
            *left ? ", left " : "", left);
    fflush(stderr);
    atomic_store(&is_bar_shown, true);
    p->last_shown = now;
}

/* Prints a line per stage and per 10 %. */
static void show_line(progress *p, const char *stage, double fraction, double now)
{
    int percent = (int)(100.0 * fraction);
    bool is_new_stage = p->last_stage != stage && (!p->last_stage || strcmp(p->last_stage, stage) != 0);
    if (!is_new_stage && percent < p->last_percent + 10 && (percent < 100 || p->last_percent >= 100))
        return;
    if (p->mode == PROGRESS_JSON)
        fprintf(stderr, "{\"progress\": %.3f, \"stage\": \"%s\", \"seconds\": %.3f}\n", fraction, stage,
                now - p->start);
    else
        fprintf(stderr, "%s: %3d %% %s\n", p->subject, percent, stage);
    p->last_percent = percent;
    p->last_stage = stage;
}

static bool report(void *user, const char *stage, double fraction)
{
    progress *p = user;
    if (fraction > 0.0 && strcmp(stage, "sample") == 0) /* there are samples to keep */
        interrupt_end();
    if (p->mode != PROGRESS_NONE && !atomic_flag_test_and_set(&is_showing)) {
        fraction = fraction < 0.0 ? 0.0 : fraction > 1.0 ? 1.0 : fraction;
        fraction = p->done_before + p->share * fraction;
        double now = interrupt_clock();
        if (p->mode == PROGRESS_BAR)
            show_bar(p, stage, fraction, now);
        else
            show_line(p, stage, fraction, now);
        atomic_flag_clear(&is_showing);
    }
    return interrupt_signal() == 0;
}

facet_progress progress_callback(progress *p)
{
    return (facet_progress){.user = p, .report = report};
}

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
        message_at(m, level == FACET_LOG_LEVEL_HINT ? VERBOSITY_NORMAL : VERBOSITY_DETAILS, "%s", text);
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
