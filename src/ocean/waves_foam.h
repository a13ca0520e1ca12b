/* waves_foam.h - foam of crests that break and what they leave behind, at the time of the waves.
 *
 * Foam rests in the water. Where a crest has broken it fades as e^(-age / decay): at a place at rest its amount is the largest
 * of what was active then, times that. It is computed anew for a time, from five decays before, so that no frame depends on
 * another.
 *
 * Which place of the longest tile breaks is known by its own waves' convergence and, for the shorter waves, as a probability; the
 * amount is a share of the area around. Within that area foam lies where a sum of clouds and cells of three sizes is above the
 * number that the share of it exceeds: much of it is a patch with ragged edges, less has holes of many sizes, little is threads between them.
 *
 * No place is white for a ripple's own convergence: ripples curl over without air in them, and would dot all crests. What is shorter than
 * the longest tile's waves is part of the chance alone. */
#ifndef OCEAN_WAVES_FOAM_H
#define OCEAN_WAVES_FOAM_H

#include "ocean/foam_history.h"
#include "ocean/foam_plane.h"
#include "ocean/waves.h"

/* How a pattern is read: its rows and columns in samples per m along X and Z of the world. */
enum { FOAM_READINGS = 4 }; /* clouds, then cells of three sizes */
typedef struct foam_reading {
    uint32_t pattern;
    double along[2], across[2];
    float samples_per_m; /* the more of both */
    float weight;        /* their squares sum to 1 */
} foam_reading;

typedef struct waves_foam {
    const waves *w;
    foam_plane share;                   /* of the longest tile, [0, 1] */
    foam_plane patterns[FOAM_PATTERNS]; /* of the history */
    foam_reading readings[FOAM_READINGS];
} waves_foam;

/* For w as it is, which stays as long. The mean share is rule->coverage. decay_s: some 3.7 s in
 * sea water, 2.5 s in fresh. *history: of the same waves, NULL: is made; the caller destroys it, after the foam. FACET_ERROR_MEMORY. */
facet_result waves_foam_create(const waves *w, const foam_rule *rule, double decay_s,
                               const facet_allocator *allocator, foam_history **history, waves_foam *out,
                               facet_error *error);
void waves_foam_destroy(waves_foam *f); /* {0} is allowed */

/* Foam in a footprint. */
typedef struct foam_seen {
    float share;  /* under it, [0, 1] */
    float amount; /* around, 1: it is new */
} foam_seen;
/* (x, z) at rest. */
foam_seen waves_foam_at(const waves_foam *f, double x, double z, float footprint_m);

/* waves_foam_create()'s decay by salinity, g/kg. */
double foam_decay_s(double salinity);

#endif
