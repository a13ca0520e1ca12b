/* water_crests.h - how high the waves around an eye are at most: squares of cells around it, each level over an area twice as wide as the
 * one before with cells twice as wide. Rays that are above a cell's waves go past it in one step.
 *
 * Only the longest tile, which has nearly all of the height, is looked at; what the others add at most is the caller's to add. */
#ifndef WATER_WATER_CRESTS_H
#define WATER_WATER_CRESTS_H

#include "ocean/waves.h"

enum { CRESTS_LEVELS = 5, CRESTS_SIZE = 128 };

typedef struct water_crests {
    double cells_per_m[2];           /* of level 0: cosine and sine of the tile's turn, over a cell's width */
    double cell_m;                   /* of level 0 */
    int64_t first[CRESTS_LEVELS][2]; /* number of the first cell along the tile's axes */
    float *
        highest; /* CRESTS_LEVELS squares, each cell over itself and its eight neighbours; NULL: there are no waves */
} water_crests;

/* Around (X, Z). FACET_ERROR_MEMORY. */
facet_result water_crests_create(const waves *w, double X, double Z, const facet_allocator *allocator,
                                 water_crests *out, facet_error *error);
void water_crests_destroy(water_crests *c); /* {0} is allowed */

/* The first level that may be used where the surface is read with a footprint (m), and water of other tiles moves at most as far as
 * farthest_m; CRESTS_LEVELS: none. */
uint32_t water_crests_level(const water_crests *c, float footprint_m, float farthest_m);

/* A ray in the axes of level 0's cells: place and how it changes with t. */
typedef struct crests_ray {
    double u, v, du, dv;
} crests_ray;
crests_ray water_crests_ray(const water_crests *c, const double origin[3], const double direction[3]);

/* How far the ray, y above still water at t and rising by rise, may go on from there without meeting waves that others_m are added
 * to: to the end of the widest cell whose waves are all lower, or to where it comes down to them. 0: nowhere. */
double water_crests_pass(const water_crests *c, const crests_ray *ray, double t, double y, double rise,
                         float others_m, uint32_t first_level);

#endif
