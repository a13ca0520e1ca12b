/* wave_amplitudes.h - the waves of one tile: wave vectors, frequencies and random amplitudes. */
#ifndef OCEAN_WAVE_AMPLITUDES_H
#define OCEAN_WAVE_AMPLITUDES_H

#include "ocean/waves.h"

/* A wave vector k = n 2 pi / length and its opposite, whose field is the conjugate: n_z > 0, or n_z = 0
 * and n_x > 0. */
typedef struct wave_mode {
    int32_t n_x, n_z;
    float stretch;  /* choppiness coth(k depth) / k */
    double omega;   /* rad/s, rounded so that the loop is periodic */
    float there[2]; /* h0(k), complex */
    float back[2];  /* h0(-k) */
} wave_mode;

typedef struct wave_amplitudes {
    double k_step; /* 2 pi / length */
    int32_t reach; /* largest |n_x|, |n_z| */
    size_t count;
    wave_mode *modes; /* by rows of n_z */
    float (*now)[2];  /* h(k, t) of each, complex */
    float (*rate)[2]; /* its derivative by time */
    double level_m;   /* by which choppiness lowers the mean level: choppiness sum k coth(k depth) |h|^2 */
} wave_amplitudes;

/* NULL: out of memory. The random numbers depend on seed, tile and n alone, so that a finer tile has the same
 * long waves. */
wave_amplitudes *wave_amplitudes_create(const waves *w, uint32_t tile);
void wave_amplitudes_destroy(wave_amplitudes *a); /* NULL is allowed */

/* h(k, t) = h0(k) e^-i omega t + conj(h0(-k)) e^i omega t, and its derivative by time (NULL: not wanted);
 * complex. */
void wave_mode_at(const wave_mode *m, double phase_time_s, float h[2], float rate[2]);
/* Evaluates modes [begin, end) into now and rate. */
void wave_amplitudes_evolve(wave_amplitudes *a, double time_s, size_t begin, size_t end);
/* The time for phases: within a loop, and small enough for their precision. */
double wave_phase_time(const waves *w, double time_s);

#endif
