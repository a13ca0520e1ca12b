/* sh_window.h - nine spherical harmonics of one channel as a function on the sphere: turned, their least value, and windows
 * that raise it. */
#ifndef IBL_SH_WINDOW_H
#define IBL_SH_WINDOW_H

#include "ibl/sh.h"

/* Harmonics of the same function seen in a frame that is turned around +Y: an environment that rotation_rad turns from +Z
 * towards +X. Exact. */
void sh_rotate(double c[SH_COUNT][3], double rotation_rad);

/* The least value of the sum of c times sh_basis() over the sphere, exact but for rounding. */
double sh_least(const double c[SH_COUNT]);

/* The factors of bands 1 and 2 in a window that ends at band 1 / narrowness, narrowness in [0, 1/3]; 0: 1 and 1. Four times the
 * Lanczos window: (sin x / x)^4, x = pi l narrowness (Sloan 2017, "Deringing Spherical Harmonics"). */
void sh_window(double narrowness, double factors[2]);

/* The widest such window, one for all channels, that leaves the irradiance of radiance nowhere negative, applied to
 * radiance. Returns its narrowness, 0 where nothing was negative. Filament's cmgen does the same but never less than a
 * narrowness of 1 / 13. For light that is nowhere negative 1 / 3 does. */
double sh_dering(double radiance[SH_COUNT][3]);

#endif
