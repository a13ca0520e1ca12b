/* bake_watch.c - see bake_watch.h. */
#include "bake/bake_watch.h"

#include "base/result.h"

void bake_watch_init(bake_watch *w, const facet_progress *progress, const char *stage, double total)
{
    w->progress = *progress;
    w->stage = stage;
    w->total = total > 1.0 ? total : 1.0;
    atomic_init(&w->done, 0);
    atomic_init(&w->is_cancelled, false);
    atomic_flag_clear(&w->is_reporting);
    w->reported = -1.0;
}

/* A thread that finds another one telling goes on with its work. */
bool bake_watch_add(bake_watch *w, double done)
{
    atomic_fetch_add(&w->done, (uint64_t)done);
    if (!w->progress.report || bake_watch_is_cancelled(w) || atomic_flag_test_and_set(&w->is_reporting))
        return !bake_watch_is_cancelled(w);
    double fraction = (double)atomic_load(&w->done) / w->total;
    fraction = fraction < 1.0 ? fraction : 1.0;
    if (fraction >= w->reported + 0.01) {
        w->reported = fraction;
        if (!w->progress.report(w->progress.user, w->stage, fraction))
            atomic_store(&w->is_cancelled, true);
    }
    atomic_flag_clear(&w->is_reporting);
    return !bake_watch_is_cancelled(w);
}

facet_result bake_watch_explain(const bake_watch *w, facet_error *error)
{
    if (!bake_watch_is_cancelled(w))
        return FACET_OK;
    return fail(error, FACET_ERROR_CANCELLED, "cancelled while baking");
}
