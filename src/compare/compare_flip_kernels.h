/* compare_flip_kernels.h - the filters of FLIP for an observer: what an eye resolves, and how it finds edges and points. */
#ifndef COMPARE_COMPARE_FLIP_KERNELS_H
#define COMPARE_COMPARE_FLIP_KERNELS_H

enum {
    FLIP_MAX_RADIUS = 136 /* at 1000 pixels per degree */
};

/* The upper halves of symmetric kernels, weights from the middle to radius. */
typedef struct flip_kernel {
    int radius;
    float weights[FLIP_MAX_RADIUS + 1];
} flip_kernel;

typedef struct flip_kernels {
    int halo; /* the largest radius */
    /* Contrast sensitivity of the achromatic, red-green and blue-yellow channels, the last a sum of two. Each is applied along
     * rows and then along columns. */
    flip_kernel achromatic, red_green, blue_yellow[2];
    /* A Gaussian, its first derivative (odd: the weights are those on the right), and its second. */
    flip_kernel gaussian, first, second;
} flip_kernels;

/* pixels_per_degree: [1, 1000]. Andersson et al. 2020, sections 4.1.1 and 4.2; in double, rounded at the end. */
void flip_kernels_make(double pixels_per_degree, flip_kernels *out);

#endif
