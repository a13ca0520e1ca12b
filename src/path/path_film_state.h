/* path_film_state.h - the state of a path_film per pixel, for the files that implement it: sums in fixed point. Addition of
 * integers is exact, so the sums, and the image, do not depend on the order of samples, nor on who added which. */
#ifndef PATH_FILM_STATE_H
#define PATH_FILM_STATE_H

#include <stdatomic.h>

#include "path/path_film.h"

enum {
    PATH_FILM_MAX_SAMPLES = 1 << 24, /* of a pixel: a float counts exactly up to here */
    PATH_FILM_MIN_SAMPLES = 32,      /* before noise is judged */
    PATH_FILM_BLOCK = 8,             /* side of a block, pixels */
    PATH_FILM_LAYERS = 2,            /* at most, of path_film_list_layers() */
    PATH_PIXEL_WORDS = 44,           /* of 32 bits, of a path_pixel */
    PATH_GROUND_WORDS = 16           /* of a path_ground */
};

/* A sum of light in multiples of 2^-56, or of its squares in multiples of 2^-60. A sample counts up to 2^46 = 7e13 cd/m^2 (the
 * sun has 2e9), so that 2^24 of them fit. A float above 2^-33 = 1.2e-10 is represented exactly. */
__extension__ typedef __int128 path_fixed;

/* Sums over samples. Besides light: multiples of 2^-32, of samples up to 64 in size. */
typedef struct path_pixel {
    path_fixed color[3]; /* red, green, blue */
    path_fixed square[3];
    int64_t opacity, albedo[3], normal[3];
    int64_t filter_excess; /* filter weights over 1 */
    uint32_t samples;
    uint32_t is_saturated; /* 1: a square has counted less, since its light is above 2^21 cd/m^2 */
    uint32_t unused[2];    /* 0 */
} path_pixel;

/* Sums over those samples of a pixel that hit the ground, of luminance. */
typedef struct path_ground {
    path_fixed open;    /* light without the model */
    path_fixed blocked; /* part of it that the model blocks; negative: it reflects more than it blocks */
    path_fixed square;  /* of the blocked light */
    uint32_t samples, is_saturated, unused[2];
} path_ground;

/* Adds a finite sample to the sums of a pixel, and of its ground (NULL: there is none). */
void path_pixel_add(path_pixel *p, path_ground *ground, const path_sample *s);

/* Means over samples; 0 without. The color's error is below 2^-52. c: red, green, blue, opacity. */
float path_pixel_mean(const path_pixel *p, int c);
/* The mean squared deviation of a color: the variance of one sample. Nearly constant light does not cancel. */
double path_pixel_spread(const path_pixel *p, int c);
/* The mean of which sum is the sum: of albedo, normal, opacity or filter weights. */
double path_pixel_share(const path_pixel *p, int64_t sum);
double path_ground_open(const path_ground *g);
double path_ground_blocked(const path_ground *g);
double path_ground_spread(const path_ground *g);
/* Sets the mean and the spread of the blocked light. */
void path_ground_set_blocked(path_ground *g, double blocked, double spread);

struct path_film {
    facet_allocator allocator;
    uint32_t width, height;
    path_pixel *pixels;
    path_ground *ground; /* NULL: there is none */
    _Atomic uint64_t dropped;
    float scale;
    /* adaptive sampling, of the last path_film_update() */
    uint32_t block_columns, block_rows;
    float *block_noise; /* NULL: not requested yet */
    bool *block_is_done;
    float share_done;
};

/* The factor for colors and opacity of a pixel: 1 / the mean filter weight, so that constants are
 * preserved whichever negative lobes the samples fell into. 1 for filters without. */
float path_pixel_scale(const path_pixel *p);

/* The opacity of the shadow on the ground in a pixel, [0, 1], and its standard error. */
float path_ground_opacity(const path_ground *g);
float path_ground_error(const path_ground *g);
/* The share of a pixel in which the ground is visible. */
float path_ground_share(const path_ground *g, const path_pixel *p);

#endif
