/* foam_history.c - see foam_history.h. */
#include "ocean/foam_history.h"

#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "base/parallel.h"
#include "base/result.h"
#include "ocean/foam_plane.h"
#include "ocean/wave_amplitudes.h"
#include "ocean/wave_transform.h"

static const double TWO_PI = 6.28318530717958647693;
static const double DECAYS = 5.0;         /* e^-5 is invisible */
static const double STEPS_PER_WAVE = 8.0; /* per period of the shortest wave in the longest tile */
static const size_t MAX_KEPT = 64u << 20;
enum { MAX_STEPS = 96, CHANCES = 1024 };

/* Probability that the convergence of all waves exceeds the threshold, given the convergence q of the longest
 * tile: a LUT over [-threshold, 2 threshold]. */
struct foam_chances {
    float table[CHANCES + 1], from, scale;
};

/* Probabilities at the multiples 2 number and 2 number + 1 of the step: from one transform, and the same for
 * every caller. */
struct foam_pair {
    bool is_there;
    int64_t number;
    float *planes[2];
};

/* ---- chances ---- */

static void make_chances(foam_chances *c, const waves *w, double threshold)
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

static inline float chance_of(const foam_chances *c, float q)
{
    float place = (q - c->from) * c->scale;
    place = place > 0.0f ? place : 0.0f;
    place = place < (float)CHANCES - 1.0f ? place : (float)CHANCES - 1.0f;
    int32_t i = (int32_t)place;
    return c->table[i] + (place - (float)i) * (c->table[i + 1] - c->table[i]);
}

typedef struct lookup {
    const foam_chances *chances;
    const float *field;
    float *plane;
} lookup;

static void look_up(void *context, size_t begin, size_t end)
{
    const lookup *l = context;
    for (size_t i = begin; i < end; i++)
        l->plane[i] = chance_of(l->chances, l->field[i]);
}

/* ---- times ---- */

/* Writes the convergence of the longest tile at two times to the fields. */
static void converge(foam_history *h, const waves *w, const double times_s[2])
{
    const wave_amplitudes *a = w->amplitudes[0];
    for (size_t i = 0; i < a->count; i++) {
        const wave_mode *m = &a->modes[i];
        float k2 = (float)(a->k_step * a->k_step * ((double)m->n_x * m->n_x + (double)m->n_z * m->n_z));
        for (int j = 0; j < 2; j++) {
            wave_mode_at(m, times_s[j], h->coefficients[i][j], NULL);
            h->coefficients[i][j][0] *= m->stretch * k2;
            h->coefficients[i][j][1] *= m->stretch * k2;
        }
    }
    const wave_pair pair = {0, h->coefficients, h->rows, {h->fields[0], h->fields[1]}};
    wave_transform_pair(w->transform, w, &pair);
}

static bool allocate_pair(foam_history *h, foam_pair *p)
{
    for (int j = 0; j < 2; j++)
        if (!p->planes[j])
            p->planes[j] = mem_alloc(&h->allocator, (size_t)h->size * h->size, sizeof(float));
    return p->planes[0] && p->planes[1];
}

/* NULL: out of memory. */
static const foam_pair *find_pair(foam_history *h, const waves *w, int64_t number)
{
    uint32_t at = (uint32_t)(((number % h->pair_count) + h->pair_count) % h->pair_count);
    foam_pair *p = &h->pairs[at];
    if (p->is_there && p->number == number)
        return p;
    if (!allocate_pair(h, p))
        return NULL;
    converge(h, w,
             (const double[2]){2.0 * (double)number * h->step_s, (2.0 * (double)number + 1.0) * h->step_s});
    for (int j = 0; j < 2; j++) {
        lookup l = {h->chances, h->fields[j], p->planes[j]};
        parallel_for(w->thread_count, (size_t)h->size * h->size, 16384, look_up, &l);
    }
    p->is_there = true;
    p->number = number;
    return p;
}

/* ---- gathering ---- */

/* Planes and their fade factors. */
typedef struct gathering {
    const float *planes[MAX_STEPS];
    float fades[MAX_STEPS];
    uint32_t count;
    float *past;
} gathering;

static void gather(void *context, size_t begin, size_t end)
{
    const gathering *g = context;
    for (uint32_t k = 0; k < g->count; k++)
        for (size_t i = begin; i < end; i++) {
            float amount = g->fades[k] * g->planes[k][i];
            g->past[i] = g->past[i] > amount ? g->past[i] : amount;
        }
}

/* Accumulates into h->past, as of the last multiple: from there on everything fades by the same factor. */
static facet_result gather_past(foam_history *h, const waves *w, int64_t last, facet_error *error)
{
    size_t texels = (size_t)h->size * h->size;
    gathering g = {.past = h->past};
    if (h->has_past && h->past_multiple == last)
        return FACET_OK;
    h->has_past = false;
    memset(h->past, 0, texels * sizeof *h->past);
    for (uint32_t i = 0; i + 1 < h->count; i++) {
        int64_t multiple = last - (int64_t)i, number = (multiple - (multiple & 1)) / 2;
        const foam_pair *p = find_pair(h, w, number);
        if (!p)
            return fail_memory(error, "foam", 2 * texels * sizeof(float));
        g.planes[g.count] = p->planes[multiple & 1];
        g.fades[g.count++] = (float)exp(-(double)i * h->step_s / h->decay_s);
        bool is_last = i + 2 == h->count;
        if (is_last || h->pair_count == 1) { /* the next pair may replace this one */
            parallel_for(w->thread_count, texels, 4096, gather, &g);
            g.count = 0;
        }
    }
    h->past_multiple = last;
    h->has_past = true;
    return FACET_OK;
}

/* Combines crests that break now with the faded past. */
typedef struct breaking {
    const foam_history *history;
    float fade;
    float *share;
} breaking;

static void break_now(void *context, size_t begin, size_t end)
{
    const breaking *b = context;
    const foam_history *h = b->history;
    for (size_t i = begin; i < end; i++) {
        float now = chance_of(h->chances, h->fields[0][i]), before = b->fade * h->past[i];
        b->share[i] = now > before ? now : before;
    }
}

facet_result foam_history_gather(foam_history *h, const waves *w, float *share, facet_error *error)
{
    double now_s = wave_phase_time(w, w->time_s);
    double last = floor(now_s / h->step_s);
    if (!(fabs(last) < 0x1p50)) /* times inside the loop are no farther apart than the steps */
        last = 0.0;
    facet_result result = gather_past(h, w, (int64_t)last, error);
    if (result != FACET_OK)
        return result;
    converge(h, w, (const double[2]){now_s, now_s});
    breaking b = {h, (float)exp((last * h->step_s - now_s) / h->decay_s), share};
    parallel_for(w->thread_count, (size_t)h->size * h->size, 16384, break_now, &b);
    return FACET_OK;
}

/* ---- all ---- */

static bool allocate(foam_history *h, const waves *w)
{
    size_t modes = 0, rows = 0, size = h->size;
    for (uint32_t i = 0; i < w->tile_count; i++) {
        const wave_amplitudes *a = w->amplitudes[i];
        size_t row_count = 2 * (size_t)a->reach + 1;
        modes = a->count > modes ? a->count : modes;
        rows = row_count > rows ? row_count : rows;
    }
    h->coefficients = mem_alloc(&h->allocator, modes, sizeof *h->coefficients);
    h->rows = mem_alloc(&h->allocator, rows * size, sizeof *h->rows);
    h->chances = mem_alloc(&h->allocator, 1, sizeof *h->chances);
    h->pairs = mem_zalloc(&h->allocator, h->pair_count, sizeof *h->pairs);
    h->past = mem_alloc(&h->allocator, size * size, sizeof *h->past);
    bool is_there = h->coefficients && h->rows && h->chances && h->pairs && h->past;
    for (int i = 0; i < 2 && is_there; i++) {
        h->fields[i] = mem_alloc(&h->allocator, size * size, sizeof(float));
        is_there = h->fields[i];
    }
    for (uint32_t i = 0; i < FOAM_PATTERNS && is_there; i++)
        is_there = foam_plane_create(&h->allocator, h->size, &h->patterns[i]);
    return is_there;
}

/* Evaluated times: now, and earlier multiples of step_s, so that the next frame shares them. */
static void choose_times(foam_history *h, const waves *w)
{
    double omega = wave_omega(w->tiles[0].k_to, w->state.depth_m);
    h->step_s = fmax(TWO_PI / (omega * STEPS_PER_WAVE), DECAYS * h->decay_s / MAX_STEPS);
    if (w->loop_s > 0.0) /* a whole number of steps per loop */
        h->step_s = (double)w->loop_s / ceil((double)w->loop_s / h->step_s);
    h->count = (uint32_t)ceil(DECAYS * h->decay_s / h->step_s);
    h->count = h->count < MAX_STEPS ? h->count : MAX_STEPS;
    size_t pair_bytes = 2 * (size_t)h->size * h->size * sizeof(float);
    h->pair_count = h->count / 2 + 1;
    if (h->pair_count > MAX_KEPT / pair_bytes)
        h->pair_count = 1;
}

facet_result foam_history_create(const waves *w, double threshold, double decay_s,
                                 const facet_allocator *allocator, foam_history **out, facet_error *error)
{
    foam_history *h = mem_zalloc(allocator, 1, sizeof *h);
    *out = NULL;
    if (!h)
        return fail_memory(error, "foam", sizeof *h);
    *h = (foam_history){.allocator = *allocator, .size = w->tiles[0].size, .decay_s = decay_s};
    choose_times(h, w);
    if (!allocate(h, w)) {
        foam_history_destroy(h);
        return fail_memory(error, "foam", (size_t)w->tiles[0].size * w->tiles[0].size * sizeof(float));
    }
    make_chances(h->chances, w, threshold);
    foam_pattern_cells(&h->patterns[FOAM_CELLS], w->thread_count);
    foam_pattern_clouds(&h->patterns[FOAM_CLOUDS], w->thread_count);
    *out = h;
    return FACET_OK;
}

void foam_history_destroy(foam_history *h)
{
    if (!h)
        return;
    for (uint32_t i = 0; h->pairs && i < h->pair_count; i++) {
        mem_free(h->pairs[i].planes[0]);
        mem_free(h->pairs[i].planes[1]);
    }
    for (uint32_t i = 0; i < FOAM_PATTERNS; i++)
        foam_plane_destroy(&h->patterns[i]);
    mem_free(h->pairs);
    mem_free(h->past);
    mem_free(h->chances);
    mem_free(h->coefficients);
    mem_free(h->rows);
    mem_free(h->fields[0]);
    mem_free(h->fields[1]);
    mem_free(h);
}
