/* harmonics.h - spherical harmonics of an environment up to a high degree, and cube maps filtered with them.
 *
 * A rotationally symmetric lobe, as that of a surface seen head on (N = V = R), filters an environment by
 * scaling each degree l of its harmonics with a number k_l (Ramamoorthi and Hanrahan 2001, for any such
 * kernel). That is exact: no samples, no noise, and a sun of one texel becomes the lobe itself. A GGX lobe of
 * width alpha needs degrees up to about 4 / alpha. Analysis costs about degree^2 times the rows of the
 * panorama, a filter degree^3; at degree 512 that is 0.1 s. */
#ifndef IBL_HARMONICS_H
#define IBL_HARMONICS_H

#include "facet/facet.h"
#include "ibl/cube.h"
#include "image/image.h"

enum { HARMONICS_MAX_DEGREE = 1344 }; /* a grid has three columns per degree, at most FOURIER_MAX */

/* Coefficients c_lm = integral of L P_lm(cos theta) e^(-i m phi), orthonormal P_lm, theta from +Y, for 0 <= m
 * <= l, of the difference from the mean, so that those of a uniform environment are 0. Texels have constant
 * radiance over their solid angle. */
typedef struct harmonics {
    facet_allocator allocator;
    uint32_t degree; /* highest degree, a multiple of 32 */
    /* columns of the analysis grid; the center of column 0 is phi = 0 */
    uint32_t column_count;
    float mean[3];
    float least[3];      /* least radiance of the panorama, a lower bound of every mean */
    float *coefficients; /* per order m: [l - m][R G B][re im] */
    bool is_grey;        /* R, G and B are known to be the same: filters then compute one of them */
    float *spectra; /* scratch memory of filters, kept because mapping arrays of this size costs more than */
    rgbx *grid;     /* filtering */
    size_t spectrum_count, grid_count; /* allocated elements */
} harmonics;

/* degree: a multiple of 32 up to HARMONICS_MAX_DEGREE. FACET_ERROR_MEMORY. */
facet_result harmonics_create(const image *panorama, uint32_t degree, const facet_allocator *allocator,
                              uint32_t thread_count, harmonics *out, facet_error *error);
void harmonics_destroy(harmonics *h); /* {0} is allowed; leaves {0} */
/* Releases the scratch memory until the next filter. */
void harmonics_trim(harmonics *h);

/* Filters the environment into a cube map: degree l is scaled by kernel[l] for l up to degree (a multiple of
 * 32, at most h->degree), radiance by scale; the result is rotated by rotation_rad around +Y from +Z towards
 * +X. Values below the least radiance of the panorama, from ringing around a sun, are clamped to it. One
 * filter at a time per h. FACET_ERROR_MEMORY. */
typedef struct harmonics_filter_desc {
    const float *kernel;
    uint32_t degree;
    double rotation_rad;
    float scale;
    uint32_t size; /* texels along an edge of the cube map */
    const facet_allocator *allocator;
    uint32_t thread_count;
} harmonics_filter_desc;
facet_result harmonics_filter(harmonics *h, const harmonics_filter_desc *desc, cube *out, facet_error *error);

#endif
