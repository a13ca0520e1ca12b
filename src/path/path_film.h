/* path_film.h - what is known of each pixel while samples come in: sums that keep their digits over millions of samples,
 * how noisy they are, which pixels need more, and the file in which all that waits for the next run. */
#ifndef PATH_FILM_H
#define PATH_FILM_H

#include "film/film.h"
#include "path/path_scene.h"

typedef struct path_film path_film;

/* Of the crop's size, no samples. has_ground: keeps the two sums of the ground as well. FACET_ERROR_MEMORY. */
facet_result path_film_create(const facet_allocator *allocator, uint32_t width, uint32_t height,
                              bool has_ground, path_film **out, facet_error *error);
void path_film_destroy(path_film *f); /* NULL is allowed */

/* Adds a sample to pixel number `pixel` (rows from the top left). A sample with a number that is not finite counts as
 * black and is counted in path_film_dropped(). A pixel has at most 2^24 samples; later ones are ignored. Different pixels may
 * be added to at the same time; the order of a pixel's samples counts in the last bits. */
void path_film_add(path_film *f, size_t pixel, const path_sample *sample);
uint32_t path_film_samples(const path_film *f, size_t pixel);
/* What a sum over the samples of a pixel, each with the weight of its filter, is multiplied by to become the mean that
 * path_film_resolve() takes; 0 without samples. */
float path_film_share(const path_film *f, size_t pixel);
uint64_t path_film_total_samples(const path_film *f);
uint64_t path_film_dropped(const path_film *f);

/* What radiance is multiplied by to be 1 where a display's white is: 2^exposure_ev. 1 until it is set. */
void path_film_set_scale(path_film *f, float scale);
/* Adaptive sampling: whether the region that pixel lies in is still noisier than noise (facet_path_desc), by the state that
 * path_film_update() saw. Noise is the standard error of what a display shows, se(v) / (2 (v + 1/400)^(1/2)) of a luminance v
 * of 1 for white, as root mean square over a block of 8 x 8 pixels and also over it with the blocks around. A block is never
 * done before it has 32 samples a pixel. Call path_film_update() between passes; noise 0: nothing is done. What it finds
 * depends on the samples alone, and is not kept: what a neighbor finds later may bring a block back. */
void path_film_update(path_film *f, float noise, uint32_t thread_count);
bool path_film_needs_more(const path_film *f, size_t pixel);
/* The share of the pixels that are done. */
float path_film_share_done(const path_film *f);

/* Fills the layers that target has of: the picture (means times scale, premultiplied, the opacity kept in [0, 1]; the ground
 * laid under it as black with the opacity that its light is short of), albedo, normal (unit, or 0), variance (of the mean, as
 * of independent samples, which is the most that it can be), samples. */
void path_film_resolve(const path_film *f, float scale, film *target, uint32_t thread_count);

/* Filters the noise out of the shadow on the ground, in place: biased, for a film that gets no more samples and is not
 * kept. FACET_ERROR_MEMORY. */
facet_result path_film_denoise_ground(path_film *f, uint32_t thread_count, facet_error *error);

#endif
