/* sh.h - diffuse irradiance as nine spherical harmonics (Ramamoorthi and Hanrahan 2001).
 *
 * Coefficients are in the order (l, m) = 00, 1-1, 10, 11, 2-2, 2-1, 20, 21, 22 of the real basis
 *   Y00 = 0.2820947918
 *   Y1  = 0.4886025119 (y, z, x)
 *   Y2  = 1.0925484306 (x y, y z), 0.3153915653 (3 z^2 - 1), 1.0925484306 x z, 0.5462742153 (x^2 - y^2) */
#ifndef IBL_SH_H
#define IBL_SH_H

#include "facet/facet.h"
#include "image/image.h"

enum { SH_COUNT = 9 };

/* Basis functions at the unit direction d. */
void sh_basis(const double d[3], double y[SH_COUNT]);

/* Coefficients of radiance, L_lm = integral of L Y_lm over the sphere, of a panorama (F32 RGB) with constant
 * radiance per texel; the integrals are exact. Does not depend on thread_count. FACET_ERROR_MEMORY. */
facet_result sh_project(const image *panorama, const facet_allocator *allocator, uint32_t thread_count,
                        double radiance[SH_COUNT][3], facet_error *error);
/* The same with channels clamped to limit. */
facet_result sh_project_limited(const image *panorama, float limit, const facet_allocator *allocator,
                                uint32_t thread_count, double radiance[SH_COUNT][3], facet_error *error);

/* Coefficients of irradiance, E_lm = A_l L_lm: A_l = pi, 2 pi / 3, pi / 4 are those of the clamped cosine. */
void sh_irradiance(const double radiance[SH_COUNT][3], double irradiance[SH_COUNT][3]);
/* Coefficients of irradiance / pi in the order 1, y, z, x, xy, yz, 3z^2 - 1, xz, x^2 - y^2, with the basis
 * constants and 1 / pi folded in. */
void sh_fold_over_pi(const double irradiance[SH_COUNT][3], float c[SH_COUNT][3]);
/* Irradiance / pi at the unit direction N, clamped to 0: nine coefficients ring around a small sun. */
void sh_evaluate(const float c[SH_COUNT][3], const float N[3], float out[3]);

/* ---- windows ---- */

/* Rotates harmonics around +Y by rotation_rad from +Z towards +X. Exact. */
void sh_rotate(double c[SH_COUNT][3], double rotation_rad);

/* Minimum over the sphere of the sum of c times sh_basis(), exact up to rounding. */
double sh_minimum(const double c[SH_COUNT]);

/* Factors of bands 1 and 2 of a window that ends at band 1 / narrowness, narrowness in [0, 1/3] (0: both are
 * 1): the fourth power of the Lanczos window, (sin x / x)^4, x = pi l narrowness (Sloan 2017, "Deringing
 * Spherical Harmonics"). */
void sh_window(double narrowness, double factors[2]);

/* Applies the widest such window, the same for all channels, that makes irradiance nowhere negative, and
 * returns its narrowness, 0 if nothing was negative. Filament's cmgen does the same with a narrowness of at
 * least 1 / 13. 1 / 3 suffices for radiance that is nowhere negative. */
double sh_dering(double radiance[SH_COUNT][3]);

#endif
