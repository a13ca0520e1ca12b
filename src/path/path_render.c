/* path_render.c - see path_render.h. */
#include "path/path_render.h"

#include "base/clock.h"
#include "base/parallel.h"
#include "base/result.h"
#include "path/path_film.h"
#include "path/path_lights.h"

typedef struct pass {
    path_scene scene;
    path_film *film;
    const uint32_t *crop;
    uint32_t width, first, count;
} pass;

static void draw_rows(void *context, size_t begin, size_t end)
{
    pass *p = context;
    for (size_t row = begin; row < end; row++)
        for (uint32_t x = 0; x < p->width; x++)
            for (uint32_t i = p->first; i < p->first + p->count; i++) {
                path_sample sample;
                path_trace(&p->scene, p->crop[0] + x, p->crop[1] + (uint32_t)row, i, &sample);
                path_film_add(p->film, row * p->width + x, &sample);
            }
}

static facet_result attempt(prepared_scene *prepared, const facet_render_desc *desc, double deadline_s,
                            film *target, facet_render_stats *stats, bool *has_setup, facet_error *error)
{
    (void)deadline_s;
    *stats = (facet_render_stats){.thread_count = desc->thread_count};
    render_setup setup = {.prepared = prepared, .desc = desc, .stats = stats, .reads_everywhere = true};
    facet_result result = render_setup_create(&setup, error);
    *has_setup = result == FACET_OK;
    path_lights *lights = NULL;
    path_film *sums = NULL;
    if (result == FACET_OK)
        result = path_lights_create(&setup, &lights, error);
    if (result == FACET_OK)
        result = path_film_create(&desc->allocator, target->width, target->height, false, &sums, error);
    if (result == FACET_OK) {
        pass p = {.scene = {.setup = &setup,
                            .lights = lights,
                            .draws_background = desc->background == FACET_BACKGROUND_ENVIRONMENT},
                  .film = sums,
                  .crop = desc->crop,
                  .width = target->width,
                  .count = desc->samples};
        parallel_for(desc->thread_count, target->height, 1, draw_rows, &p);
        path_film_resolve(sums, exp2f(desc->exposure_ev), target, desc->thread_count);
    }
    path_film_destroy(sums);
    path_lights_destroy(lights);
    render_setup_destroy(&setup);
    return result;
}

facet_result path_render_prepared(prepared_scene *p, const facet_render_desc *desc, film *target,
                                  facet_render_stats *stats, facet_error *error)
{
    return render_with_prepared(attempt, p, desc, target, stats, error);
}
