/* denoise_noise.h - what of a picture's light is noise: outliers, which go at once, and the variance of the rest. */
#ifndef FILM_DENOISE_NOISE_H
#define FILM_DENOISE_NOISE_H

#include "film/denoise_planes.h"

/* Takes outliers of p->light down to their neighbours, and turns p->noise from what each pixel's samples say of
 * its variance into an estimate that is good enough to weigh differences with. scratch: two planes. */
void denoise_find_noise(denoise_planes *p, float *const scratch[2], uint32_t thread_count);

#endif
