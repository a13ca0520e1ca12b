/* waves_foam.c - see waves_foam.h. */
#include "ocean/waves_foam.h"

#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "base/parallel.h"
#include "base/result.h"
#include "ocean/wave_amplitudes.h"
#include "ocean/wave_patches.h"
#include "ocean/wave_transform.h"

static const double TWO_PI = 6.28318530717958647693;
static const double DECAYS = 5.0;         /* e^-5 is below what is seen */
static const double STEPS_PER_WAVE = 8.0; /* of the shortest in the longest tile */
enum { MOST_STEPS = 96, CHANCES = 1024 };

double foam_decay_s(double salinity)
{
    return 2.5 + 1.2 * fmin(salinity / 35.0, 1.0);
}

/* ---- what has broken ---- */

/* Times at which crests are looked at: now, and multiples of step_s before, so that the next frame looks at the same. */
typedef struct history {
    double step_s, now_s;
    double last; /* the latest multiple */
    uint32_t count;
} history;

static history history_of(const waves *w, double decay_s)
{
    double omega = wave_omega(w->tiles[0].k_to, w->state.depth_m);
    history h = {.step_s = fmax(TWO_PI / (omega * STEPS_PER_WAVE), DECAYS * decay_s / MOST_STEPS)};
    if (w->loop_s > 0.0) /* a loop has a whole number of them */
        h.step_s = w->loop_s / ceil(w->loop_s / h.step_s);
    h.now_s = wave_phase_time(w, w->time_s);
    h.last = floor(h.now_s / h.step_s);
    h.count = (uint32_t)ceil(DECAYS * decay_s / h.step_s);
    h.count = h.count < MOST_STEPS ? h.count : MOST_STEPS;
    return h;
}

/* Probability that all waves together converge by more than the threshold where those of the longest tile do by q: a table over
 * [-threshold, 2 threshold]. */
typedef struct chances {
    float table[CHANCES + 1], from, scale;
} chances;

static void make_chances(chances *c, const waves *w, double threshold)
{
    double rest = 0.0; /* variance of the other tiles' */
    if (w->tile_count > 1)
        rest = sea_state_moments(&w->state, w->tiles[0].k_to, w->tiles[w->tile_count - 1].k_to).convergence;
    double sigma = fmax(w->choppiness * sqrt(rest), 0.01 * threshold);
    c->from = (float)-threshold;
    c->scale = (float)(CHANCES / (3.0 * threshold));
    for (int i = 0; i <= CHANCES; i++) {
        double q = threshold * (3.0 * i / CHANCES - 1.0);
        c->table[i] = (float)(0.5 * erfc((threshold - q) / sigma * 0.70710678118654752440));
    }
}

static inline float chance_of(const chances *c, float q)
{
    float place = (q - c->from) * c->scale;
    place = place > 0.0f ? place : 0.0f;
    place = place < (float)CHANCES - 1.0f ? place : (float)CHANCES - 1.0f;
    int32_t i = (int32_t)place;
    return c->table[i] + (place - (float)i) * (c->table[i + 1] - c->table[i]);
}

typedef struct gathering {
    const chances *chances;
    const float *fields[2];
    float fades[2];
    float *share;
} gathering;

static void gather(void *context, size_t begin, size_t end)
{
    const gathering *g = context;
    for (size_t i = begin; i < end; i++) {
        float a = g->fades[0] * chance_of(g->chances, g->fields[0][i]);
        float b = g->fades[1] * chance_of(g->chances, g->fields[1][i]);
        float most = a > b ? a : b;
        g->share[i] = g->share[i] > most ? g->share[i] : most;
    }
}

/* ---- the whole ---- */

typedef struct workspace {
    wave_pair pair;
    chances *chances;
} workspace;

static bool allocate_workspace(const waves *w, workspace *s)
{
    size_t modes = 0, rows = 0, size = w->tiles[0].size;
    for (uint32_t i = 0; i < w->tile_count; i++) {
        const wave_amplitudes *a = w->amplitudes[i];
        size_t row_count = 2 * (size_t)a->reach + 1;
        modes = a->count > modes ? a->count : modes;
        rows = row_count > rows ? row_count : rows;
    }
    s->pair.coefficients = mem_alloc(&w->allocator, modes, sizeof *s->pair.coefficients);
    s->pair.rows = mem_alloc(&w->allocator, rows * size, sizeof *s->pair.rows);
    s->pair.fields[0] = mem_alloc(&w->allocator, size * size, sizeof(float));
    s->pair.fields[1] = mem_alloc(&w->allocator, size * size, sizeof(float));
    s->chances = mem_alloc(&w->allocator, 1, sizeof *s->chances);
    return s->pair.coefficients && s->pair.rows && s->pair.fields[0] && s->pair.fields[1] && s->chances;
}

static void destroy_workspace(workspace *s)
{
    mem_free(s->pair.coefficients);
    mem_free(s->pair.rows);
    mem_free(s->pair.fields[0]);
    mem_free(s->pair.fields[1]);
    mem_free(s->chances);
}

/* Convergence of the longest tile at two times. */
static void converge(const waves *w, workspace *s, const double times_s[2])
{
    const wave_amplitudes *a = w->amplitudes[0];
    for (size_t i = 0; i < a->count; i++) {
        const wave_mode *m = &a->modes[i];
        float k2 = (float)(a->k_step * a->k_step * ((double)m->n_x * m->n_x + (double)m->n_z * m->n_z));
        for (int j = 0; j < 2; j++) {
            wave_mode_at(m, times_s[j], s->pair.coefficients[i][j], NULL);
            s->pair.coefficients[i][j][0] *= m->stretch * k2;
            s->pair.coefficients[i][j][1] *= m->stretch * k2;
        }
    }
    s->pair.tile = 0;
    wave_transform_pair(w->transform, w, &s->pair);
}

static void gather_history(const waves *w, workspace *s, double decay_s, float *share)
{
    history h = history_of(w, decay_s);
    for (uint32_t step = 0; step < h.count; step += 2) {
        double times_s[2];
        gathering g = {
            .chances = s->chances, .fields = {s->pair.fields[0], s->pair.fields[1]}, .share = share};
        for (uint32_t j = 0; j < 2; j++) {
            times_s[j] = step + j ? (h.last - (step + j - 1.0)) * h.step_s : h.now_s;
            g.fades[j] = (float)exp(-(h.now_s - times_s[j]) / decay_s);
        }
        converge(w, s, times_s);
        parallel_for(w->thread_count, (size_t)w->tiles[0].size * w->tiles[0].size, 16384, gather, &g);
    }
}

/* Such that the mean is the one that is wanted: all shares times a factor, those above 1 cut. */
static void scale_share(float *share, size_t count, double mean)
{
    double low = 0.0, high = 1e6;
    for (int i = 0; i < 60; i++) { /* by halves of its logarithm */
        double factor = low > 0.0 ? sqrt(low * high) : 1e-6 * high, sum = 0.0;
        for (size_t j = 0; j < count; j++)
            sum += fmin(factor * (double)share[j], 1.0);
        if (sum < mean * (double)count)
            low = factor;
        else
            high = factor;
    }
    for (size_t j = 0; j < count; j++)
        share[j] = (float)fmin(high * (double)share[j], 1.0);
}

static double mean_square(const float *values, size_t count)
{
    double sum = 0.0;
    for (size_t i = 0; i < count; i++)
        sum += (double)values[i] * (double)values[i];
    return sum / (double)count;
}

/* Heights at time 0, each wave over its length (which makes the lace as fine as the waves are), with a variance of 1. */
static void make_lace(const waves *w, workspace *s, uint32_t tile, foam_plane *lace)
{
    const wave_amplitudes *a = w->amplitudes[tile];
    for (size_t i = 0; i < a->count; i++) {
        const wave_mode *m = &a->modes[i];
        float n = sqrtf((float)(m->n_x * m->n_x + m->n_z * m->n_z));
        wave_mode_at(m, 0.0, s->pair.coefficients[i][0], NULL);
        s->pair.coefficients[i][0][0] *= n;
        s->pair.coefficients[i][0][1] *= n;
        s->pair.coefficients[i][1][0] = s->pair.coefficients[i][1][1] = 0.0f;
    }
    s->pair.tile = tile;
    wave_transform_pair(w->transform, w, &s->pair);
    size_t count = (size_t)lace->size * lace->size;
    double deviation = sqrt(mean_square(s->pair.fields[0], count));
    float scale = deviation > 0.0 ? (float)(1.0 / deviation) : 0.0f;
    for (size_t i = 0; i < count; i++)
        lace->levels[0][i] = scale * s->pair.fields[0][i];
    foam_plane_reduce(lace);
}

void waves_foam_destroy(waves_foam *f)
{
    foam_plane_destroy(&f->share);
    for (uint32_t i = 0; i < FOAM_LACES; i++)
        foam_plane_destroy(&f->lace[i]);
    *f = (waves_foam){.lace_count = 0};
}

facet_result waves_foam_create(const waves *w, const foam_rule *rule, double decay_s, waves_foam *out,
                               facet_error *error)
{
    *out = (waves_foam){.w = w};
    if (!w->tile_count || !(rule->active_threshold < INFINITY) || !(rule->active_threshold > 0.0f))
        return FACET_OK;
    uint32_t size = w->tiles[0].size;
    workspace s = {.chances = NULL};
    bool is_there = allocate_workspace(w, &s) && foam_plane_create(&w->allocator, size, &out->share);
    out->lace_count = w->tile_count > FOAM_LACES ? FOAM_LACES : 1;
    for (uint32_t i = 0; i < out->lace_count; i++) {
        out->lace_tiles[i] = w->tile_count > 1 ? i + 1 : 0;
        is_there = is_there && foam_plane_create(&w->allocator, size, &out->lace[i]);
    }
    if (!is_there) {
        destroy_workspace(&s);
        waves_foam_destroy(out);
        return fail_memory(error, "foam", (size_t)size * size * sizeof(float));
    }
    make_chances(s.chances, w, (double)rule->active_threshold);
    gather_history(w, &s, decay_s, out->share.levels[0]);
    scale_share(out->share.levels[0], (size_t)size * size, 0.9 * (double)rule->coverage);
    foam_plane_reduce(&out->share);
    for (uint32_t i = 0; i < out->lace_count; i++)
        make_lace(w, &s, out->lace_tiles[i], &out->lace[i]);
    destroy_workspace(&s);
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
