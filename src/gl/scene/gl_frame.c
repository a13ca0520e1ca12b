/* gl_frame.c - see gl_frame.h. */
#include "gl/scene/gl_frame.h"

#include <math.h>
#include <string.h>

#include "base/clock.h"
#include "base/result.h"
#include "gl/core/gl_api.h"
#include "gl/scene/gl_camera.h"
#include "gl/scene/gl_frame_block.h"
#include "gl/gl_entry.h"
#include "shade/lang/lang_c_load.h"

/* ---- lifetime ---- */

facet_result gl_frame_create(gl_frame *f, gl_context *context, const facet_scene *scene,
                             const facet_allocator *allocator, facet_error *error)
{
    *f = (gl_frame){.context = context, .timers.context = context, .rays.context = context};
    f->rays.allocator = allocator ? *allocator : (facet_allocator){0};
    TRY(gl_programs_create(context, allocator, NULL, &f->programs, error));
    TRY(gl_mesh_create(context, allocator, &f->meshes, error));
    TRY(gl_material_create(context, scene, allocator, &f->materials, error));
    TRY(gl_light_create(context, allocator, &f->light, error));
    TRY(gl_transparency_create(context, allocator, &f->transparency, error));
    glGenBuffers(1, &f->frame_buffer);
    glGenVertexArrays(1, &f->empty_array);
    return FACET_OK;
}

void gl_frame_destroy(gl_frame *f)
{
    if (!f->context)
        return;
    gl_timers_destroy(&f->timers);
    gl_pyramid_destroy(&f->bloom);
    gl_phong_destroy(f->phong);
    gl_pyramid_destroy(&f->opaque);
    gl_rays_destroy(&f->rays);
    gl_glass_destroy(&f->glass);
    gl_transparency_destroy(f->transparency);
    gl_light_destroy(f->light);
    gl_material_destroy(f->materials);
    gl_mesh_destroy(f->meshes);
    gl_programs_destroy(f->programs);
    glDeleteBuffers(1, &f->frame_buffer);
    glDeleteVertexArrays(1, &f->empty_array);
    *f = (gl_frame){.context = NULL};
}

/* ---- programs ---- */

/* What surfaces put out: radiance, AOVs, or the light that rays through glass find. */
typedef enum output { OUTPUT_RADIANCE, OUTPUT_LAYERS, OUTPUT_TRACED } output;

static gl_program_key key_of(const gl_frame *f, const gl_batch *batch, output what)
{
    uint64_t features = gl_material_features(f->materials, batch) | gl_mesh_features(f->meshes, batch) |
                        gl_light_features(f->light) | f->display_features;
    if (what == OUTPUT_LAYERS)
        features |= gl_program_feature(GL_MAIN_SURFACE, "AOVS");
    else if (f->is_traced && batch->plan->lets_rays_through)
        features |= gl_rays_features(&f->rays, what == OUTPUT_TRACED);
    return (gl_program_key){gl_material_main(f->materials, batch), features};
}

static gl_transparency_view transparency_of(const gl_frame *f, const facet_render_desc *desc)
{
    return (gl_transparency_view){.mode = desc->gl.transparency,
                                  .programs = f->programs,
                                  .materials = f->materials,
                                  .meshes = f->meshes,
                                  .scene = f->scene,
                                  .features = gl_light_features(f->light),
                                  .thread_count = desc->thread_count};
}

static facet_result request_batches(gl_frame *f, output what, facet_error *error)
{
    gl_pass end = what == OUTPUT_LAYERS ? GL_PASS_COUNT : GL_PASS_BLENDED;
    for (gl_pass pass = what == OUTPUT_TRACED ? GL_PASS_TRANSMISSIVE : GL_PASS_OPAQUE; pass < end; pass++) {
        uint32_t count;
        const gl_batch *batches = gl_mesh_batches(f->meshes, pass, &count);
        for (uint32_t i = 0; i < count; i++)
            TRY(gl_programs_request(f->programs, key_of(f, &batches[i], what), error));
    }
    return FACET_OK;
}

static bool has_rays(const gl_frame *f)
{
    return f->is_traced && f->rays.is_ready;
}

static facet_result request_image(gl_frame *f, facet_error *error)
{
    if (has_rays(f))
        TRY(request_batches(f, OUTPUT_TRACED, error));
    return request_batches(f, OUTPUT_RADIANCE, error);
}

/* The other programs of glass, which a window needs when its motion begins or ends. */
static facet_result request_other_glass(gl_frame *f, facet_error *error)
{
    if (f->use == GL_FRAME_IMAGE || !f->rays.is_ready)
        return FACET_OK;
    f->is_traced = !f->is_traced;
    facet_result result = request_image(f, error);
    f->is_traced = !f->is_traced;
    return result;
}

/* Requests all programs before waiting for the first, so that the driver compiles them in parallel. */
static facet_result request_programs(gl_frame *f, const facet_render_desc *desc, facet_error *error)
{
    gl_programs_set_log(f->programs, &desc->log);
    gl_transparency_view blended = transparency_of(f, desc);
    TRY(request_other_glass(f, error));
    TRY(request_image(f, error));
    TRY(gl_transparency_request(f->transparency, &blended, error));
    if (desc->aovs)
        TRY(request_batches(f, OUTPUT_LAYERS, error));
    if (desc->background == FACET_BACKGROUND_ENVIRONMENT) {
        gl_program_key key = {GL_MAIN_BACKGROUND, gl_light_background_features(f->light, desc)};
        TRY(gl_programs_request(f->programs, key, error));
    }
    return gl_light_request_programs(f->light, f->programs, error);
}

static facet_result update_phong(gl_frame *f, const gl_phong_view *view, facet_error *error)
{
    gl_material_use_phong(f->materials, NULL);
    if (view->render->shading != FACET_SHADING_OGL1)
        return FACET_OK;
    if (!f->phong)
        TRY(gl_phong_create(f->context, view->scene->scene, &view->scene->allocator, &f->phong, error));
    TRY(gl_phong_update(f->phong, view, error));
    gl_material_use_phong(f->materials, f->phong);
    return FACET_OK;
}

static bool has_pass(const gl_frame *f, gl_pass pass)
{
    uint32_t count;
    gl_mesh_batches(f->meshes, pass, &count);
    return count > 0;
}

/* Whether nothing but the model and a uniform background is in the image: no ground, no bloom. */
static bool is_model_alone(const gl_frame *f, const facet_render_desc *desc)
{
    return desc->background != FACET_BACKGROUND_ENVIRONMENT && desc->shading != FACET_SHADING_OGL1 &&
           gl_channel_is_light(desc->gl.channel) && !gl_light_has_ground(f->light) &&
           !(desc->gl.bloom > 0.0f);
}

static uint64_t find_display_features(const gl_frame *f, const facet_render_desc *desc)
{
    bool is_displayed = f->use == GL_FRAME_CANVAS && is_model_alone(f, desc) &&
                        !has_pass(f, GL_PASS_TRANSMISSIVE) && !has_pass(f, GL_PASS_BLENDED);
    return is_displayed ? gl_program_display_features(desc->tonemap) : 0;
}

gl_target_kind gl_frame_window_kind(const gl_frame *f)
{
    return f->display_features ? GL_TARGET_DISPLAY : GL_TARGET_WINDOW;
}

/* Since the frame was created. */
static uint64_t count_decoded_texels(const gl_frame *f)
{
    return gl_material_decoded_texels(f->materials) + (f->phong ? gl_phong_decoded_texels(f->phong) : 0);
}

/* Rays through glass take seconds where the driver draws on the CPU: a window there keeps to drafts. */
static bool traces_rays(const gl_frame *f, const facet_render_desc *desc)
{
    static const char *const on_cpu[] = {"llvmpipe", "softpipe", "SwiftShader"};
    for (size_t i = 0; i < sizeof on_cpu / sizeof *on_cpu; i++)
        if (f->use != GL_FRAME_IMAGE && strstr(f->context->name, on_cpu[i]))
            return false;
    return desc->quality != FACET_QUALITY_DRAFT;
}

facet_result gl_frame_update(gl_frame *f, const gl_scene *scene, const camera_rays *camera,
                             const facet_render_desc *desc, facet_render_stats *stats, facet_error *error)
{
    double start = clock_seconds();
    light_setup light = {0};
    f->scene = scene;
    facet_result result =
        light_setup_create(&scene->geometries, &scene->pose, camera, desc, false, &light, error);
    if (result == FACET_OK)
        result =
            gl_light_update(f->light, &light, desc, scene->pose.bounds_min, scene->pose.bounds_max, error);
    if (result == FACET_OK && gl_channel_is_light(desc->gl.channel))
        light_setup_warn_dark(&light, &scene->geometries, desc);
    stats->light_s += clock_seconds() - start;
    start = clock_seconds();
    if (result == FACET_OK)
        result = gl_mesh_update(f->meshes, scene, &desc->log, error);
    stats->geometry_s += clock_seconds() - start;
    start = clock_seconds();
    uint64_t decoded_texels = count_decoded_texels(f);
    if (result == FACET_OK)
        result = gl_material_update(f->materials, f->meshes, desc, error);
    if (result == FACET_OK)
        result = update_phong(f, &(gl_phong_view){scene, camera, &light, f->meshes, desc}, error);
    f->is_traced = traces_rays(f, desc);
    if (result == FACET_OK)
        result = gl_rays_update(&f->rays, scene, f->materials,
                                f->is_traced && has_pass(f, GL_PASS_TRANSMISSIVE), &desc->log, error);
    light_setup_destroy(&light);
    stats->textures_s += clock_seconds() - start;
    stats->decoded_texels += count_decoded_texels(f) - decoded_texels;
    if (result == FACET_OK) {
        f->display_features = find_display_features(f, desc);
        result = request_programs(f, desc, error);
    }
    gl_timers_begin(&f->timers, GL_TIMER_SHADOWS);
    if (result == FACET_OK)
        result = gl_light_draw_shadows(f->light, f->programs, f->meshes, f->materials, camera->origin,
                                       scene->revision, error);
    gl_timers_end(&f->timers);
    return result == FACET_OK ? gl_context_check(f->context, "the scene", error) : result;
}

uint32_t gl_frame_max_samples(const gl_frame *f, const facet_render_desc *desc)
{
    return gl_transparency_max_samples(f->context, desc->gl.transparency, f->meshes);
}

/* ---- passes ---- */

static facet_result draw_batches(gl_frame *f, gl_pass pass, output what, facet_error *error)
{
    uint32_t count;
    const gl_batch *batches = gl_mesh_batches(f->meshes, pass, &count);
    for (uint32_t i = 0; i < count; i++) {
        if (batches[i].is_outside)
            continue;
        TRY(gl_material_use(f->materials, f->programs, &batches[i], key_of(f, &batches[i], what).features,
                            error));
        gl_mesh_draw(f->meshes, &batches[i]);
    }
    return FACET_OK;
}

/* Draws a full-screen pass. */
static facet_result draw_screen(gl_frame *f, gl_main main, uint64_t features, facet_error *error)
{
    uint32_t program;
    TRY(gl_programs_get(f->programs, (gl_program_key){main, features}, &program, error));
    glUseProgram(program);
    glBindVertexArray(f->empty_array);
    glDrawArrays(GL_TRIANGLES, 0, 3);
    return FACET_OK;
}

static void begin(gl_frame *f, const gl_target *target, const facet_render_desc *desc, gl_frame_block *block)
{
    gl_frame_fill_block(f, desc, block);
    block->has_coverage = target->samples > 1 && gl_material_has_coverage(f->context);
    gl_frame_set_block(f, block);
    gl_mesh_order(f->meshes, block, f->materials, gl_material_features);
    glBindFramebuffer(GL_FRAMEBUFFER, target->framebuffer);
    glViewport(0, 0, (GLsizei)target->width, (GLsizei)target->height);
    glDisable(GL_SCISSOR_TEST);
    glDisable(GL_BLEND);
    glEnable(GL_DEPTH_TEST);
    glDepthMask(GL_TRUE);
    glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    gl_frame_set_clear_color(f, block);
    gl_camera_begin_depth(f->context);
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
}

static facet_result draw_pass(gl_frame *f, gl_pass pass, gl_timer timer, facet_error *error)
{
    gl_timers_begin(&f->timers, timer);
    facet_result result = draw_batches(f, pass, OUTPUT_RADIANCE, error);
    gl_timers_end(&f->timers);
    return result;
}

static facet_result draw_blended(gl_frame *f, const gl_target *target, const facet_render_desc *desc,
                                 const gl_frame_block *block, facet_error *error)
{
    gl_transparency_view view = transparency_of(f, desc);
    view.target = target;
    view.frame = block;
    gl_timers_begin(&f->timers, GL_TIMER_BLENDED);
    facet_result result = gl_transparency_draw(f->transparency, &view, error);
    gl_timers_end(&f->timers);
    return result;
}

static facet_result draw_background(gl_frame *f, const facet_render_desc *desc, facet_error *error)
{
    if (desc->background != FACET_BACKGROUND_ENVIRONMENT || !gl_channel_is_light(desc->gl.channel))
        return FACET_OK;
    gl_timers_begin(&f->timers, GL_TIMER_BACKGROUND);
    glDisable(GL_CULL_FACE);
    facet_result result =
        draw_screen(f, GL_MAIN_BACKGROUND, gl_light_background_features(f->light, desc), error);
    gl_timers_end(&f->timers);
    return result;
}

/* Drawn behind the model, which stands on it. */
static facet_result draw_ground(gl_frame *f, const facet_render_desc *desc, facet_error *error)
{
    if (!gl_light_has_ground(f->light) || !gl_channel_is_light(desc->gl.channel))
        return FACET_OK;
    gl_timers_begin(&f->timers, GL_TIMER_BACKGROUND);
    glDisable(GL_CULL_FACE);
    glEnable(GL_BLEND);
    glBlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
    glDepthMask(GL_FALSE);
    gl_light_bind_ground(f->light);
    facet_result result = draw_screen(f, GL_MAIN_GROUND, gl_light_ground_features(f->light), error);
    glDepthMask(GL_TRUE);
    glDisable(GL_BLEND);
    gl_timers_end(&f->timers);
    return result;
}

/* Copies the opaque surfaces for transmissive ones. */
static facet_result take_opaque(gl_frame *f, const gl_target *target, facet_error *error)
{
    const gl_pyramid_brush brush = {f->programs, f->empty_array};
    gl_timers_begin(&f->timers, GL_TIMER_TRANSMISSION);
    facet_result result = gl_pyramid_take_opaque(&f->opaque, f->context, &brush, target, error);
    gl_timers_end(&f->timers);
    return result;
}

/* Transmissive surfaces show radiance also where a single lobe is displayed; the opaque surfaces are then
 * drawn twice. */
static facet_result draw_opaque(gl_frame *f, const gl_target *target, const facet_render_desc *desc,
                                facet_error *error)
{
    facet_channel channel = desc->gl.channel;
    bool takes = has_pass(f, GL_PASS_TRANSMISSIVE) && gl_channel_is_light(channel);
    gl_material_show(f->materials, takes ? FACET_CHANNEL_LIGHT : channel);
    facet_result result = draw_pass(f, GL_PASS_OPAQUE, GL_TIMER_OPAQUE, error);
    if (result == FACET_OK && takes)
        result = take_opaque(f, target, error);
    if (result != FACET_OK || !takes || channel == FACET_CHANNEL_LIGHT)
        return result;
    gl_material_show(f->materials, channel);
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    return draw_pass(f, GL_PASS_OPAQUE, GL_TIMER_OPAQUE, error);
}

/* Traces the rays behind the nearest glass of each pixel. */
static facet_result trace_rays(gl_frame *f, const gl_target *target, facet_error *error)
{
    facet_result result = gl_glass_begin(&f->glass, f->context, target, error);
    for (gl_pass pass = GL_PASS_OPAQUE; pass <= GL_PASS_TRANSMISSIVE && result == FACET_OK; pass++)
        result = gl_rays_draw_depth(f->programs, f->meshes, f->materials, pass, error);
    gl_rays_bind(&f->rays);
    if (result == FACET_OK)
        result = draw_batches(f, GL_PASS_TRANSMISSIVE, OUTPUT_TRACED, error);
    gl_glass_end(&f->glass, target);
    return result;
}

/* Drawn after the opaque surfaces, a copy of which they look up. */
static facet_result draw_transmissive(gl_frame *f, const gl_target *target, facet_error *error)
{
    if (!has_pass(f, GL_PASS_TRANSMISSIVE))
        return FACET_OK;
    gl_pyramid_bind_opaque(&f->opaque);
    if (has_rays(f)) {
        gl_timers_begin(&f->timers, GL_TIMER_TRANSMISSION);
        facet_result result = trace_rays(f, target, error);
        gl_timers_end(&f->timers);
        TRY(result);
        TRY(gl_rays_draw_depth(f->programs, f->meshes, f->materials, GL_PASS_TRANSMISSIVE, error));
    }
    return draw_pass(f, GL_PASS_TRANSMISSIVE, GL_TIMER_TRANSMISSION, error);
}

static facet_result draw_bloom(gl_frame *f, const gl_target *target, const facet_render_desc *desc,
                               facet_error *error)
{
    if (!(desc->gl.bloom > 0.0f) || !gl_channel_is_light(desc->gl.channel))
        return FACET_OK;
    gl_timers_begin(&f->timers, GL_TIMER_BLOOM);
    const gl_pyramid_brush brush = {f->programs, f->empty_array};
    facet_result result =
        gl_pyramid_bloom(&f->bloom, f->context, &brush, target, fminf(desc->gl.bloom, 1.0f), error);
    gl_timers_end(&f->timers);
    return result;
}

/* Resolves the part of the image that is not empty. */
static void resolve(gl_frame *f, const gl_target *target, const facet_render_desc *desc,
                    const gl_frame_block *block)
{
    gl_timers_begin(&f->timers, GL_TIMER_RESOLVE);
    memcpy(f->area, (int[4]){0, 0, (int)target->width, (int)target->height}, sizeof f->area);
    if (f->use != GL_FRAME_IMAGE && desc->background == FACET_BACKGROUND_TRANSPARENT &&
        is_model_alone(f, desc))
        gl_mesh_area(f->meshes, block, gl_context_is_top_down(f->context), target->width, target->height,
                     f->area);
    if (!f->display_features)
        gl_target_resolve_area(target, f->area);
    gl_timers_end(&f->timers);
}

facet_result gl_frame_draw(gl_frame *f, const gl_target *target, const facet_render_desc *desc,
                           gl_frame_block *block, facet_error *error)
{
    begin(f, target, desc, block);
    facet_result result = draw_opaque(f, target, desc, error);
    if (result == FACET_OK)
        result = draw_transmissive(f, target, error);
    if (result == FACET_OK)
        result = draw_background(f, desc, error);
    if (result == FACET_OK)
        result = draw_ground(f, desc, error);
    if (result == FACET_OK)
        result = draw_blended(f, target, desc, block, error);
    gl_camera_end_depth(f->context);
    resolve(f, target, desc, block);
    const gl_pyramid_brush brush = {f->programs, f->empty_array};
    if (result == FACET_OK && desc->shading == FACET_SHADING_OGL1)
        result = gl_phong_linearize(f->phong, &brush, target, error);
    if (result == FACET_OK)
        result = draw_bloom(f, target, desc, error);
    return result;
}

facet_result gl_frame_draw_layers(gl_frame *f, const gl_target *target, const facet_render_desc *desc,
                                  gl_frame_block *block, facet_error *error)
{
    begin(f, target, desc, block);
    gl_timers_begin(&f->timers, GL_TIMER_LAYERS);
    facet_result result = FACET_OK;
    for (gl_pass pass = GL_PASS_OPAQUE; pass < GL_PASS_COUNT && result == FACET_OK; pass++)
        result = draw_batches(f, pass, OUTPUT_LAYERS, error);
    gl_timers_end(&f->timers);
    gl_camera_end_depth(f->context);
    return result;
}

/* Clears the window around the area that was drawn, which is to be scissored. (x, y): corner of the window. */
static void clear_around(const gl_frame *f, const gl_target *target, int x, int y)
{
    bool is_top_down = gl_context_is_top_down(f->context);
    int bottom = is_top_down ? (int)target->height - f->area[1] - f->area[3] : f->area[1];
    glEnable(GL_SCISSOR_TEST);
    if (f->area[2] != (int)target->width || f->area[3] != (int)target->height) {
        glScissor(x, y, (GLsizei)target->width, (GLsizei)target->height);
        glClearColor(0.0f, 0.0f, 0.0f, 0.0f);
        glClear(GL_COLOR_BUFFER_BIT);
    }
    glScissor(x + f->area[0], y + bottom, f->area[2], f->area[3]);
}

static facet_result tone_map(gl_frame *f, const gl_target *target, const facet_render_desc *desc, int x,
                             int y, facet_error *error)
{
    gl_frame_block block = {.size = {(float)target->width, (float)target->height, (float)x, (float)y}};
    gl_frame_fill_block(f, desc, &block);
    gl_frame_set_block(f, &block);
    glActiveTexture(GL_TEXTURE0);
    glBindTexture(GL_TEXTURE_2D, target->color);
    glDisable(GL_DEPTH_TEST);
    glDisable(GL_CULL_FACE);
    glDisable(GL_BLEND);
    glViewport(x, y, (GLsizei)target->width, (GLsizei)target->height);
    uint64_t features = gl_program_present_features(
        f->context, gl_channel_is_light(desc->gl.channel) ? desc->tonemap : FACET_TONEMAP_NONE);
    return draw_screen(f, GL_MAIN_PRESENT, features, error);
}

facet_result gl_frame_present(gl_frame *f, const gl_target *target, const facet_render_desc *desc,
                              uint32_t framebuffer, int x, int y, facet_error *error)
{
    facet_result result = FACET_OK;
    gl_timers_begin(&f->timers, GL_TIMER_PRESENT);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    clear_around(f, target, x, y);
    if (f->display_features)
        gl_target_resolve_into(target, framebuffer, f->area);
    else
        result = tone_map(f, target, desc, x, y, error);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    glDisable(GL_SCISSOR_TEST);
    gl_timers_end(&f->timers);
    return result;
}
