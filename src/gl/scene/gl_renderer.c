/* gl_renderer.c - see gl_renderer.h: resources that are kept from image to image, and recovery from errors. */
#include "gl/scene/gl_renderer.h"

#include <stdio.h>

#include "base/clock.h"
#include "base/memory.h"
#include "base/result.h"
#include "gl/core/gl_api.h"
#include "gl/scene/gl_camera.h"
#include "gl/scene/gl_film.h"
#include "gl/scene/gl_frame.h"
#include "scene/scene.h"

#include "draw/ogl1_setup.h"

struct gl_renderer {
    facet_allocator allocator;
    gl_context own, *context; /* own: {0} before its creation or after its loss */
    gl_scene prepared;
    gl_frame frame;
    gl_target target;
    gl_times times;
    bool has_reported_driver;
};

/* ---- lifetime ---- */

/* Releases all GPU memory and the renderer's own context; the next image creates a new one. */
static void stop(gl_renderer *r)
{
    gl_context spare = {.context = NULL};
    bool is_own = r->context == &r->own, has_context = !is_own || r->own.context;
    if (has_context && gl_context_make_current_to_delete(r->context, &spare)) {
        gl_frame_destroy(&r->frame);
        gl_target_destroy(&r->target);
    }
    gl_context_destroy(&spare);
    r->has_reported_driver = false;
    if (is_own)
        gl_context_destroy(&r->own);
}

/* Makes the context current and creates what depends on it. */
static facet_result start(gl_renderer *r, facet_error *error)
{
    bool is_own = r->context == &r->own;
    if (is_own && r->own.is_lost)
        stop(r);
    if (r->prepared.content_revision != r->prepared.scene->content_revision) { /* the scene has changed */
        stop(r);
        gl_scene_clear(&r->prepared);
    }
    facet_result result = is_own && !r->own.context ? gl_context_create(&r->own, error)
                                                    : gl_context_make_current(r->context, error);
    if (result == FACET_OK && !r->frame.context)
        result = gl_frame_create(&r->frame, r->context, r->prepared.scene, &r->allocator, error);
    if (result != FACET_OK)
        stop(r);
    return result;
}

facet_result gl_renderer_create(const facet_scene *scene, gl_context *context,
                                const facet_allocator *allocator, gl_renderer **out, facet_error *error)
{
    gl_renderer *r = mem_zalloc(allocator, 1, sizeof *r);
    *out = NULL;
    if (!r)
        return fail_memory(error, "renderer", sizeof *r);
    r->allocator = allocator ? *allocator : (facet_allocator){0};
    r->context = context ? context : &r->own;
    gl_scene_init(&r->prepared, scene, &r->allocator);
    facet_result result = start(r, error);
    if (result != FACET_OK) {
        gl_renderer_destroy(r);
        return result;
    }
    gl_context_release(r->context);
    *out = r;
    return FACET_OK;
}

void gl_renderer_destroy(gl_renderer *r)
{
    if (!r)
        return;
    stop(r);
    gl_scene_clear(&r->prepared);
    mem_free(r);
}

/* ---- an image ---- */

/* Resolves combinations: OpenGL 1 has no shadows, and channels are those of glTF materials. */
static facet_render_desc settle(const facet_render_desc *desc)
{
    facet_render_desc settled = *desc;
    if (desc->gl.channel != FACET_CHANNEL_LIGHT)
        settled.shading = FACET_SHADING_GLTF;
    if (settled.shading == FACET_SHADING_OGL1)
        settled.gl.has_shadows = false;
    return settled;
}

/* Rays of desc's camera, or of one that frames the whole scene. */
static facet_result make_camera(gl_renderer *r, const facet_render_desc *desc, camera_rays *rays,
                                facet_error *error)
{
    facet_camera fitted;
    facet_orbit orbit = scene_orbit_default();
    orbit.log = desc->log;
    facet_result result = FACET_OK;
    if (!desc->camera)
        result = scene_fit_pose(r->prepared.scene, &r->prepared.pose, &orbit,
                                (float)desc->width / (float)desc->height, desc->thread_count, &fitted, error);
    return result == FACET_OK ? camera_rays_create(desc->camera ? desc->camera : &fitted, desc->width,
                                                   desc->height, rays, error)
                              : result;
}

/* Everything before drawing: the pose and its uploads. */
static facet_result prepare(gl_renderer *r, const facet_render_desc *desc, gl_frame_use use,
                            camera_rays *camera, double deadline_s, facet_render_stats *stats,
                            facet_error *error)
{
    double begin = clock_seconds();
    facet_result result = render_check_limits(desc, "prepare", 0.0, deadline_s, error);
    if (result == FACET_OK)
        result = ogl1_check(r->prepared.scene, desc, error);
    if (result == FACET_OK)
        result = gl_scene_update(&r->prepared, desc, error);
    if (result == FACET_OK)
        result = make_camera(r, desc, camera, error);
    stats->geometry_s += clock_seconds() - begin;
    r->frame.use = use;
    if (result == FACET_OK)
        result = gl_frame_update(&r->frame, &r->prepared, camera, desc, stats, error);
    if (result == FACET_OK)
        result = render_check_limits(desc, "shade", 0.0, deadline_s, error);
    return result;
}

/* Once per context. */
static void report_driver(gl_renderer *r, const facet_log *log)
{
    char line[sizeof r->context->name + 16];
    if (r->has_reported_driver || !log->message)
        return;
    snprintf(line, sizeof line, "OpenGL: %s", r->context->name);
    log->message(log->user, FACET_LOG_LEVEL_DETAIL, line);
    r->has_reported_driver = true;
}

/* Of gl_film_desc: what a view of the scene takes. */
typedef struct scene_view {
    gl_renderer *renderer;
    const camera_rays *camera;
    const facet_render_desc *desc;
} scene_view;

static void set_camera(const gl_renderer *r, const camera_rays *camera, const facet_render_desc *desc,
                       const gl_view *view, gl_frame_block *block)
{
    *block = (gl_frame_block){.is_draft = desc->quality == FACET_QUALITY_DRAFT};
    gl_camera_set(r->context, camera, r->prepared.pose.bounds_min, r->prepared.pose.bounds_max, desc->width,
                  desc->height, view, block);
}

static facet_result draw_view(void *self, const gl_target *target, const gl_view *view, facet_error *error)
{
    const scene_view *v = self;
    gl_frame_block block;
    set_camera(v->renderer, v->camera, v->desc, view, &block);
    return gl_frame_draw(&v->renderer->frame, target, v->desc, &block, error);
}

static facet_result draw_layers(void *self, const gl_target *target, const gl_view *view, facet_error *error)
{
    const scene_view *v = self;
    gl_frame_block block;
    set_camera(v->renderer, v->camera, v->desc, view, &block);
    return gl_frame_draw_layers(&v->renderer->frame, target, v->desc, &block, error);
}

static facet_result draw_film(gl_renderer *r, const facet_render_desc *desc, const camera_rays *camera,
                              double deadline_s, film *target, facet_error *error)
{
    scene_view view = {r, camera, desc};
    scene_identity *identities = NULL;
    if (desc->aovs & SCENE_IDENTITY_AOVS)
        TRY(scene_identities_create(r->prepared.scene, &r->prepared.pose, &desc->allocator, &identities,
                                    error));
    const gl_film_desc drawn = {
        .context = r->context,
        .render = desc,
        .target = &r->target,
        .sampling = gl_sampling_plan(desc->samples, desc->quality, gl_frame_max_samples(&r->frame, desc)),
        .looks_around = r->prepared.plans.lets_rays_through || desc->gl.bloom > 0.0f,
        .deadline_s = deadline_s,
        .identities = identities,
        .identity_count = r->prepared.geometries.count,
        .self = &view,
        .draw = draw_view,
        .draw_layers = draw_layers};
    facet_result result = gl_film_draw(&drawn, target, error);
    mem_free(identities);
    return result;
}

static facet_result attempt(gl_renderer *r, const facet_render_desc *desc, double deadline_s, film *target,
                            facet_render_stats *stats, facet_error *error)
{
    camera_rays camera;
    *stats = (facet_render_stats){.thread_count = desc->thread_count};
    facet_result result = start(r, error);
    if (result == FACET_OK)
        report_driver(r, &desc->log);
    if (result == FACET_OK)
        result = prepare(r, desc, GL_FRAME_IMAGE, &camera, deadline_s, stats, error);
    double begin = clock_seconds();
    if (result == FACET_OK)
        result = draw_film(r, desc, &camera, deadline_s, target, error);
    if (result == FACET_OK) {
        r->times = gl_timers_finish(&r->frame.timers, true);
        result = render_check_limits(desc, "shade", 1.0, 0.0, error);
    }
    stats->shade_s += clock_seconds() - begin;
    return result;
}

facet_result gl_renderer_render(gl_renderer *r, const facet_render_desc *wanted, film *target,
                                facet_render_stats *stats, facet_error *error)
{
    const facet_render_desc settled = settle(wanted), *desc = &settled;
    double begin = clock_seconds();
    double deadline_s = desc->time_limit_s > 0.0 ? begin + desc->time_limit_s : 0.0;
    bool was_used = r->prepared.revision > 0;
    facet_result result = attempt(r, desc, deadline_s, target, stats, error);
    if (result == FACET_ERROR_MEMORY && was_used) { /* again, without what earlier images left in memory */
        stop(r);
        gl_scene_clear(&r->prepared);
        result = attempt(r, desc, deadline_s, target, stats, error);
    }
    if (result == FACET_ERROR_MEMORY || r->context->is_lost)
        stop(r);
    gl_context_release(r->context);
    stats->total_s = clock_seconds() - begin;
    return result;
}

gl_context *gl_renderer_get_context(gl_renderer *r)
{
    return r->context;
}

gl_times gl_renderer_get_times(const gl_renderer *r)
{
    return r->times;
}

/* ---- a window's frame ---- */

facet_result gl_renderer_present(gl_renderer *r, const facet_render_desc *wanted, uint32_t framebuffer, int x,
                                 int y, facet_render_stats *stats, facet_error *error)
{
    const facet_render_desc settled = settle(wanted), *desc = &settled;
    camera_rays camera;
    gl_frame_block block;
    gl_frame_use use = r->context->is_canvas && x == 0 && y == 0 ? GL_FRAME_CANVAS : GL_FRAME_WINDOW;
    *stats = (facet_render_stats){.thread_count = desc->thread_count};
    if (!desc->width || !desc->height)
        return FACET_OK; /* a window that is reduced to its title bar */
    facet_result result = start(r, error);
    if (result == FACET_OK)
        result = prepare(r, desc, use, &camera, 0.0, stats, error);
    double begin = clock_seconds();
    uint32_t most = result == FACET_OK ? gl_frame_max_samples(&r->frame, desc) : 1;
    gl_sampling sampling = gl_sampling_plan(desc->samples ? desc->samples : 4, FACET_QUALITY_NORMAL, most);
    if (result == FACET_OK)
        result = gl_target_update(&r->target, r->context, gl_frame_window_kind(&r->frame), desc->width,
                                  desc->height, sampling.samples, error);
    if (result == FACET_OK) {
        const gl_view all = {.scale = 1, .width = desc->width, .height = desc->height};
        set_camera(r, &camera, desc, &all, &block);
        result = gl_frame_draw(&r->frame, &r->target, desc, &block, error);
    }
    if (result == FACET_OK)
        result = gl_frame_present(&r->frame, &r->target, desc, framebuffer, x, y, error);
    if (result == FACET_OK) {
        r->times = gl_timers_finish(&r->frame.timers, false);
        result = gl_context_check(r->context, "the window", error);
    }
    stats->shade_s += clock_seconds() - begin;
    return result;
}
