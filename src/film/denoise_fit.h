/* denoise_fit.h - what a window of pixels says about the light in it: a weighted least squares fit. */
#ifndef FILM_DENOISE_FIT_H
#define FILM_DENOISE_FIT_H

#include "film/denoise_planes.h"

/* The pixels of the window around a center, DENOISE_ROW in a row, the last of which is unused. */
typedef struct denoise_fit {
    float weight[DENOISE_WINDOW];   /* how much a pixel has in common with the center: (0, 1], 0: is none */
    float value[3][DENOISE_WINDOW]; /* what its radiance over scale should be */
} denoise_fit;

/* Fits the window around (x, y) of the picture. */
void denoise_fit_window(const denoise_planes *p, ptrdiff_t x, ptrdiff_t y, denoise_fit *out);

#endif
