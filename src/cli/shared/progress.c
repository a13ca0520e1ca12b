/* progress.c - how far the work is. */
#include "cli/shared/progress.h"

#include "cli/shared/interrupt.h"
#include "cli/shared/terminal.h"

#include <stdatomic.h>
#include <stdio.h>
#include <string.h>

enum { BAR_WIDTH = 24 };

/* Whether the bar is on the terminal now; there is one terminal. */
static atomic_bool is_bar_shown;
/* Reports come from several threads: one shows, the others go on with their work. */
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

/* A line when the stage changes and every 10 %. */
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
    if (fraction > 0.0 && strcmp(stage, "sample") == 0) /* there is something to keep */
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
