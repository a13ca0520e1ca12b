/* batch_progress.c - see batch_progress.h. */
#include "cli/batch/batch_progress.h"

#include "cli/shared/interrupt.h"

#include <inttypes.h>
#include <stdio.h>
#include <string.h>

void batch_time_text(double seconds, char text[BATCH_TIME_SIZE])
{
    unsigned long s = seconds < 4e9 ? (unsigned long)(seconds + 0.5) : 4000000000ul;
    if (seconds < 9.95)
        snprintf(text, BATCH_TIME_SIZE, "%.1f s", seconds);
    else if (s < 60)
        snprintf(text, BATCH_TIME_SIZE, "%lu s", s);
    else if (s < 3600)
        snprintf(text, BATCH_TIME_SIZE, "%lu min %lu s", s / 60, s % 60);
    else
        snprintf(text, BATCH_TIME_SIZE, "%lu h %lu min", s / 3600, s / 60 % 60);
}

/* Items a second, without those that were kept; 0: none yet. */
static double rate_of(const batch_progress *p, double now)
{
    double seconds = now - p->start;
    return seconds > 0.0 ? (double)(p->done + p->failed) / seconds : 0.0;
}

/* Seconds to the end; negative: unknown. */
static double seconds_left(const batch_progress *p, double rate)
{
    uint64_t ended = p->done + p->kept + p->failed;
    return p->total == UINT64_MAX || rate <= 0.0 || p->total < ended ? -1.0
                                                                     : (double)(p->total - ended) / rate;
}

static void describe(const batch_progress *p, double now, char *text, size_t size)
{
    double rate = rate_of(p, now), left = seconds_left(p, rate);
    uint64_t ended = p->done + p->kept + p->failed;
    char time[BATCH_TIME_SIZE] = "", total[32] = "";
    if (left >= 0.0)
        batch_time_text(left, time);
    if (p->total != UINT64_MAX)
        snprintf(total, sizeof total, " of %" PRIu64, p->total);
    snprintf(text, size, "%" PRIu64 "%s, %" PRIu64 " failed, %.3g/s%s%s", ended, total, p->failed, rate,
             *time ? ", left " : "", time);
}

static void show_json(const batch_progress *p, double now)
{
    double rate = rate_of(p, now), left = seconds_left(p, rate);
    uint64_t ended = p->done + p->kept + p->failed;
    char text[160] = "";
    if (p->total != UINT64_MAX)
        snprintf(text, sizeof text, "\"progress\": %.4f, \"total\": %" PRIu64 ", ",
                 p->total ? (double)ended / (double)p->total : 1.0, p->total);
    fprintf(stderr,
            "{%s\"done\": %" PRIu64 ", \"kept\": %" PRIu64 ", \"failed\": %" PRIu64
            ", \"running\": %u, \"seconds\": %.3f, \"rate\": %.4g",
            text, p->done, p->kept, p->failed, p->running, now - p->start, rate);
    if (left >= 0.0)
        fprintf(stderr, ", \"left_s\": %.1f", left);
    fputs("}\n", stderr);
}

void batch_progress_show(batch_progress *p, const char *name, bool is_last)
{
    static const double pauses[] = {
        [PROGRESS_NONE] = 1e30, [PROGRESS_BAR] = 0.1, [PROGRESS_PLAIN] = 10.0, [PROGRESS_JSON] = 1.0};
    double now = interrupt_clock();
    if (p->mode == PROGRESS_NONE || (p->mode == PROGRESS_BAR && is_last))
        return;
    if (!is_last && now < (p->last_shown > 0.0 ? p->last_shown : p->start) + pauses[p->mode])
        return;
    p->last_shown = now;
    char text[256], line[512];
    describe(p, now, text, sizeof text);
    if (p->mode == PROGRESS_JSON) {
        show_json(p, now);
    } else if (p->mode == PROGRESS_PLAIN) {
        fprintf(stderr, "batch: %s\n", text);
    } else {
        snprintf(line, sizeof line, "batch: %s%s%.200s", text, name ? "  " : "", name ? name : "");
        progress_line(line);
    }
}
