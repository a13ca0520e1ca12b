/* path_film_state.h - the state of a path_film per pixel, for the files that implement it. All values are
 * means, which neither grow with the samples nor lose precision to them, and floats, which an OpenEXR file
 * stores bit for bit. */
#ifndef PATH_FILM_STATE_H
#define PATH_FILM_STATE_H

#include <stdatomic.h>

#include "path/path_film.h"

enum {
    PATH_FILM_MAX_SAMPLES = 1 << 24, /* of a pixel: a float counts exactly up to here */
    PATH_FILM_MIN_SAMPLES = 32,      /* before noise is judged */
    PATH_FILM_BLOCK = 8,             /* side of a block, pixels */
    PATH_FILM_LAYERS = 2,            /* at most, of path_film_list_layers() */
    PATH_PIXEL_CHANNELS = 19,        /* floats of a path_pixel */
    PATH_GROUND_CHANNELS = 4         /* of a path_ground */
};

/* Means over samples. The color's are mean + rest, 48 bits: after n samples their rounding error is about
 * 2^-49 sqrt(n / 3) of them (each step rounds by up to 2^-49, and later ones shrink it), also where n is
 * 2^24. */
typedef struct path_pixel {
    float mean[4], rest[4]; /* red, green, blue, opacity */
    float spread[3];        /* mean squared deviation of the colors: the variance of one sample */
    float albedo[3], normal[3];
    float filter_excess; /* mean of the filter weights over 1 */
    float samples;       /* an integer; a float as the other channels of a file */
} path_pixel;

/* Means over those samples of a pixel that hit the ground, of luminance. */
typedef struct path_ground {
    float open;    /* light without the model */
    float blocked; /* part of it that the model blocks; negative: it reflects more than it blocks */
    float spread;  /* mean squared deviation of the blocked light */
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
