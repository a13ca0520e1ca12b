/* denoise.h - the denoiser's input: one plane of floats per quantity, with margins that repeat the
 * border so that windows can be read anywhere; and the fit of a window. */
#ifndef FILM_DENOISE_H
#define FILM_DENOISE_H

#include "film/film.h"

enum {
    DENOISE_RADIUS = 7,                             /* of the window of a fit, px */
    DENOISE_SIDE = 2 * DENOISE_RADIUS + 1,          /* pixels of a row of the window, */
    DENOISE_ROW = 16,                               /* stored with one more: whole vectors */
    DENOISE_WINDOW = DENOISE_SIDE * DENOISE_ROW,    /* stored pixels of a window */
    DENOISE_PATCH = 1,                              /* radius of the patches that are compared, px */
    DENOISE_MARGIN = DENOISE_RADIUS + DENOISE_PATCH /* of a plane, px; one more on the right */
};

/* Light is the image divided by its albedo, in units of about its mean; noise is its variance. radiance =
 * light * denoise_divisor(albedo) * scale. */
typedef struct denoise_planes {
    uint32_t width, height;
    size_t pitch; /* floats from row to row */
    float scale;  /* a power of two */
    float *light[3], *noise[3], *albedo[3], *normal[3], *opacity;
    float *block; /* all of them; NULL: none */
} denoise_planes;

/* Index of pixel (x, y) in a plane; it may lie in the margin. */
static inline size_t denoise_index(const denoise_planes *p, ptrdiff_t x, ptrdiff_t y)
{
    return (size_t)(y + DENOISE_MARGIN) * p->pitch + (size_t)(x + DENOISE_MARGIN);
}

/* Factor from light to radiance: the albedo, except for dark surfaces, which reflect mostly independently of
 * it. */
static inline float denoise_divisor(float albedo)
{
    const float least = 0.02f;
    return albedo > least ? albedo : least;
}

/* Reads f, which has the layers. Pixels that are not finite become the mean of their neighbours.
 * FACET_ERROR_MEMORY. */
facet_result denoise_planes_create(const film *f, const facet_allocator *allocator, uint32_t thread_count,
                                   denoise_planes *out, facet_error *error);
void denoise_planes_destroy(denoise_planes *p);

/* ---- fits ---- */

/* The pixels of the window around a center, DENOISE_ROW in a row, the last of which is unused. */
typedef struct denoise_fit {
    float weight[DENOISE_WINDOW];   /* similarity of a pixel to the center: (0, 1]; 0: outside of the image */
    float value[3][DENOISE_WINDOW]; /* fitted radiance over scale */
} denoise_fit;

/* Fits the window around (x, y) of the image. */
void denoise_fit_window(const denoise_planes *p, ptrdiff_t x, ptrdiff_t y, denoise_fit *out);

#endif
