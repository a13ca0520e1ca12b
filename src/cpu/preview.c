/* preview.c - see preview.h: the stages of a render and which of them run at the same time. */
#include "cpu/preview.h"

#include "base/clock.h"
#include "base/memory.h"
#include "base/parallel.h"
#include "base/result.h"
#include "cpu/texture_need.h"
#include "cpu/texture_set.h"
#include "cpu/tiles.h"

#include <math.h>

#include "cpu/ogl1_setup.h"

/* All that is made for one picture. */
typedef struct preview {
    prepared_scene *prepared;
    const facet_render_desc *desc;
    facet_render_stats *stats;
    camera_rays camera;
    texture_use *uses;
    texture_set *textures;
    light_setup light;
    double hierarchy_s, tangents_s;
} preview;

/* ---- stages that need the geometry only, and not each other ---- */

static facet_result prepare_textures(preview *p, facet_error *error)
{
    const facet_render_desc *desc = p->desc;
    const facet_scene *scene = p->prepared->scene;
    double start = clock_seconds();
    float footprint = desc->quality == FACET_QUALITY_FINAL ? 0.5f : 1.0f;
    float opacity_footprint = 1.0f / sqrtf((float)desc->samples);
    texture_need_desc need = {.width = desc->width,
                              .height = desc->height,
                              .footprint = footprint,
                              .ogl1 = &desc->ogl1,
                              .opacity_footprint = fminf(footprint, opacity_footprint),
                              .thread_count = desc->thread_count};
    facet_result result = FACET_OK;
    if (scene->texture_count)
        result = texture_need(scene, &p->prepared->geometries, &p->camera, &need, &desc->allocator, p->uses,
                              error);
    if (result == FACET_OK)
        result = prepared_scene_textures(p->prepared, error);
    if (result == FACET_OK)
        result = texture_set_create_from(p->prepared->textures, scene, p->uses, &desc->allocator, &desc->log,
                                         desc->thread_count, &p->textures, error);
    if (result == FACET_OK)
        p->stats->decoded_texels = texture_set_decoded_texels(p->textures);
    p->stats->textures_s = clock_seconds() - start;
    return result;
}

static facet_result prepare_hierarchy(preview *p, facet_error *error)
{
    double start = clock_seconds();
    facet_result result = prepared_scene_hierarchy(p->prepared, p->desc, error);
    p->hierarchy_s = clock_seconds() - start;
    return result;
}

static facet_result prepare_tangents(preview *p, facet_error *error)
{
    double start = clock_seconds();
    facet_result result = prepared_scene_tangents(p->prepared, p->desc, error);
    p->tangents_s = clock_seconds() - start;
    return result;
}

static facet_result prepare_light(preview *p, facet_error *error)
{
    double start = clock_seconds();
    facet_result result = light_setup_create(&p->prepared->geometries, &p->prepared->pose, &p->camera,
                                             p->desc, &p->light, error);
    p->stats->light_s = clock_seconds() - start;
    return result;
}

/* The longest first, so that the others fill the threads beside it. */
enum { STAGE_COUNT = 4 };
static facet_result (*const STAGES[STAGE_COUNT])(preview *p, facet_error *error) = {
    prepare_textures, prepare_light, prepare_tangents, prepare_hierarchy};

typedef struct stage_run {
    preview *p;
    facet_result results[STAGE_COUNT];
    facet_error errors[STAGE_COUNT];
} stage_run;

static void run_stages(void *context, size_t begin, size_t end)
{
    stage_run *run = context;
    for (size_t i = begin; i < end; i++)
        run->results[i] = STAGES[i](run->p, &run->errors[i]);
}

static facet_result prepare(preview *p, facet_error *error)
{
    const facet_render_desc *desc = p->desc;
    double start = clock_seconds();
    facet_result result = ogl1_check(p->prepared->scene, desc, error);
    if (result == FACET_OK)
        result = prepared_scene_pose(p->prepared, desc, error);
    if (result == FACET_OK)
        result = camera_rays_create(desc->camera, desc->width, desc->height, &p->camera, error);
    if (result == FACET_OK)
        result = prepared_scene_geometry(p->prepared, desc, &p->camera, error);
    if (result != FACET_OK)
        return result;
    size_t texture_count = p->prepared->scene->texture_count;
    p->uses = mem_zalloc(&desc->allocator, texture_count, sizeof *p->uses);
    if (!p->uses)
        return fail_memory(error, "textures", texture_count * sizeof *p->uses);
    p->stats->geometry_s = clock_seconds() - start;

    stage_run run = {.p = p};
    parallel_for(desc->thread_count, STAGE_COUNT, 1, run_stages, &run);
    p->stats->geometry_s += p->hierarchy_s + p->tangents_s;
    for (int i = 0; i < STAGE_COUNT; i++)
        if (run.results[i] != FACET_OK) {
            if (error)
                *error = run.errors[i];
            return run.results[i];
        }
    return FACET_OK;
}

/* ---- the picture ---- */

static facet_result check_limits(const facet_render_desc *desc, const char *stage, double fraction,
                                 double deadline_s, facet_error *error)
{
    if (desc->progress.report && !desc->progress.report(desc->progress.user, stage, fraction))
        return fail(error, FACET_ERROR_CANCELLED, "cancelled (%s)", stage);
    if (deadline_s > 0.0 && clock_seconds() > deadline_s)
        return fail(error, FACET_ERROR_LIMIT, "the time limit was reached (%s)", stage);
    return FACET_OK;
}

static facet_result draw(preview *p, double deadline_s, film *target, facet_error *error)
{
    double start = clock_seconds();
    material_plan_set plans;
    facet_result result = material_plans_create(&p->prepared->geometries, &p->desc->allocator, &plans, error);
    if (result != FACET_OK)
        return result;
    shading_scene shading = {.geometries = &p->prepared->geometries,
                             .embree = &p->prepared->embree,
                             .plans = &plans,
                             .textures = p->textures,
                             .light = &p->light,
                             .camera = &p->camera};
    shading_scene_set_options(&shading, p->desc);
    ogl1_setup ogl1 = {.light_count = 0};
    if (p->desc->shading == FACET_SHADING_OGL1) {
        result = ogl1_setup_create(p->prepared, &p->camera, p->desc, &p->light, &plans, &ogl1, error);
        shading.ogl1 = &ogl1;
    }
    tiles_desc tiles = {.render = p->desc, .scene = &shading, .deadline_s = deadline_s};
    if (result == FACET_OK)
        result = tiles_draw(&tiles, target, p->stats, error);
    ogl1_setup_destroy(&ogl1);
    material_plans_destroy(&plans);
    p->stats->shade_s = clock_seconds() - start;
    return result;
}

/* One attempt; *is_drawing: all was prepared. */
static facet_result render(prepared_scene *prepared, const facet_render_desc *desc, double deadline_s,
                           film *target, facet_render_stats *stats, bool *is_drawing, facet_error *error)
{
    *stats = (facet_render_stats){.thread_count = desc->thread_count};
    *is_drawing = false;
    preview p = {.prepared = prepared, .desc = desc, .stats = stats};
    facet_result result = check_limits(desc, "prepare", 0.0, deadline_s, error);
    if (result == FACET_OK)
        result = prepare(&p, error);
    *is_drawing = result == FACET_OK;
    if (result == FACET_OK)
        result = check_limits(desc, "shade", 0.0, deadline_s, error);
    if (result == FACET_OK)
        result = draw(&p, deadline_s, target, error);
    if (result == FACET_OK)
        result = check_limits(desc, "shade", 1.0, 0.0, error);
    light_setup_destroy(&p.light);
    texture_set_destroy(p.textures);
    mem_free(p.uses);
    return result;
}

facet_result preview_render_prepared(prepared_scene *p, const facet_render_desc *desc, film *target,
                                     facet_render_stats *stats, facet_error *error)
{
    double start = clock_seconds();
    double deadline_s = desc->time_limit_s > 0.0 ? start + desc->time_limit_s : 0.0;
    bool was_empty = !p->has_pose;
    bool is_drawing;
    facet_result result = render(p, desc, deadline_s, target, stats, &is_drawing, error);
    if (!is_drawing && result != FACET_OK)
        prepared_scene_clear(p);
    if (result == FACET_ERROR_MEMORY && !was_empty) {
        prepared_scene_clear(p);
        result = render(p, desc, deadline_s, target, stats, &is_drawing, error);
        if (!is_drawing && result != FACET_OK)
            prepared_scene_clear(p);
    }
    stats->total_s = clock_seconds() - start;
    return result;
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
