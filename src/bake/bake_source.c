/* bake_source.c - see bake_source.h. */
#include "bake/bake_source.h"

#include <math.h>
#include <stdatomic.h>

#include "base/parallel.h"
#include "base/result.h"
#include "base/simd.h"
#include "ibl/environment.h"
#include "ibl/equirect.h"

typedef struct cutting {
    const image *from;
    image *to; /* NULL: only tests whether any radiance exceeds the limit */
    float limit;
    atomic_bool is_over;
} cutting;

DISPATCH_AVX2 static void cut_rows(void *context, size_t begin, size_t end)
{
    cutting *job = context;
    size_t row = 3 * (size_t)job->from->width;
    const float *from = job->from->pixels;
    float limit = job->limit;
    if (job->to) {
        float *to = job->to->pixels;
        for (size_t i = begin * row; i < end * row; i++)
            to[i] = from[i] < limit ? from[i] : limit;
        return;
    }
    int over = 0;
    for (size_t i = begin * row; i < end * row; i++)
        over |= from[i] > limit;
    if (over)
        atomic_store(&job->is_over, true);
}

facet_result bake_source_create(const facet_environment *environment, const facet_bake_desc *desc,
                                bake_source *out, facet_error *error)
{
    const image *panorama = &environment->panorama;
    bake_source s = {.panorama = *panorama,
                     .faces = environment->faces.texels ? &environment->faces : NULL,
                     .limit = desc->clamp > 0.0f ? desc->clamp : INFINITY,
                     .rotation_rad = (double)desc->rotation_rad,
                     .scale = exp2f(desc->ev)};
    double whole[3];
    facet_result result = equirect_mean(panorama, &desc->allocator, desc->thread_count, whole, error);
    cutting job = {.from = panorama, .limit = s.limit};
    atomic_init(&job.is_over, false);
    if (result == FACET_OK && desc->clamp > 0.0f)
        parallel_for(desc->thread_count, panorama->height, 16, cut_rows, &job);
    for (int k = 0; k < 3; k++)
        s.mean[k] = whole[k];
    if (result == FACET_OK && atomic_load(&job.is_over)) {
        result =
            image_create(&desc->allocator, panorama->width, panorama->height, 3, IMAGE_F32, &s.cut, error);
        if (result == FACET_OK) {
            job.to = &s.cut;
            parallel_for(desc->thread_count, panorama->height, 16, cut_rows, &job);
            s.panorama = s.cut;
            result = equirect_mean(&s.cut, &desc->allocator, desc->thread_count, s.mean, error);
        }
        double sum = whole[0] + whole[1] + whole[2];
        s.cut_share = sum > 0.0 ? 1.0 - (s.mean[0] + s.mean[1] + s.mean[2]) / sum : 0.0;
    }
    if (result != FACET_OK) {
        bake_source_destroy(&s);
        return result;
    }
    *out = s;
    return FACET_OK;
}

void bake_source_destroy(bake_source *s)
{
    image_destroy(&s->cut);
    *s = (bake_source){0};
}

void bake_source_turn(const bake_source *s, const double d[3], double out[3])
{
    double c = cos(s->rotation_rad);
    double sine = sin(s->rotation_rad);
    double x = d[0];
    double z = d[2];
    out[0] = x * c - z * sine;
    out[1] = d[1];
    out[2] = x * sine + z * c;
}

/* ---- progress ---- */

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

/* A thread does not wait for another one that reports. */
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
