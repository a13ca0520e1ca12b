/* waves_foam.h - foam that crests leave behind, at the time of the waves.
 *
 * Foam rests in the water. Where a crest has broken it fades as e^(-age / decay): at a place at rest its amount is the largest
 * of what was active then, times that. It is computed anew for a time, from five decays before, so that no frame depends on
 * another.
 *
 * Which place of the longest tile breaks is known by its own waves' convergence and, for the shorter waves, as a probability; the
 * amount is a share of the area around. Within that area old foam lies in lace: along the lines where a Gaussian field, that of
 * the shorter waves as they were at time 0, is near 0; the more the wider, and here thin, there thick. */
#ifndef OCEAN_WAVES_FOAM_H
#define OCEAN_WAVES_FOAM_H

#include "ocean/foam_history.h"
#include "ocean/foam_plane.h"
#include "ocean/waves.h"

static const double FOAM_THICKNESS_WIDTH =
    0.37; /* of samples of lace[0], turned by a right angle, to those of thickness */

typedef struct waves_foam {
    const waves *w;
    foam_plane share;            /* of the longest tile, [0, 1] */
    foam_plane lace[FOAM_LACES]; /* of the history */
    uint32_t lace_tiles[FOAM_LACES];
    uint32_t lace_count;
} waves_foam;

/* For w as it is, which stays as long. The mean share is what rule->coverage has beyond its fresh tenth; decay_s: some 3.7 s in
 * sea water, 2.5 s in fresh. *history: of the same waves, NULL: is made; the caller destroys it, after the foam. FACET_ERROR_MEMORY. */
facet_result waves_foam_create(const waves *w, const foam_rule *rule, double decay_s, foam_history **history,
                               waves_foam *out, facet_error *error);
void waves_foam_destroy(waves_foam *f); /* {0} is allowed */

/* Share of a footprint under old foam, [0, 1]; (x, z) at rest. */
float waves_foam_at(const waves_foam *f, double x, double z, float footprint_m);

/* waves_foam_create()'s decay by salinity, g/kg. */
double foam_decay_s(double salinity);

#endif
