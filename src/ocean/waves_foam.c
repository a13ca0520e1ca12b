/* waves_foam.c - see waves_foam.h. */
#include "ocean/waves_foam.h"

#include <math.h>
#include <string.h>

#include "base/result.h"
#include "ocean/wave_patches.h"

double foam_decay_s(double salinity)
{
    return 2.5 + 1.2 * fmin(salinity / 35.0, 1.0);
}

/* Such that the mean is the one that is wanted: all shares times a factor, those above 1 cut. Newton's steps from below: the sum is
 * concave in the factor, so none goes too far, and made of straight pieces, so few are left. */
static void scale_share(float *share, size_t count, double mean)
{
    enum { MOST_STEPS = 50 };
    double factor = 0.0, wanted = mean * (double)count;
    for (int step = 0; step < MOST_STEPS; step++) {
        double sum = 0.0, slope = 0.0;
        for (size_t i = 0; i < count; i++) {
            double s = (double)share[i], scaled = factor * s;
            sum += scaled < 1.0 ? scaled : 1.0;
            slope += scaled < 1.0 ? s : 0.0;
        }
        double missing = wanted - sum;
        if (!(slope > 0.0) || missing <= 1e-9 * wanted)
            break;
        factor = fmin(factor + missing / slope, 1e6);
    }
    for (size_t i = 0; i < count; i++)
        share[i] = (float)fmin(factor * (double)share[i], 1.0);
}

void waves_foam_destroy(waves_foam *f)
{
    foam_plane_destroy(&f->share);
    *f = (waves_foam){.lace_count = 0};
}

facet_result waves_foam_create(const waves *w, const foam_rule *rule, double decay_s, foam_history **history,
                               waves_foam *out, facet_error *error)
{
    *out = (waves_foam){.w = w};
    if (!w->tile_count || !(rule->active_threshold < INFINITY) || !(rule->active_threshold > 0.0f))
        return FACET_OK;
    uint32_t size = w->tiles[0].size;
    facet_result result = FACET_OK;
    if (!*history)
        result = foam_history_create(w, (double)rule->active_threshold, decay_s, history, error);
    if (result == FACET_OK && !foam_plane_create(&w->allocator, size, &out->share))
        result = fail_memory(error, "foam", (size_t)size * size * sizeof(float));
    if (result == FACET_OK)
        result = foam_history_gather(*history, w, out->share.levels[0], error);
    if (result != FACET_OK) {
        waves_foam_destroy(out);
        return result;
    }
    out->lace_count = (*history)->lace_count;
    memcpy(out->lace, (*history)->lace, sizeof out->lace);
    memcpy(out->lace_tiles, (*history)->lace_tiles, sizeof out->lace_tiles);
    scale_share(out->share.levels[0], (size_t)size * size, 0.9 * (double)rule->coverage);
    foam_plane_reduce(&out->share);
    return FACET_OK;
}

/* ---- reading ---- */

static float share_at(const waves_foam *f, double x, double z, float footprint_m)
{
    const wave_tile *t = &f->w->tiles[0];
    double u = x * t->cos_per_m + z * t->sin_per_m, v = z * t->cos_per_m - x * t->sin_per_m;
    wave_patch patches[WAVES_MAX_PATCHES];
    uint32_t count = wave_patches_at(f->w, 0, x, z, patches);
    float sum = 0.0f; /* squares of the weights sum to 1 */
    for (uint32_t i = 0; i < count; i++)
        sum += patches[i].weight * patches[i].weight *
               foam_plane_read(&f->share, u + (double)patches[i].u, v + (double)patches[i].v,
                               footprint_m * (float)t->samples_per_m)
                   .mean;
    return fminf(fmaxf(sum, 0.0f), 1.0f);
}

/* What the share is multiplied by from place to place, by a field three times as wide as the lace. Lines break where it is small, and run
 * together where it is not. */
static float thickness_at(const waves_foam *f, double x, double z, float footprint_m, float share)
{
    const wave_tile *t = &f->w->tiles[f->lace_tiles[0]];
    double u = x * t->cos_per_m + z * t->sin_per_m, v = z * t->cos_per_m - x * t->sin_per_m;
    foam_plane_value m =
        foam_plane_read(&f->lace[0], -FOAM_THICKNESS_WIDTH * v, FOAM_THICKNESS_WIDTH * u,
                        footprint_m * (float)(FOAM_THICKNESS_WIDTH * (double)t->samples_per_m));
    return wave_foam_thickness(share, m.mean, m.hidden);
}

float waves_foam_at(const waves_foam *f, double x, double z, float footprint_m)
{
    if (!f->share.level_count)
        return 0.0f;
    float share = share_at(f, x, z, footprint_m);
    if (share <= 1e-4f || share >= 0.999f)
        return share;
    share = fminf(share * thickness_at(f, x, z, footprint_m, share), 0.999f);
    float mean = 0.0f, hidden = 0.0f, scale = 1.0f / sqrtf((float)f->lace_count);
    for (uint32_t i = 0; i < f->lace_count; i++) {
        const wave_tile *t = &f->w->tiles[f->lace_tiles[i]];
        foam_plane_value value =
            foam_plane_read(&f->lace[i], x * t->cos_per_m + z * t->sin_per_m,
                            z * t->cos_per_m - x * t->sin_per_m, footprint_m * (float)t->samples_per_m);
        mean += value.mean * scale;
        hidden += value.hidden * scale * scale;
    }
    return wave_foam_lace(share, mean, hidden);
}
