/* waves_foam.h - foam of breaking crests and of what they leave behind, at the time of the waves.
 *
 * Foam rests in the water and fades as e^(-age / decay) after a crest has broken: the amount at a rest
 * position is the maximum of past activity, faded by its age. It is evaluated for each time from five
 * decay times back, so that no frame depends on another.
 *
 * Whether a place of the longest tile breaks follows from its own convergence and, for the shorter waves,
 * from a probability; the amount is a coverage of the area around. Within that area, foam lies where a sum
 * of clouds and cells of three sizes exceeds the quantile of the coverage: much foam is a patch with
 * ragged edges, less has holes of many sizes, little is thin threads.
 *
 * The convergence of a ripple alone makes no foam: ripples curl over without air in them, and would dot all
 * crests. Waves shorter than those of the longest tile enter only through the probability. */
#ifndef OCEAN_WAVES_FOAM_H
#define OCEAN_WAVES_FOAM_H

#include "ocean/foam_history.h"
#include "ocean/foam_plane.h"
#include "ocean/waves.h"

/* Mapping of a pattern: its rows and columns in samples per m along world X and Z. */
enum { FOAM_READINGS = 4 }; /* clouds, then cells of three sizes */
typedef struct foam_reading {
    uint32_t pattern;
    double along[2], across[2];
    float samples_per_m; /* the larger of both */
    float weight;        /* their squares sum to 1 */
} foam_reading;

typedef struct waves_foam {
    const waves *w;
    foam_plane share;                   /* of the longest tile, [0, 1] */
    foam_plane patterns[FOAM_PATTERNS]; /* of the history */
    foam_reading readings[FOAM_READINGS];
} waves_foam;

/* At the current time of w, which outlives the foam. The mean coverage is rule->coverage. decay_s: about
 * 3.7 s in sea water, 2.5 s in fresh. *history: of the same waves, NULL: is created; the caller destroys
 * it, after the foam. FACET_ERROR_MEMORY. */
facet_result waves_foam_create(const waves *w, const foam_rule *rule, double decay_s,
                               const facet_allocator *allocator, foam_history **history, waves_foam *out,
                               facet_error *error);
void waves_foam_destroy(waves_foam *f); /* {0} is allowed */

/* Foam in a footprint. */
typedef struct foam_seen {
    float share;  /* coverage, [0, 1] */
    float amount; /* coverage of the area around; 1: fresh */
} foam_seen;
/* (x, z): rest position. */
foam_seen waves_foam_at(const waves_foam *f, double x, double z, float footprint_m);

/* decay_s of waves_foam_create(), by salinity in g/kg. */
double foam_decay_s(double salinity);

#endif
