/* merl.h - measured isotropic BRDFs in the format of the MERL database (Matusik, Pfister, Brand, McMillan
 * 2003, "A Data-Driven Reflectance Model").
 *
 * A file is three int32 (90, 90, 180: cells of theta_h, theta_d, phi_d), then three planes of doubles, red, green,
 * blue, phi_d fastest; little-endian. Values are BRDFs in 1/sr divided by 1/1500, 1.15/1500, 1.66/1500.
 * theta_h of cell i is (pi / 2) (i / 90)^2, so that cells are finest at the mirror direction; theta_d is
 * even over [0, pi/2], phi_d over [0, pi], for which reciprocity is made use of (Rusinkiewicz 1998, "A New
 * Change of Variables"). Negative values and NaN mark what was not measured. */
#ifndef PLOT_MERL_H
#define PLOT_MERL_H

#include "facet/facet.h"

enum { MERL_THETA_H = 90, MERL_THETA_D = 90, MERL_PHI_D = 180 };
#define MERL_CELLS ((size_t)MERL_THETA_H * MERL_THETA_D * MERL_PHI_D)

typedef struct merl merl;

/* Maps the file. Fails with FACET_ERROR_READ, _INVALID where dimensions or size are not those of the
 * format or no cell has a value, _MEMORY. */
facet_result merl_open(const char *path, const facet_allocator *allocator, merl **out, facet_error *error);
void merl_close(merl *m); /* NULL is allowed */

/* BRDF per channel, 1/sr, N = +Z, V and L unit and above the horizon: linear between the centers of
 * neighboring cells that have values; NAN where none has. */
void merl_brdf(const merl *m, const float V[3], const float L[3], double out[3]);

/* Directions of half and difference angles (rad), for iterating over the cells. */
void merl_directions(double theta_h, double theta_d, double phi_d, float V[3], float L[3]);
/* theta_h of a cell coordinate, [0, 90]. */
double merl_theta_h(double cell);

/* Factor of a channel: the BRDF is the stored value times it. */
double merl_scale(int channel);

#endif
