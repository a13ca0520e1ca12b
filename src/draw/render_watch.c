/* render_watch.c - see render_watch.h. */
#include "draw/render_watch.h"

#include "base/clock.h"
#include "base/result.h"

static const double REPORT_SECONDS = 0.1;

void render_watch_init(render_watch *w, const facet_progress *progress, const char *stage, double deadline_s,
                       double total)
{
    w->progress = *progress;
    w->stage = stage;
    w->deadline_s = deadline_s;
    w->total = total;
    atomic_init(&w->result, FACET_OK);
    atomic_init(&w->done, 0);
    atomic_flag_clear(&w->is_reporting);
    w->reported = 0.0;
    atomic_init(&w->reported_s, 0.0);
}

void render_watch_stop(render_watch *w, facet_result result)
{
    int none = FACET_OK;
    atomic_compare_exchange_strong(&w->result, &none, result);
}

double render_watch_share(render_watch *w)
{
    double share = (double)atomic_load(&w->done) / w->total;
    return share < 1.0 ? share : 1.0;
}

/* A thread that finds another one reporting continues to draw. */
static void report(render_watch *w)
{
    if (!w->progress.report || render_watch_is_stopped(w) || atomic_flag_test_and_set(&w->is_reporting))
        return;
    double fraction = render_watch_share(w);
    double now = clock_seconds();
    if (fraction >= w->reported + 0.01 || now >= w->reported_s + REPORT_SECONDS) {
        w->reported = fraction;
        w->reported_s = now;
        if (!w->progress.report(w->progress.user, w->stage, fraction))
            render_watch_stop(w, FACET_ERROR_CANCELLED);
    }
    atomic_flag_clear(&w->is_reporting);
}

void render_watch_add(render_watch *w, uint64_t done)
{
    atomic_fetch_add(&w->done, done);
    report(w);
}

void render_watch_look(render_watch *w)
{
    bool is_limited = w->deadline_s > 0.0;
    if (!is_limited && !w->progress.report)
        return;
    double now = clock_seconds();
    if (is_limited && now > w->deadline_s)
        render_watch_stop(w, FACET_ERROR_LIMIT);
    if (now >= w->reported_s + REPORT_SECONDS)
        report(w);
}

facet_result render_watch_explain(render_watch *w, facet_error *error)
{
    switch (atomic_load(&w->result)) {
    case FACET_OK:
        return FACET_OK;
    case FACET_ERROR_LIMIT:
        return fail(error, FACET_ERROR_LIMIT, "the time limit was reached after %.0f %% of the image",
                    100.0 * render_watch_share(w));
    case FACET_ERROR_CANCELLED:
        return fail(error, FACET_ERROR_CANCELLED, "cancelled while drawing");
    default:
        return fail(error, FACET_ERROR_MEMORY, "out of memory: drawing a tile");
    }
}

facet_result render_check_limits(const facet_render_desc *desc, const char *stage, double fraction,
                                 double deadline_s, facet_error *error)
{
    if (desc->progress.report && !desc->progress.report(desc->progress.user, stage, fraction))
        return fail(error, FACET_ERROR_CANCELLED, "cancelled (%s)", stage);
    if (deadline_s > 0.0 && clock_seconds() > deadline_s)
        return fail(error, FACET_ERROR_LIMIT, "the time limit was reached (%s)", stage);
    return FACET_OK;
}
