/* wave_amplitudes.c - samples the waves of a tile from the spectrum, and advances their phases. Tessendorf
 * 2001, with the factor that gives the field the variance of the spectrum: h0(k) = 1/2 sqrt(Psi(k)) dk
 * (xi_r + i xi_i). */
#include "ocean/wave_amplitudes.h"

#include <math.h>

#include "base/memory.h"
#include "base/hash.h"
#include "base/parallel.h"

static const double TWO_PI = 6.28318530717958647693;

/* ---- random numbers ---- */

/* Two independent normal random numbers of one wave, by Box and Muller. */
static void normal_pair(uint64_t seed, uint32_t tile, int32_t n_x, int32_t n_z, double out[2])
{
    uint64_t key = mix64(seed + MIX64_STEP * (tile + 1u));
    key = mix64(key ^ ((uint64_t)(uint32_t)n_x << 32 | (uint32_t)n_z));
    double u = ((double)(mix64(key + MIX64_STEP) >> 11) + 0.5) * 0x1p-53;
    double v = (double)(mix64(key + 2u * MIX64_STEP) >> 11) * 0x1p-53;
    double radius = sqrt(-2.0 * log(u));
    out[0] = radius * cos(TWO_PI * v);
    out[1] = radius * sin(TWO_PI * v);
}

/* ---- modes ---- */

static bool is_in_band(const wave_tile *t, double k)
{
    return k >= t->k_from && k < t->k_to && k > 0.0;
}

/* Modes with n_z = row; modes NULL: counts only. */
static size_t list_row(const wave_tile *t, double k_step, int32_t reach, int32_t row, wave_mode *modes)
{
    size_t count = 0;
    for (int32_t n_x = row ? -reach : 1; n_x <= reach; n_x++)
        if (is_in_band(t, k_step * hypot(n_x, row))) {
            if (modes)
                modes[count] = (wave_mode){.n_x = n_x, .n_z = row};
            count++;
        }
    return count;
}

typedef struct drawing {
    const waves *w;
    const wave_tile *tile;
    uint32_t tile_index;
    uint64_t seed;
    wave_amplitudes *amplitudes;
} drawing;

static double looped_omega(double omega, double loop_s)
{
    if (!(loop_s > 0.0))
        return omega;
    double turns = round(omega * loop_s / TWO_PI);
    return TWO_PI / loop_s * fmax(turns, 1.0);
}

static void draw_modes(void *context, size_t begin, size_t end)
{
    drawing *d = context;
    const sea_state *s = &d->w->state;
    double step = d->amplitudes->k_step;
    for (size_t i = begin; i < end; i++) {
        wave_mode *m = &d->amplitudes->modes[i];
        double k = step * hypot(m->n_x, m->n_z);
        double theta = atan2(m->n_z, m->n_x) + d->tile->turn;
        sea_ring ring = sea_ring_at(s, k);
        double there = 0.5 * step * sqrt(sea_ring_density(&ring, theta));
        double back = 0.5 * step * sqrt(sea_ring_density(&ring, theta + 0.5 * TWO_PI));
        double a[2], b[2];
        normal_pair(d->seed, d->tile_index, m->n_x, m->n_z, a);
        normal_pair(d->seed, d->tile_index, -m->n_x, -m->n_z, b);
        for (int j = 0; j < 2; j++) {
            m->there[j] = (float)(there * a[j]);
            m->back[j] = (float)(back * b[j]);
        }
        m->omega = looped_omega(wave_omega(k, s->depth_m), d->w->loop_s);
        m->stretch = (float)(d->w->choppiness * wave_stretch(k, s->depth_m) / k);
    }
}

static double squared(const float a[2])
{
    return (double)a[0] * (double)a[0] + (double)a[1] * (double)a[1];
}

/* wave_amplitudes.level_m, m: the sum over k and -k, in the mean over time, since the two beat. */
static double level_of(const wave_amplitudes *a)
{
    double sum = 0.0;
    for (size_t i = 0; i < a->count; i++) {
        const wave_mode *m = &a->modes[i];
        double k = a->k_step * hypot(m->n_x, m->n_z);
        sum += 2.0 * (double)m->stretch * k * k * (squared(m->there) + squared(m->back));
    }
    return sum;
}

wave_amplitudes *wave_amplitudes_create(const waves *w, uint32_t tile)
{
    const wave_tile *t = &w->tiles[tile];
    wave_amplitudes *a = mem_zalloc(&w->allocator, 1, sizeof *a);
    if (!a)
        return NULL;
    a->k_step = TWO_PI / t->length_m;
    int32_t most = (int32_t)(t->size / 2) - 1; /* the Nyquist frequency has no sign */
    a->reach = (int32_t)fmin(floor(t->k_to / a->k_step), most);
    for (int32_t row = 0; row <= a->reach; row++)
        a->count += list_row(t, a->k_step, a->reach, row, NULL);
    a->modes = mem_alloc(&w->allocator, a->count, sizeof *a->modes);
    a->now = mem_alloc(&w->allocator, a->count, sizeof *a->now);
    a->rate = mem_alloc(&w->allocator, a->count, sizeof *a->rate);
    if (!a->modes || !a->now || !a->rate) {
        wave_amplitudes_destroy(a);
        return NULL;
    }
    size_t next = 0;
    for (int32_t row = 0; row <= a->reach; row++)
        next += list_row(t, a->k_step, a->reach, row, a->modes + next);
    drawing d = {w, t, tile, w->seed, a};
    parallel_for(w->thread_count, a->count, 1024, draw_modes, &d);
    a->level_m = level_of(a);
    return a;
}

void wave_amplitudes_destroy(wave_amplitudes *a)
{
    if (!a)
        return;
    mem_free(a->modes);
    mem_free(a->now);
    mem_free(a->rate);
    mem_free(a);
}

/* ---- time ---- */

double wave_phase_time(const waves *w, double time_s)
{
    /* 2^24 s are half a year, with phases to 1e-7 of a cycle for the fastest waves. */
    return fmod(time_s, w->loop_s > 0.0 ? w->loop_s : 0x1p24);
}

void wave_mode_at(const wave_mode *m, double phase_time_s, float h[2], float rate[2])
{
    double phase = m->omega * phase_time_s;
    float c = (float)cos(phase), s = (float)sin(phase);
    const float there[2] = {m->there[0] * c + m->there[1] * s, m->there[1] * c - m->there[0] * s};
    const float back[2] = {m->back[0] * c + m->back[1] * s, m->back[0] * s - m->back[1] * c};
    h[0] = there[0] + back[0];
    h[1] = there[1] + back[1];
    if (!rate)
        return;
    float omega = (float)m->omega; /* -i omega there + i omega back */
    rate[0] = omega * (there[1] - back[1]);
    rate[1] = omega * (back[0] - there[0]);
}

void wave_amplitudes_evolve(wave_amplitudes *a, double time_s, size_t begin, size_t end)
{
    for (size_t i = begin; i < end; i++)
        wave_mode_at(&a->modes[i], time_s, a->now[i], a->rate[i]);
}
