/* renderer_set.c - see renderer_set.h. */
#include "render/renderer_set.h"

#include <math.h>

#include "base/result.h"
#include "base/text.h"
#include "draw/empty_view.h"
#include "film/matte.h"
#include "film/meter.h"
#include "film/outline.h"
#include "gl/gl_entry.h"
#include "ocean/sea.h"
#include "scene/identity.h"
#include "water/water_objects.h"

/* ---- object, material and instance IDs ---- */

/* Cryptomatte's metadata: the names of everything in the scene. */
static facet_result describe_mattes(const facet_scene *scene, const facet_render_desc *desc, film *target,
                                    facet_error *error)
{
    static const uint32_t aovs[SCENE_IDENTITY_KINDS] = {FACET_AOV_CRYPTO_OBJECT, FACET_AOV_CRYPTO_MATERIAL,
                                                        FACET_AOV_CRYPTO_INSTANCE};
    facet_result result = FACET_OK;
    for (uint32_t kind = 0; kind < SCENE_IDENTITY_KINDS && result == FACET_OK; kind++) {
        if (!(desc->aovs & aovs[kind]))
            continue;
        text manifest = {.allocator = desc->allocator};
        result = scene_identity_manifest(scene, (scene_identity_kind)kind, &manifest, error);
        if (result == FACET_OK)
            result = matte_describe(target, kind, manifest.data, &desc->allocator, error);
        text_destroy(&manifest);
    }
    return result;
}

/* In a sea, water and bed have names, too. */
static facet_result describe_mattes_in_sea(const facet_scene *scene, const facet_render_desc *desc,
                                           film *target, facet_error *error)
{
    facet_scene *objects;
    if (!(desc->aovs & FACET_AOV_CRYPTOMATTE))
        return FACET_OK;
    TRY(water_objects_scene(scene, desc->sea, &desc->allocator, &objects, error));
    facet_result result = describe_mattes(objects, desc, target, error);
    scene_destroy(objects);
    return result;
}

/* ---- a set of them ---- */

void renderer_set_init(renderer_set *set, const facet_scene *scene, const facet_allocator *allocator)
{
    *set = (renderer_set){.scene = scene};
    if (allocator)
        set->allocator = *allocator;
    set->water.allocator = set->allocator;
    prepared_scene_init(&set->prepared, scene, allocator);
}

void renderer_set_clear(renderer_set *set)
{
    for (int i = 0; i < RENDERER_COUNT; i++) {
        if (set->states[i])
            renderer_get((facet_renderer_kind)i)->destroy(set->states[i]);
        set->states[i] = NULL;
    }
    prepared_scene_clear(&set->prepared);
    water_cache_clear(&set->water);
}

/* ---- the default camera ---- */

/* The camera of a sea looks towards its sun, wherever the scene is. */
static void check_sea_camera(renderer_set *set, const facet_render_desc *desc, const facet_camera *camera)
{
    facet_render_desc whole = *desc; /* without its crop; a background lets the search end at what it finds */
    scene_pose pose;
    camera_rays rays;
    char why[512];
    if (!set->scene || !desc->log.message || set->has_checked_sea_camera ||
        camera_rays_create(camera, desc->width, desc->height, &rays, NULL) != FACET_OK ||
        scene_pose_create(set->scene, &desc->pose, &desc->allocator, desc->thread_count, &pose, NULL) !=
            FACET_OK)
        return;
    whole.crop[0] = whole.crop[1] = 0;
    whole.crop[2] = desc->width;
    whole.crop[3] = desc->height;
    whole.background = FACET_BACKGROUND_ENVIRONMENT;
    if (pose.instance_count > 0 && empty_view_explain(set->scene, &pose, &whole, &rays, why, sizeof why))
        log_warning(&desc->log, "%s: the default camera in a sea does not show it; set one that does",
                    set->scene->source);
    scene_pose_destroy(&pose);
    set->has_checked_sea_camera = true;
}

facet_result renderer_set_camera(renderer_set *set, const facet_render_desc *desc, facet_camera *camera,
                                 facet_error *error)
{
    if (desc->sea) {
        *camera = sea_camera(desc->sea, 0.0f, desc->sky.sun_azimuth_rad);
        check_sea_camera(set, desc, camera);
        return FACET_OK;
    }
    prepared_scene *prepared = &set->prepared;
    facet_orbit orbit = scene_orbit_default();
    orbit.log = desc->log;
    facet_result result = prepared_scene_pose(prepared, desc, error);
    if (result == FACET_ERROR_MEMORY) {
        prepared_scene_clear(prepared);
        result = prepared_scene_pose(prepared, desc, error);
    }
    if (result != FACET_OK)
        return result;
    return scene_fit_pose(prepared->scene, &prepared->pose, &orbit, (float)desc->width / (float)desc->height,
                          desc->thread_count, camera, error);
}

/* ---- images that show nothing, white only, or no outline ---- */

static bool explain(const facet_scene *scene, const scene_pose *pose, const facet_render_desc *desc,
                    char *why, size_t size)
{
    facet_camera fitted;
    facet_orbit orbit = scene_orbit_default();
    camera_rays rays;
    if (!desc->camera && scene_fit_pose(scene, pose, &orbit, (float)desc->width / (float)desc->height,
                                        desc->thread_count, &fitted, NULL) != FACET_OK)
        return false;
    return camera_rays_create(desc->camera ? desc->camera : &fitted, desc->width, desc->height, &rays,
                              NULL) == FACET_OK &&
           empty_view_explain(scene, pose, desc, &rays, why, size);
}

/* An environment as background covers the whole image: then only a certain reason counts. */
static void check_nothing(renderer_set *set, const scene_pose *pose, const facet_render_desc *desc,
                          const film *drawn)
{
    char why[512] = "";
    scene_pose own = {0};
    bool has_background = desc->background == FACET_BACKGROUND_ENVIRONMENT;
    if (set->has_warned_of_nothing || (!has_background && film_is_covered(drawn)))
        return;
    if (!pose && scene_pose_create(set->scene, &desc->pose, &desc->allocator, desc->thread_count, &own,
                                   NULL) != FACET_OK)
        return;
    bool is_certain = explain(set->scene, pose ? pose : &own, desc, why, sizeof why);
    scene_pose_destroy(&own);
    if (!*why || (has_background && !is_certain))
        return;
    log_warning(&desc->log, "%s: nothing of the model is seen: %s", set->scene->source, why);
    set->has_warned_of_nothing = true;
}

static void check_white(renderer_set *set, const facet_render_desc *desc, const film *drawn)
{
    /* White surfaces reach 1.8 in the built-in studio, and so do intended emitters. A visible environment may
     * be brighter. */
    float most = desc->background == FACET_BACKGROUND_ENVIRONMENT ? 8.0f : 2.0f;
    /* Without tone mapping the image may be meant for a file that keeps values above white. */
    if (set->has_warned_of_white || desc->tonemap == FACET_TONEMAP_NONE ||
        desc->shading == FACET_SHADING_OGL1 || !film_is_brighter_than(drawn, most))
        return;
    double stops = (double)desc->exposure_ev - log2(film_meter(drawn) / METER_KEY);
    bool has_lights = set->scene->light_count && !desc->ignores_scene_lights;
    log_warning(
        &desc->log,
        "%s: most of the visible image is overexposed: --exposure %+.1f shows it, and --exposure auto "
        "meters the light%s",
        set->scene->source, stops,
        has_lights ? "; the file's lights may be in real units (lx, cd), --lights none leaves them out" : "");
    set->has_warned_of_white = true;
}

/* A shadow on the ground shows where the model stands. */
static void check_outline(renderer_set *set, const facet_render_desc *desc, const film *drawn)
{
    if (set->has_hinted_at_outline || set->has_warned_of_white ||
        desc->background != FACET_BACKGROUND_COLOR || desc->ground != FACET_GROUND_NONE ||
        desc->shading == FACET_SHADING_OGL1 || !gl_channel_is_light(desc->gl.channel) ||
        !film_outline_is_hidden(drawn, desc->tonemap, desc->background_color))
        return;
    log_message(
        &desc->log, FACET_LOG_LEVEL_HINT,
        "%s: the outline hardly shows on a background of nearly its own color; another --background or "
        "--ground shadow sets it off",
        set->scene->source);
    set->has_hinted_at_outline = true;
}

/* Before tone mapping. pose: of the scene; NULL: computed where needed. A part may show nothing. */
static void check_image(renderer_set *set, const scene_pose *pose, const facet_render_desc *desc,
                        const film *drawn)
{
    if (!desc->log.message || desc->part.count)
        return;
    check_nothing(set, pose, desc, drawn);
    check_white(set, desc, drawn);
    check_outline(set, desc, drawn);
}

/* By the renderer of desc, which is created when it is first used. */
static facet_result draw(renderer_set *set, const facet_render_desc *desc, film *target,
                         facet_render_stats *stats, facet_error *error)
{
    const renderer_row *r = renderer_get(desc->renderer);
    void **state = &set->states[desc->renderer];
    if (!*state)
        TRY(r->create(set, state, error));
    return r->draw(*state, desc, target, stats, error);
}

facet_result renderer_set_draw(renderer_set *set, const facet_render_desc *desc, film *target,
                               facet_render_stats *stats, facet_error *error)
{
    if (desc->sea)
        water_warn_of_eye(desc);
    TRY(draw(set, desc, target, stats, error));
    if (desc->sea)
        return describe_mattes_in_sea(set->scene, desc, target, error);
    TRY(describe_mattes(set->scene, desc, target, error));
    if (set->scene)
        check_image(set, renderer_get(desc->renderer)->poses_scene ? NULL : &set->prepared.pose, desc,
                    target);
    return FACET_OK;
}

/* ---- the light meter ---- */

enum {
    METER_SIZE = 128,   /* pixels along the longer edge */
    METER_SAMPLES = 16, /* per pixel, of path tracing */
};

/* The same view at a small size: path tracing, whose light the model blocks and reflects, meters itself, denoised; the
 * preview meters itself and OpenGL. A shadow on the ground is none of the model's light. Warnings are left to the image. */
static facet_render_desc meter_desc(const facet_render_desc *desc)
{
    facet_render_desc d = *desc;
    bool is_path = desc->renderer == FACET_RENDERER_KIND_PATH;
    double longer = d.width > d.height ? d.width : d.height;
    d.width = (uint32_t)ceil(METER_SIZE * d.width / longer);
    d.height = (uint32_t)ceil(METER_SIZE * d.height / longer);
    d.crop[0] = d.crop[1] = 0;
    d.crop[2] = d.width;
    d.crop[3] = d.height;
    d.part = (facet_part_desc){0};
    d.samples = is_path ? METER_SAMPLES : 1;
    d.quality = FACET_QUALITY_DRAFT;
    d.renderer = is_path ? FACET_RENDERER_KIND_PATH : FACET_RENDERER_KIND_PREVIEW;
    d.path = (facet_path_desc){.max_depth = desc->path.max_depth,
                               .clamp = desc->path.clamp,
                               .has_straight_shadows = desc->path.has_straight_shadows,
                               .denoises = true};
    d.energy = FACET_ENERGY_CONSERVING;
    d.ground = FACET_GROUND_NONE;
    d.exposure_ev = 0.0f;
    d.aovs = 0;
    d.log = (facet_log){0};
    d.progress = is_path ? desc->progress : (facet_progress){0}; /* for cancelling */
    return d;
}

static facet_result meter_scene(renderer_set *set, const facet_render_desc *desc, double *ev100,
                                facet_error *error)
{
    const facet_render_desc small = meter_desc(desc);
    facet_render_stats stats;
    film metered = {0};
    *ev100 = meter_exposure_ev(0.0); /* an exposure of 0 */
    facet_result result = film_create(&small.allocator, small.width, small.height, 0, &metered, error);
    if (result == FACET_OK)
        result = draw(set, &small, &metered, &stats, error);
    if (result == FACET_OK) {
        double average = film_meter(&metered);
        if (average > 0.0)
            *ev100 = meter_ev100(average);
        else
            log_warning(&desc->log, "%s: nothing visible to meter; exposure is 0 stops", set->scene->source);
    }
    film_destroy(&metered);
    return result;
}

facet_result renderer_set_meter(renderer_set *set, const facet_render_desc *desc, double *ev100,
                                facet_error *error)
{
    facet_camera camera;
    facet_render_desc d = *desc;
    if (desc->shading == FACET_SHADING_OGL1 && !desc->sea)
        return fail(error, FACET_ERROR_ARGUMENT,
                    "exposure: FACET_SHADING_OGL1 produces display values, which cannot be metered");
    if (!desc->camera) { /* with the exact proportions of the image */
        d.log = (facet_log){0};
        TRY(renderer_set_camera(set, &d, &camera, error));
        d.log = desc->log;
        d.camera = &camera;
    }
    return desc->sea ? water_meter(&set->water, &d, ev100, error) : meter_scene(set, &d, ev100, error);
}
