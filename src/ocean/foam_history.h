/* foam_history.h - breaking of the longest tile in the last seconds, and the patterns of old foam: the
 * inputs of foam at a time. They are cached, since the next frame needs nearly the same ones; that changes
 * no result. */
#ifndef OCEAN_FOAM_HISTORY_H
#define OCEAN_FOAM_HISTORY_H

#include "ocean/foam_plane.h"
#include "ocean/waves.h"

enum { FOAM_CELLS, FOAM_CLOUDS, FOAM_PATTERNS }; /* foam_plane.h */

typedef struct foam_chances foam_chances;
typedef struct foam_pair foam_pair;

typedef struct foam_history {
    facet_allocator allocator;
    uint32_t size;
    double step_s, decay_s; /* between evaluated times; e-folding time of foam */
    uint32_t count;         /* of evaluated times: now, then multiples of step_s */
    foam_plane patterns[FOAM_PATTERNS];
    foam_chances *chances;
    foam_pair *pairs; /* cached multiples of step_s */
    uint32_t pair_count;
    float *past; /* has_past: maximum of the faded activity up to a multiple, as of then */
    int64_t past_multiple;
    bool has_past;
    float (*coefficients)[2][2], (*rows)[2], *fields[2]; /* scratch memory */
} foam_history;

/* For the waves of a sea, at any time; threshold of convergence: above 0. FACET_ERROR_MEMORY. */
facet_result foam_history_create(const waves *w, double threshold, double decay_s,
                                 const facet_allocator *allocator, foam_history **out, facet_error *error);
void foam_history_destroy(foam_history *h); /* NULL is allowed */

/* For the current time of the waves: sets each texel of share, size^2, to the maximum of past activity, faded
 * by age. FACET_ERROR_MEMORY. */
facet_result foam_history_gather(foam_history *h, const waves *w, float *share, facet_error *error);

#endif
