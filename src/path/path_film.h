/* path_film.h - the accumulation of a path traced image: sums that are exact over millions of samples, their noise, which
 * pixels need more. */
#ifndef PATH_FILM_H
#define PATH_FILM_H

#include "film/film.h"
#include "path/path_scene.h"

typedef struct path_film path_film;

/* An empty film of the crop's size. has_ground: keeps the two sums of the ground as well.
 * FACET_ERROR_MEMORY. */
facet_result path_film_create(const facet_allocator *allocator, uint32_t width, uint32_t height,
                              bool has_ground, path_film **out, facet_error *error);
void path_film_destroy(path_film *f); /* NULL is allowed */

/* Adds a sample to pixel number `pixel` (rows from the top left). A sample that is not finite counts as
 * black, and in path_film_dropped(). A pixel has at most 2^24 samples; later ones are ignored. Threads may
 * add to different pixels. The order of a pixel's samples does not matter. */
void path_film_add(path_film *f, size_t pixel, const path_sample *sample);
/* Adds all samples of another film of the same kind and size. False: a pixel would have more than 2^24 of them. */
bool path_film_add_film(path_film *f, const path_film *other);
uint32_t path_film_samples(const path_film *f, size_t pixel);
/* The factor from a sum over the samples of a pixel, each with its filter weight, to the mean that
 * path_film_resolve() uses; 0 without samples. */
float path_film_share(const path_film *f, size_t pixel);
uint64_t path_film_total_samples(const path_film *f);
uint64_t path_film_dropped(const path_film *f);
void path_film_set_dropped(path_film *f, uint64_t count);

/* The factor from radiance to display-linear values, 1 being white: 2^exposure_ev. Default 1. */
void path_film_set_scale(path_film *f, float scale);
/* Adaptive sampling: path_film_needs_more() is whether the region of a pixel was noisier than noise
 * (facet_path_desc) at the last path_film_update(). Noise is the standard error as displayed, se(v) / (2
 * (v + 1/400)^(1/2)) for a luminance v of 1 for white, as root mean square over a block of 8 x 8 pixels,
 * and also over the block with its neighbors. A block is never done before it has 32 samples per pixel.
 * Call path_film_update() between passes; noise 0: nothing is done. The result depends on the samples
 * alone: a neighbor's later samples may reactivate a block. */
void path_film_update(path_film *f, float noise, uint32_t thread_count);
bool path_film_needs_more(const path_film *f, size_t pixel);
/* The share of pixels that are done. */
float path_film_share_done(const path_film *f);

/* Fills the layers that target has, of: color (means times scale, premultiplied, opacity clamped to [0,
 * 1]; the ground composited below as black with the opacity of its shadow), albedo, normal (unit, or 0),
 * variance (of the mean, as of independent samples: an upper bound), samples. */
void path_film_resolve(const path_film *f, float scale, film *target, uint32_t thread_count);

/* Fills target as path_film_resolve() does with scale 2^exposure_ev, ends its Cryptomatte layers, which hold sums, and
 * denoises where desc->path.denoises is set. The film gets no more samples. *denoise_s: the time that took. */
facet_result path_film_finish(path_film *f, const facet_render_desc *desc, film *target, double *denoise_s,
                              facet_error *error);

/* Denoises the image so far into layer "" of target, the shadow on the ground aside. */
facet_result path_film_denoise(const path_film *f, const facet_render_desc *desc, float scale, film *target,
                               facet_error *error);

/* The layers that path_film_resolve() makes of samples, beside the image. */
enum { PATH_FILM_AOVS = FACET_AOV_ALBEDO | FACET_AOV_NORMAL | FACET_AOV_VARIANCE | FACET_AOV_SAMPLES };

/* ---- the film as layers, for files ---- */

enum { PATH_FILM_MAX_CHANNELS = 64 };
/* The state as one layer or two, which stay the film's. Returns their number. */
uint32_t path_film_list_layers(const path_film *f, film_layer layers[2]);
/* Whether path_film_resolve() makes the layer of that name of samples. */
bool path_film_makes_layer(const char *name);
/* Whether the values are those of a film. */
bool path_film_is_sound(const path_film *f);
/* Moves these layers to target, in place of those that path_film_resolve() fills but for the image, for viewers. f can
 * be destroyed only. */
void path_film_give_layers(path_film *f, film *target);

/* Denoises the shadow on the ground, in place: biased, for a film that gets no more samples.
 * FACET_ERROR_MEMORY. */
facet_result path_film_denoise_ground(path_film *f, uint32_t thread_count, facet_error *error);

#endif
