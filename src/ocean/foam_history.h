/* foam_history.h - where the longest tile has broken in the last seconds, and the patterns of old foam: what foam at a time is
 * computed from, kept, as the next frame looks at nearly the same. It changes no number of it. */
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
    double step_s, decay_s; /* of the times that are looked at; in which foam fades by e */
    uint32_t count;         /* of times: now, then multiples of step_s */
    foam_plane patterns[FOAM_PATTERNS];
    foam_chances *chances;
    foam_pair *pairs; /* of multiples, as many as are kept */
    uint32_t pair_count;
    float *past; /* has_past: the largest of what was active up to a multiple, as faded as then */
    int64_t past_multiple;
    bool has_past;
    float (*coefficients)[2][2], (*rows)[2], *fields[2]; /* to work in */
} foam_history;

/* For a sea's waves, of any time; threshold of convergence: above 0. FACET_ERROR_MEMORY. */
facet_result foam_history_create(const waves *w, double threshold, double decay_s,
                                 const facet_allocator *allocator, foam_history **out, facet_error *error);
void foam_history_destroy(foam_history *h); /* NULL is allowed */

/* For the waves as they are: each texel of share, size^2, to the largest of what was active, faded by its age. FACET_ERROR_MEMORY. */
facet_result foam_history_gather(foam_history *h, const waves *w, float *share, facet_error *error);

#endif
