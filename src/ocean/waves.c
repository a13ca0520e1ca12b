/* waves.c - creates tiles of waves, sets their time, and computes mip levels and bounds. */
#include "ocean/waves.h"

#include <math.h>

#include "base/memory.h"
#include "base/parallel.h"
#include "base/result.h"
#include "ocean/wave_amplitudes.h"
#include "ocean/wave_transform.h"

/* Folded water has no slope; a smaller share of its area is clamped to this. */
static const float MIN_JACOBIAN = 0.02f;

/* ---- memory ---- */

static facet_result allocate_tile(const waves *w, wave_tile *t, facet_error *error)
{
    for (uint32_t l = 0; l < t->level_count; l++) {
        size_t edge = t->size >> l;
        t->levels[l] = mem_zalloc(&w->allocator, edge * edge * WAVE_FIELDS, sizeof(float));
        if (!t->levels[l])
            return fail_memory(error, "a tile of waves", edge * edge * WAVE_FIELDS * sizeof(float));
    }
    return FACET_OK;
}

static bool has_peak(const sea_state *s, const wave_tile *t)
{
    for (int i = 0; i < SEA_SYSTEMS; i++) {
        double k = wave_k(s->systems[i].peak_omega, s->depth_m);
        if (k > 0.0 && k >= t->k_from && k < t->k_to)
            return true;
    }
    return false;
}

static wave_tile tile_of(const sea_state *s, uint32_t index, uint32_t size)
{
    const sea_bands *b = &s->bands;
    /* No two tiles have parallel or perpendicular axes. */
    static const double turns_degrees[WAVES_MAX_TILES] = {0.0, 37.0, -71.0, 62.0};
    wave_tile t = {.length_m = b->length_m[index],
                   .turn = turns_degrees[index] * (3.14159265358979323846 / 180.0),
                   .k_from = b->k_from[index],
                   .k_to = b->k_to[index],
                   .size = size};
    while (size >> t.level_count)
        t.level_count++;
    t.is_patched = index == 0 || has_peak(s, &t);
    t.samples_per_m = size / t.length_m;
    t.cos_per_m = cos(t.turn) * t.samples_per_m;
    t.sin_per_m = sin(t.turn) * t.samples_per_m;
    t.cos_turn = (float)cos(t.turn);
    t.sin_turn = (float)sin(t.turn);
    return t;
}

void waves_destroy(waves *w)
{
    for (uint32_t i = 0; i < WAVES_MAX_TILES; i++) {
        wave_amplitudes_destroy(w->amplitudes[i]);
        for (uint32_t l = 0; l < WAVES_MAX_LEVELS; l++)
            mem_free(w->tiles[i].levels[l]);
    }
    wave_transform_destroy(w->transform);
    *w = (waves){.tile_count = 0};
}

/* ---- levels ---- */

typedef struct reduction {
    waves *w;
    uint32_t level;
} reduction;

/* Rows of one level of all tiles, from the level below. */
static void reduce_rows(void *context, size_t begin, size_t end)
{
    const reduction *r = context;
    size_t edge = r->w->tiles[0].size >> r->level;
    for (size_t row = begin; row < end; row++) {
        const wave_tile *t = &r->w->tiles[row / edge];
        size_t z = row % edge;
        const float *from = t->levels[r->level - 1] + 4 * z * edge * WAVE_FIELDS;
        float *to = t->levels[r->level] + z * edge * WAVE_FIELDS;
        for (size_t x = 0; x < edge; x++, from += 2 * WAVE_FIELDS, to += WAVE_FIELDS)
            for (size_t f = 0; f < WAVE_FIELDS; f++)
                to[f] = 0.25f * (from[f] + from[f + WAVE_FIELDS] + from[f + 2 * edge * WAVE_FIELDS] +
                                 from[f + 2 * edge * WAVE_FIELDS + WAVE_FIELDS]);
    }
}

/* ---- bounds ---- */

static inline float larger(float a, float b) /* NaN does not occur, and fmaxf() is a call */
{
    return a > b ? a : b;
}

/* Squared. */
static inline float texel_slope(const float *t)
{
    float a = t[WAVE_DXZ], b = 1.0f + t[WAVE_DZZ], c = 1.0f + t[WAVE_DXX];
    float J = larger(b * c - a * a, MIN_JACOBIAN);
    float x = b * t[WAVE_ETA_X] - a * t[WAVE_ETA_Z], z = c * t[WAVE_ETA_Z] - a * t[WAVE_ETA_X];
    return (x * x + z * z) / (J * J);
}

static wave_bounds bounds_of(const float *texels, size_t count)
{
    float highest = -INFINITY, lowest = INFINITY, steepest = 0.0f, farthest = 0.0f;
    for (size_t i = 0; i < count; i++, texels += WAVE_FIELDS) {
        float eta = texels[WAVE_ETA];
        highest = larger(highest, eta);
        lowest = -larger(-lowest, -eta);
        steepest = larger(steepest, texel_slope(texels));
        farthest = larger(farthest, texels[WAVE_DX] * texels[WAVE_DX] + texels[WAVE_DZ] * texels[WAVE_DZ]);
    }
    return (wave_bounds){highest, lowest, sqrtf(steepest), sqrtf(farthest)};
}

static void find_bounds(void *context, size_t begin, size_t end)
{
    waves *w = context;
    for (size_t i = begin; i < end; i++) {
        wave_tile *t = &w->tiles[i % w->tile_count];
        size_t level = i / w->tile_count, edge = t->size >> level;
        t->bounds[level] = bounds_of(t->levels[level], edge * edge);
    }
}

/* ---- time ---- */

typedef struct evolution {
    waves *w;
    double time_s;
} evolution;

enum { EVOLVED_MODES = 2048 };

static void evolve(void *context, size_t begin, size_t end)
{
    const evolution *e = context;
    for (size_t i = begin; i < end; i++) {
        wave_amplitudes *a = e->w->amplitudes[i % e->w->tile_count];
        size_t first = i / e->w->tile_count * EVOLVED_MODES;
        size_t last = first + EVOLVED_MODES < a->count ? first + EVOLVED_MODES : a->count;
        wave_amplitudes_evolve(a, e->time_s, first, last);
    }
}

void waves_set_time(waves *w, double time_s)
{
    w->time_s = time_s;
    if (!w->tile_count)
        return;
    size_t most = 0;
    for (uint32_t i = 0; i < w->tile_count; i++)
        most = w->amplitudes[i]->count > most ? w->amplitudes[i]->count : most;
    evolution e = {w, wave_phase_time(w, time_s)};
    parallel_for(w->thread_count, (most + EVOLVED_MODES - 1) / EVOLVED_MODES * w->tile_count, 1, evolve, &e);
    wave_transform_run(w->transform, w);
    uint32_t level_count = w->tiles[0].level_count;
    for (uint32_t level = 1; level < level_count; level++) {
        reduction r = {w, level};
        size_t rows = (size_t)(w->tiles[0].size >> level) * w->tile_count;
        parallel_for(w->thread_count, rows, level < 3 ? 32 : rows, reduce_rows, &r);
    }
    parallel_for(w->thread_count, (size_t)level_count * w->tile_count, 1, find_bounds, w);
}

/* ---- the whole ---- */

facet_result waves_create(const facet_sea_desc *desc, const sea_state *state, waves *out, facet_error *error)
{
    *out = (waves){.state = *state,
                   .choppiness = (double)desc->choppiness,
                   .loop_s = desc->loop_s,
                   .seed = desc->seed,
                   .allocator = desc->allocator,
                   .thread_count = desc->thread_count,
                   .tile_count = state->bands.count};
    if (!out->tile_count)
        return FACET_OK;
    facet_result result = FACET_OK;
    double level_m = 0.0;
    for (uint32_t i = 0; i < out->tile_count && !result; i++) {
        out->tiles[i] = tile_of(state, i, desc->resolution);
        result = allocate_tile(out, &out->tiles[i], error);
        if (result)
            break;
        out->amplitudes[i] = wave_amplitudes_create(out, i);
        if (!out->amplitudes[i])
            result = fail_memory(error, "amplitudes of waves", 0);
        else
            level_m += out->amplitudes[i]->level_m;
    }
    out->level_m = (float)level_m;
    if (!result)
        result = wave_transform_create(out, &out->transform, error);
    if (result) {
        waves_destroy(out);
        return result;
    }
    waves_set_time(out, 0.0);
    return FACET_OK;
}
