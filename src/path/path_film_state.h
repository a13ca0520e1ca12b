/* path_film_state.h - what a path_film keeps of each pixel: for the files that fill, judge and store it. All of it is means,
 * which neither grow with the samples nor lose digits to them, and floats, which an OpenEXR file holds bit for bit. */
#ifndef PATH_FILM_STATE_H
#define PATH_FILM_STATE_H

#include <stdatomic.h>

#include "path/path_film.h"

enum {
    PATH_FILM_MAX_SAMPLES = 1 << 24, /* of a pixel: up to here a float counts */
    PATH_FILM_MIN_SAMPLES = 32,      /* that noise is judged by */
    PATH_FILM_BLOCK = 8              /* pixels along the side of what is judged together */
};

/* Means over samples. The color's are mean + rest, 48 bits: after n samples their rounding is about 2^-49 sqrt(n / 3) of
 * them (each step rounds by up to 2^-49, and later ones shrink it), also where n is 2^24. */
typedef struct path_pixel {
    float mean[4], rest[4]; /* red, green, blue, opacity */
    float spread[3]; /* mean square distance of the colors from their mean: the variance of one sample */
    float albedo[3], normal[3];
    float filter_excess; /* of the filter's weights over 1 */
    float samples;       /* whole: a file has it as it has the others */
} path_pixel;

/* Means over those samples of a pixel that met the ground, of luminance. */
typedef struct path_ground {
    float open;    /* that comes without the model */
    float blocked; /* of it, by the model; negative: it reflects more than it takes */
    float spread;  /* mean square distance of what is taken from its mean */
    float samples;
} path_ground;

struct path_film {
    facet_allocator allocator;
    uint32_t width, height;
    path_pixel *pixels;
    path_ground *ground; /* NULL: there is none */
    _Atomic uint64_t dropped;
    float scale;
    /* adaptive sampling, of the last path_film_update() */
    uint32_t block_columns, block_rows;
    float *block_noise; /* NULL: not asked for yet */
    bool *block_is_done;
    float share_done;
};

/* What the colors and the opacity of a pixel are to be multiplied with: one by the mean of its samples' weights, so that
 * what is constant stays so however the samples fell into a filter's negative lobes. It is 1 for filters without. */
float path_pixel_scale(const path_pixel *p);

/* How dark the ground is in a pixel, [0, 1], and the standard error of that. */
float path_ground_opacity(const path_ground *g);
float path_ground_error(const path_ground *g);
/* The share of a pixel that the ground is seen in: what it can be laid under. */
float path_ground_share(const path_ground *g, const path_pixel *p);

#endif
