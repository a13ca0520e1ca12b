/* render_setup.c - see render_setup.h: the stages, and which of them run concurrently. */
#include "cpu/render_setup.h"

#include "base/clock.h"
#include "base/memory.h"
#include "base/parallel.h"
#include "base/result.h"
#include "cpu/raster.h"
#include "cpu/texture_need.h"
#include "draw/texture_set.h"
#include "scene/identity.h"

#include <math.h>

#include "shade/shade.h"

/* ---- stages that need the geometry only, and not each other ---- */

static void read_everywhere(const facet_scene *scene, texture_use *uses)
{
    for (uint32_t i = 0; i < scene->texture_count; i++)
        uses[i].min_lod = 0.0f;
}

static facet_result find_texture_need(render_setup *p, facet_error *error)
{
    const facet_render_desc *desc = p->desc;
    const facet_scene *scene = p->prepared->scene;
    if (scene->texture_count == 0)
        return FACET_OK;
    float footprint = desc->quality == FACET_QUALITY_FINAL ? 0.5f : 1.0f;
    float opacity_footprint = 1.0f / sqrtf((float)desc->samples);
    texture_need_desc need = {.width = desc->width,
                              .height = desc->height,
                              .footprint = footprint,
                              .ogl1 = &desc->ogl1,
                              .opacity_footprint = fminf(footprint, opacity_footprint),
                              .keeps_all_texels = desc->quality == FACET_QUALITY_FINAL,
                              .is_opacity_only = p->reads_opacity_only,
                              .thread_count = desc->thread_count};
    TRY(texture_need(scene, &p->prepared->geometries, &p->camera, &need, &desc->allocator, p->uses, error));
    if (p->reads_everywhere || desc->decodes_whole_textures)
        read_everywhere(scene, p->uses);
    return FACET_OK;
}

/* Whether rays other than the camera's first hits are traced. */
static bool needs_hierarchy(const render_setup *p)
{
    const uint32_t traced = LAYER_TRANSMISSION | LAYER_VOLUME;
    const render_geometry_set *set = &p->prepared->geometries;
    if (!p->rasterises || p->desc->aovs || p->desc->ground != FACET_GROUND_NONE ||
        p->desc->ambient_occlusion == FACET_AMBIENT_OCCLUSION_ON)
        return true;
    for (uint32_t i = 0; i < set->count; i++) {
        const render_geometry *g = &set->items[i];
        if (g->is_see_through || (!g->legacy && g->is_lit && material_plan_layers(g->material) & traced))
            return true;
    }
    return false;
}

static facet_result prepare_raster(render_setup *p, facet_error *error)
{
    const facet_render_desc *desc = p->desc;
    const raster_desc rastering = {.geometries = &p->prepared->geometries,
                                   .camera = &p->camera,
                                   .width = desc->width,
                                   .height = desc->height,
                                   .sample_count = desc->samples,
                                   .thread_count = desc->thread_count,
                                   .needs_hierarchy = needs_hierarchy(p)};
    return p->rasterises ? raster_create(&rastering, &desc->allocator, &p->raster, error) : FACET_OK;
}

static facet_result prepare_textures(render_setup *p, facet_error *error)
{
    const facet_render_desc *desc = p->desc;
    double start = clock_seconds();
    facet_result result = find_texture_need(p, error);
    if (result == FACET_OK)
        result = prepared_scene_textures(p->prepared, error);
    if (result == FACET_OK)
        result = texture_set_create_from(p->prepared->textures, p->prepared->scene, p->uses, &desc->allocator,
                                         &desc->log, desc->thread_count, &p->textures, error);
    if (result == FACET_OK)
        p->stats->decoded_texels += texture_set_decoded_texels(p->textures);
    p->stats->textures_s += clock_seconds() - start;
    return result;
}

/* Without it, only first hits are found, by the raster. */
static facet_result prepare_hierarchy(render_setup *p, facet_error *error)
{
    double start = clock_seconds();
    facet_result result = FACET_OK;
    if (p->raster && !needs_hierarchy(p))
        prepared_scene_skip_hierarchy(p->prepared);
    else
        result = prepared_scene_hierarchy(p->prepared, p->desc, error);
    p->hierarchy_s = clock_seconds() - start;
    return result;
}

static facet_result prepare_tangents(render_setup *p, facet_error *error)
{
    double start = clock_seconds();
    facet_result result = prepared_scene_tangents(p->prepared, p->desc, error);
    p->tangents_s = clock_seconds() - start;
    return result;
}

static facet_result prepare_light(render_setup *p, facet_error *error)
{
    double start = clock_seconds();
    facet_result result = light_setup_create(&p->prepared->geometries, &p->prepared->pose, &p->camera,
                                             p->desc, p->samples_light, &p->light, error);
    p->stats->light_s += clock_seconds() - start;
    return result;
}

/* The longest first, so that the others fill the other threads. */
enum { STAGE_COUNT = 4 };
static facet_result (*const STAGES[STAGE_COUNT])(render_setup *p, facet_error *error) = {
    prepare_textures, prepare_light, prepare_tangents, prepare_hierarchy};

typedef struct stage_run {
    render_setup *p;
    facet_result results[STAGE_COUNT];
    facet_error errors[STAGE_COUNT];
} stage_run;

static void run_stages(void *context, size_t begin, size_t end)
{
    stage_run *run = context;
    for (size_t i = begin; i < end; i++)
        run->results[i] = STAGES[i](run->p, &run->errors[i]);
}

static facet_result run_all_stages(render_setup *p, facet_error *error)
{
    stage_run run = {.p = p};
    parallel_for(p->desc->thread_count, STAGE_COUNT, 1, run_stages, &run);
    p->stats->geometry_s += p->hierarchy_s + p->tangents_s;
    for (int i = 0; i < STAGE_COUNT; i++)
        if (run.results[i] != FACET_OK) {
            if (error)
                *error = run.errors[i];
            return run.results[i];
        }
    return FACET_OK;
}

/* ---- decoded textures ---- */

static bool lacks_red(const texture_set *textures, uint32_t texture)
{
    const texture_pyramid *data = texture < textures->binding_count ? textures->bindings[texture].data : NULL;
    return data && data->lacks_red;
}

/* Removes occlusion textures that are black throughout, with a warning per material: once for all images
 * of a scene, and not where light is sampled, which needs no occlusion. */
static facet_result drop_black_occlusion(render_setup *p, facet_error *error)
{
    const uint32_t bit = 1u << SCENE_OCCLUSION_TEXTURE;
    const facet_scene *scene = p->prepared->scene;
    bool warns = !p->prepared->has_warned_occlusion && !p->samples_light;
    bool *is_warned = mem_zalloc(&p->desc->allocator, (size_t)scene->material_count + 1, sizeof *is_warned);
    if (!is_warned)
        return fail_memory(error, "materials", scene->material_count);
    for (uint32_t i = 0; i < p->prepared->geometries.count; i++) {
        const render_geometry *g = &p->prepared->geometries.items[i];
        if (!(p->plans.items[i].textures & bit) ||
            !material_plan_drops_occlusion(
                g->material, lacks_red(p->textures, g->material->textures[SCENE_OCCLUSION_TEXTURE].texture)))
            continue;
        p->plans.items[i].textures &= ~bit;
        if (warns && !is_warned[g->material_id])
            material_plan_warn_occlusion(scene, g->material_id - 1, &p->desc->log);
        is_warned[g->material_id] = true;
    }
    p->prepared->has_warned_occlusion |= warns;
    mem_free(is_warned);
    return FACET_OK;
}

/* ---- all ---- */

/* Sets camera_spread, from camera, and all members behind it. */
static void set_options(shading_scene *scene, const facet_render_desc *desc)
{
    scene->camera_spread = ray_spread_of_camera(scene->camera);
    scene->energy = desc->energy;
    scene->quality = desc->quality;
    scene->has_specular_antialiasing = desc->has_specular_antialiasing;
    scene->background_blur = desc->background == FACET_BACKGROUND_ENVIRONMENT ? desc->background_blur : 0.0f;
    scene->backdrop = desc->sea || desc->background == FACET_BACKGROUND_ENVIRONMENT
                          ? SHADING_BACKDROP_ENVIRONMENT
                      : desc->background == FACET_BACKGROUND_COLOR ? SHADING_BACKDROP_COLOR
                                                                   : SHADING_BACKDROP_NONE;
    for (int i = 0; i < 3; i++)
        scene->backdrop_color[i] = desc->background_color[i] * exp2f(-desc->exposure_ev);
}

facet_result render_setup_create(render_setup *p, facet_error *error)
{
    const facet_render_desc *desc = p->desc;
    double start = clock_seconds();
    TRY(prepared_scene_pose(p->prepared, desc, error));
    TRY(camera_rays_create(desc->camera, desc->width, desc->height, &p->camera, error));
    TRY(prepared_scene_geometry(p->prepared, desc, &p->camera, error));
    TRY(prepare_raster(p, error));
    size_t texture_count = p->prepared->scene->texture_count;
    p->uses = mem_zalloc(&desc->allocator, texture_count, sizeof *p->uses);
    if (!p->uses)
        return fail_memory(error, "textures", texture_count * sizeof *p->uses);
    p->stats->geometry_s += clock_seconds() - start;

    TRY(run_all_stages(p, error));
    TRY(material_plans_create(&p->prepared->geometries, &desc->allocator, &p->plans, error));
    TRY(drop_black_occlusion(p, error));
    if (desc->aovs & SCENE_IDENTITY_AOVS)
        TRY(scene_identities_create(p->prepared->scene, &p->prepared->pose, &desc->allocator, &p->identities,
                                    error));
    p->shading = (shading_scene){.geometries = &p->prepared->geometries,
                                 .rays = &p->prepared->rays,
                                 .plans = &p->plans,
                                 .textures = p->textures,
                                 .light = &p->light,
                                 .camera = &p->camera};
    set_options(&p->shading, desc);
    light_setup_warn_dark(&p->light, &p->prepared->geometries, desc);
    return FACET_OK;
}

void render_setup_destroy(render_setup *p)
{
    material_plans_destroy(&p->plans);
    light_setup_destroy(&p->light);
    raster_destroy(p->raster);
    p->raster = NULL;
    texture_set_destroy(p->textures);
    mem_free(p->uses);
    mem_free(p->identities);
    p->identities = NULL;
    p->textures = NULL;
    p->uses = NULL;
}

facet_result render_with_prepared(render_attempt *attempt, const void *context, prepared_scene *p,
                                  const facet_render_desc *desc, film *target, facet_render_stats *stats,
                                  facet_error *error)
{
    double start = clock_seconds();
    double deadline_s = desc->time_limit_s > 0.0 ? start + desc->time_limit_s : 0.0;
    bool was_empty = !p->key.is_set;
    bool has_setup;
    facet_result result = attempt(context, p, desc, deadline_s, target, stats, &has_setup, error);
    if (!has_setup && result != FACET_OK)
        prepared_scene_clear(p);
    if (result == FACET_ERROR_MEMORY && !was_empty) {
        prepared_scene_clear(p);
        result = attempt(context, p, desc, deadline_s, target, stats, &has_setup, error);
        if (!has_setup && result != FACET_OK)
            prepared_scene_clear(p);
    }
    stats->total_s = clock_seconds() - start;
    return result;
}
