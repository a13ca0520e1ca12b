/* preview.c - see preview.h. */
#include "cpu/preview.h"

#include <math.h>

#include "base/clock.h"
#include "base/result.h"
#include "cpu/ground_shadow.h"
#include "cpu/render_setup.h"
#include "cpu/tiles.h"

#include "draw/ogl1_setup.h"

static facet_result draw(render_setup *setup, double deadline_s, film *target, facet_error *error)
{
    double start = clock_seconds();
    const facet_render_desc *desc = setup->desc;
    ogl1_setup ogl1 = {.light_count = 0};
    facet_result result = FACET_OK;
    if (desc->shading == FACET_SHADING_OGL1) {
        const prepared_scene *p = setup->prepared;
        const ogl1_source source = {p->scene, &p->pose, &p->geometries, &p->default_legacy};
        result = ogl1_setup_create(&source, &setup->camera, desc, &setup->light, &setup->plans, &ogl1, error);
        setup->shading.ogl1 = &ogl1;
    }
    bool has_ground = desc->ground == FACET_GROUND_SHADOW; /* which is between the model and the background */
    tiles_desc tiles = {.render = desc,
                        .scene = &setup->shading,
                        .raster = setup->raster,
                        .identities = setup->identities,
                        .deadline_s = deadline_s,
                        .draws_background = desc->background == FACET_BACKGROUND_ENVIRONMENT && !has_ground,
                        .has_ambient_occlusion =
                            desc->ambient_occlusion == FACET_AMBIENT_OCCLUSION_ON && setup->light.ibl};
    if (result == FACET_OK)
        result = tiles_draw(&tiles, target, setup->stats, error);
    const scene_pose *pose = &setup->prepared->pose;
    ground_shadow_desc ground = {.render = desc,
                                 .scene = &setup->shading,
                                 .height_m = pose->bounds_min[1],
                                 .model_size_m = fmaxf(pose->bounds_max[0] - pose->bounds_min[0],
                                                       fmaxf(pose->bounds_max[1] - pose->bounds_min[1],
                                                             pose->bounds_max[2] - pose->bounds_min[2])),
                                 .deadline_s = deadline_s};
    if (result == FACET_OK && has_ground)
        result = ground_shadow_draw(&ground, target, setup->stats, error);
    ogl1_setup_destroy(&ogl1);
    setup->stats->shade_s = clock_seconds() - start;
    return result;
}

static facet_result render_image(render_setup *setup, double deadline_s, film *target, bool *has_setup,
                                 facet_error *error)
{
    const facet_render_desc *desc = setup->desc;
    TRY(render_check_limits(desc, "prepare", 0.0, deadline_s, error));
    TRY(ogl1_check(setup->prepared->scene, desc, error));
    TRY(render_setup_create(setup, error));
    *has_setup = true;
    TRY(render_check_limits(desc, "shade", 0.0, deadline_s, error));
    TRY(draw(setup, deadline_s, target, error));
    return render_check_limits(desc, "shade", 1.0, 0.0, error);
}

static facet_result attempt(const void *context, prepared_scene *prepared, const facet_render_desc *desc,
                            double deadline_s, film *target, facet_render_stats *stats, bool *has_setup,
                            facet_error *error)
{
    (void)context;
    *stats = (facet_render_stats){.thread_count = desc->thread_count};
    *has_setup = false;
    render_setup setup = {.prepared = prepared, .desc = desc, .stats = stats, .rasterises = true};
    facet_result result = render_image(&setup, deadline_s, target, has_setup, error);
    render_setup_destroy(&setup);
    return result;
}

facet_result preview_render_prepared(prepared_scene *p, const facet_render_desc *desc, film *target,
                                     facet_render_stats *stats, facet_error *error)
{
    return render_with_prepared(attempt, NULL, p, desc, target, stats, error);
}

facet_result preview_render(const facet_scene *scene, const facet_render_desc *desc, film *target,
                            facet_render_stats *stats, facet_error *error)
{
    prepared_scene p;
    prepared_scene_init(&p, scene, &desc->allocator);
    facet_result result = preview_render_prepared(&p, desc, target, stats, error);
    prepared_scene_clear(&p);
    return result;
}
