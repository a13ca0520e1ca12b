/* render_cpu.c - see render_cpu.h. */
#include "render/render_cpu.h"

#include "base/clock.h"
#include "base/result.h"
#include "cpu/preview.h"
#include "path/path_render.h"
#include "water/water_scene.h"

/* The renderers on the CPU have no state beyond the set. */
facet_result render_cpu_create(renderer_set *set, void **state, facet_error *error)
{
    (void)error;
    *state = set;
    return FACET_OK;
}

void render_cpu_destroy(void *state)
{
    (void)state;
}

/* ---- preview ---- */

facet_result render_preview_draw(void *state, const facet_render_desc *desc, film *target,
                                 facet_render_stats *stats, facet_error *error)
{
    renderer_set *set = state;
    if (desc->sea)
        return water_render(&set->water, set->scene, desc, target, stats, error);
    return preview_render_prepared(&set->prepared, desc, target, stats, error);
}

/* ---- path tracing ---- */

facet_result render_path_resolve(facet_render_desc *desc, facet_error *error)
{
    if (desc->path.resumes && desc->aovs & FACET_AOV_CRYPTOMATTE)
        return fail(error, FACET_ERROR_ARGUMENT,
                    "layers: a checkpoint does not keep Cryptomatte's; render them without resuming");
    if (!desc->path.max_depth)
        desc->path.max_depth = PATH_DEFAULT_DEPTH;
    return FACET_OK;
}

/* The sea's surface and bed are part of the scene that is drawn. */
static facet_result draw_path_in_sea(renderer_set *set, const facet_render_desc *desc, film *target,
                                     facet_render_stats *stats, facet_error *error)
{
    double deadline_s = desc->time_limit_s > 0.0 ? clock_seconds() + desc->time_limit_s : 0.0;
    water_scene *water;
    prepared_scene prepared;
    TRY(water_scene_create(&set->water, set->scene, desc, deadline_s, &water, stats, error));
    const facet_render_desc *inner = water_scene_get_desc(water);
    prepared_scene_init(&prepared, water_scene_get_scene(water), &desc->allocator);
    facet_result result =
        path_render_prepared(&prepared, inner, water_scene_get_surface(water), target, stats, error);
    prepared_scene_clear(&prepared);
    water_scene_destroy(water);
    return result;
}

facet_result render_path_draw(void *state, const facet_render_desc *desc, film *target,
                              facet_render_stats *stats, facet_error *error)
{
    renderer_set *set = state;
    if (desc->sea)
        return draw_path_in_sea(set, desc, target, stats, error);
    return path_render_prepared(&set->prepared, desc, NULL, target, stats, error);
}
