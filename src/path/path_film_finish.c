/* path_film_finish.c - from the samples of a whole image to its layers: means, coverage, denoising. */
#include <math.h>
#include <string.h>

#include "base/clock.h"
#include "film/matte.h"
#include "path/path_film.h"

enum { GUIDES = FACET_AOV_ALBEDO | FACET_AOV_NORMAL | FACET_AOV_VARIANCE };

facet_result path_film_denoise(const path_film *f, const facet_render_desc *desc, float scale, film *target,
                               facet_error *error)
{
    film guided;
    facet_result result =
        film_create(&desc->allocator, target->width, target->height, GUIDES, &guided, error);
    if (result != FACET_OK)
        return result;
    path_film_resolve(f, scale, &guided, desc->thread_count);
    result = film_denoise(&guided, &desc->allocator, desc->thread_count, error);
    if (result == FACET_OK)
        memcpy(target->layers[0].pixels, guided.layers[0].pixels,
               (size_t)target->width * target->height * 4 * sizeof(float));
    film_destroy(&guided);
    return result;
}

/* Normalizes sums over a pixel's samples to shares of it. */
static void finish_mattes(const path_film *f, film *target)
{
    matte_layers mattes = matte_find(target);
    size_t pixel_count = (size_t)target->width * target->height;
    for (size_t pixel = 0; mattes.aovs && pixel < pixel_count; pixel++)
        matte_finish(&mattes, pixel, path_film_share(f, pixel));
}

facet_result path_film_finish(path_film *f, const facet_render_desc *desc, film *target, double *denoise_s,
                              facet_error *error)
{
    double start = clock_seconds();
    float scale = exp2f(desc->exposure_ev);
    if (desc->path.denoises) {
        facet_result result = path_film_denoise_ground(f, desc->thread_count, error);
        if (result != FACET_OK)
            return result;
    }
    path_film_resolve(f, scale, target, desc->thread_count);
    finish_mattes(f, target);
    if (!desc->path.denoises)
        return FACET_OK;
    facet_result result = path_film_denoise(f, desc, scale, target, error);
    *denoise_s = clock_seconds() - start;
    return result;
}
