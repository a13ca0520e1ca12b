/* light_environment.h - importance sampling of an equirectangular image, in proportion to the irradiance that
 * each texel gives a surface.
 *
 * The density is bilinear between texel centers, as radiance is (the mean of its three channels), and
 * differs from it only by the change of solid angle within a row near the poles: without compensation it is
 * positive wherever radiance is, and uniform where radiance is. Above the patches of four texels there are
 * LIGHT_ENVIRONMENT_CELLS parts of the sphere, each weighted by its light and by the cosine at the
 * surface (product sampling on the coarse levels: Clarberg et al. 2005, "Wavelet Importance Sampling";
 * Cline et al. 2006, "Two Stage Importance Sampling for Direct Lighting"). Nearby random numbers give
 * nearby directions, so that stratification is preserved. */
#ifndef PATH_LIGHT_ENVIRONMENT_H
#define PATH_LIGHT_ENVIRONMENT_H

#include "draw/light_setup.h"
#include "image/image.h"
#include "shade/shade.h"

/* Bands of rows from the top, blocks of columns from the left. */
enum {
    LIGHT_ENVIRONMENT_BANDS = 8,
    LIGHT_ENVIRONMENT_BLOCKS = 16,
    LIGHT_ENVIRONMENT_CELLS = LIGHT_ENVIRONMENT_BANDS * LIGHT_ENVIRONMENT_BLOCKS
};

typedef struct light_environment light_environment;

/* For an image (F32 RGB, finite, not negative) that outlives it, rotated and scaled as in light. *out:
 * NULL where it is black. Takes 4 bytes per texel. Fails with FACET_ERROR_MEMORY.
 *
 * is_compensated: only radiance above half of its mean over the sphere is sampled. The rest is left to BSDF samples,
 * with which these must be combined by multiple importance sampling. Karlik et al. 2019, "MIS Compensation:
 * Optimizing Sampling Techniques in Multiple Importance Sampling". */
facet_result light_environment_create(const image *map, const light_setup *light, bool is_compensated,
                                      const facet_allocator *allocator, uint32_t thread_count,
                                      light_environment **out, facet_error *error);
void light_environment_destroy(light_environment *e); /* NULL is allowed */

/* Radiance from the unit direction d, cd/m^2: bilinear. */
vec3 light_environment_radiance(const light_environment *e, vec3 d);

/* The environment as seen by a surface with one normal. */
typedef struct light_environment_view {
    /* Approximate irradiance from each cell, lx, mean of the channels; by block and, within it, by band. */
    float cells[LIGHT_ENVIRONMENT_CELLS];
    float bands[LIGHT_ENVIRONMENT_BANDS]; /* their sums by band */
    float irradiance;                     /* the sum of all */
} light_environment_view;

/* N: unit, only directions above its horizon count; {0}: all count alike (irradiance is then the integral
 * of radiance). */
void light_environment_see(const light_environment *e, vec3 N, light_environment_view *view);
/* Samples a unit direction by uniform random numbers in [0, 1); view->irradiance is positive. Returns its
 * pdf per sr; 0 for the very last numbers, where it underflows. */
float light_environment_sample(const light_environment *e, const light_environment_view *view,
                               const double u[2], vec3 *d);
/* The pdf of light_environment_sample() in the unit direction d. */
float light_environment_pdf(const light_environment *e, const light_environment_view *view, vec3 d);

#endif
