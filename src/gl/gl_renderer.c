/* gl_renderer.c - see gl_renderer.h: the order in which a picture is made. */
#include "gl/gl_renderer.h"

#include <epoxy/gl.h>
#include <math.h>
#include <string.h>

#include "base/clock.h"
#include "base/memory.h"
#include "base/result.h"
#include "draw/camera_rays.h"
#include "gl/gl_camera.h"
#include "gl/gl_light.h"
#include "gl/gl_material.h"
#include "gl/gl_scene.h"
#include "gl/gl_target.h"

struct gl_renderer {
    facet_allocator allocator;
    gl_context own, *context;
    gl_programs *programs;
    gl_mesh_set *meshes;
    gl_material_set *materials;
    gl_light *light;
    gl_target target;
    GLuint frame_buffer, empty_array;
    gl_scene prepared;
};

/* ---- what is prepared ---- */

facet_result gl_renderer_create(const facet_scene *scene, gl_context *context,
                                const facet_allocator *allocator, gl_renderer **out, facet_error *error)
{
    gl_renderer *r = mem_zalloc(allocator, 1, sizeof *r);
    *out = NULL;
    if (!r)
        return fail_memory(error, "renderer", sizeof *r);
    r->allocator = allocator ? *allocator : (facet_allocator){0};
    gl_scene_init(&r->prepared, scene, &r->allocator);
    facet_result result = FACET_OK;
    r->context = context;
    if (!context) {
        result = gl_context_create(&r->own, error);
        r->context = &r->own;
    }
    if (result == FACET_OK)
        result = gl_programs_create(r->context, &r->allocator, NULL, &r->programs, error);
    if (result == FACET_OK)
        result = gl_mesh_create(r->context, &r->allocator, &r->meshes, error);
    if (result == FACET_OK)
        result = gl_material_create(r->context, scene, &r->allocator, &r->materials, error);
    if (result == FACET_OK)
        result = gl_light_create(r->context, &r->allocator, &r->light, error);
    if (result != FACET_OK) {
        gl_renderer_destroy(r);
        return result;
    }
    glGenBuffers(1, &r->frame_buffer);
    glGenVertexArrays(1, &r->empty_array);
    *out = r;
    return FACET_OK;
}

void gl_renderer_destroy(gl_renderer *r)
{
    if (!r)
        return;
    if (gl_context_make_current(r->context, NULL) == FACET_OK && (r->own.context || r->context != &r->own)) {
        gl_light_destroy(r->light);
        gl_material_destroy(r->materials);
        gl_mesh_destroy(r->meshes);
        gl_programs_destroy(r->programs);
        gl_target_destroy(&r->target);
        glDeleteBuffers(1, &r->frame_buffer);
        glDeleteVertexArrays(1, &r->empty_array);
    }
    gl_scene_clear(&r->prepared);
    gl_context_destroy(&r->own);
    mem_free(r);
}

/* ---- a picture ---- */

static facet_result draw_batches(gl_renderer *r, gl_pass pass, facet_error *error)
{
    uint32_t count;
    const gl_batch *batches = gl_mesh_batches(r->meshes, pass, &count);
    for (uint32_t i = 0; i < count; i++) {
        uint32_t program;
        if (batches[i].is_outside)
            continue;
        gl_program_key key = {GL_MAIN_SURFACE, batches[i].features | gl_light_features(r->light)};
        facet_result result = gl_programs_get(r->programs, key, &program, error);
        if (result != FACET_OK)
            return result;
        glUseProgram(program);
        gl_material_bind(r->materials, &batches[i]);
        gl_mesh_draw(r->meshes, &batches[i]);
    }
    return FACET_OK;
}

static facet_result draw_screen(gl_renderer *r, gl_main main, uint64_t features, facet_error *error)
{
    uint32_t program;
    facet_result result = gl_programs_get(r->programs, (gl_program_key){main, features}, &program, error);
    if (result != FACET_OK)
        return result;
    glUseProgram(program);
    glBindVertexArray(r->empty_array);
    glDrawArrays(GL_TRIANGLES, 0, 3);
    return FACET_OK;
}

static facet_result draw(gl_renderer *r, const facet_render_desc *desc, const gl_frame_block *block,
                         facet_error *error)
{
    glBindBuffer(GL_UNIFORM_BUFFER, r->frame_buffer);
    glBufferData(GL_UNIFORM_BUFFER, sizeof *block, block, GL_DYNAMIC_DRAW);
    glBindBufferBase(GL_UNIFORM_BUFFER, GL_BLOCK_FRAME, r->frame_buffer);
    glBindFramebuffer(GL_FRAMEBUFFER, r->target.framebuffer);
    glViewport(0, 0, (GLsizei)r->target.width, (GLsizei)r->target.height);
    glClearColor(0.0f, 0.0f, 0.0f, 0.0f);
    gl_camera_begin_depth(r->context);
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    glEnable(GL_DEPTH_TEST);
    glDisable(GL_BLEND);
    facet_result result = draw_batches(r, GL_PASS_OPAQUE, error);
    if (result == FACET_OK && desc->background == FACET_BACKGROUND_ENVIRONMENT)
        result = draw_screen(r, GL_MAIN_BACKGROUND, gl_light_background_features(r->light, desc), error);
    if (result == FACET_OK)
        result = draw_batches(r, GL_PASS_TRANSMISSIVE, error);
    glEnable(GL_BLEND);
    glBlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
    if (result == FACET_OK)
        result = draw_batches(r, GL_PASS_BLENDED, error);
    glDisable(GL_BLEND);
    gl_camera_end_depth(r->context);
    gl_target_resolve(&r->target);
    return result;
}

/* Draws into the target. */
static facet_result draw_picture(gl_renderer *r, const facet_render_desc *desc, facet_render_stats *stats,
                                 facet_error *error)
{
    double start = clock_seconds();
    camera_rays camera;
    gl_frame_block block = {.exposure = exp2f(desc->exposure_ev),
                            .energy = (int32_t)desc->energy,
                            .background_blur = desc->background_blur};
    light_setup light = {0};
    facet_result result = gl_context_make_current(r->context, error);
    if (result == FACET_OK)
        result = camera_rays_create(desc->camera, desc->width, desc->height, &camera, error);
    if (result == FACET_OK)
        result = gl_scene_update(&r->prepared, desc, error);
    if (result != FACET_OK)
        return result;
    const gl_view all = {.scale = 1, .width = desc->width, .height = desc->height};
    gl_camera_set(r->context, &camera, r->prepared.pose.bounds_min, r->prepared.pose.bounds_max, desc->width,
                  desc->height, &all, &block);
    stats->geometry_s += clock_seconds() - start;
    start = clock_seconds();
    result = light_setup_create(&r->prepared.geometries, &r->prepared.pose, &camera, desc, &light, error);
    if (result == FACET_OK)
        result = gl_light_update(r->light, &light, error);
    stats->light_s += clock_seconds() - start;
    start = clock_seconds();
    if (result == FACET_OK)
        result = gl_mesh_update(r->meshes, &r->prepared, &desc->log, error);
    if (result == FACET_OK)
        result = gl_material_update(r->materials, r->meshes, desc, error);
    stats->textures_s += clock_seconds() - start;
    start = clock_seconds();
    if (result == FACET_OK)
        result = gl_target_update(&r->target, r->context, desc->width, desc->height, desc->samples, error);
    if (result == FACET_OK) {
        gl_mesh_order(r->meshes, &block, r->materials);
        gl_light_bind(r->light, &block);
        result = draw(r, desc, &block, error);
    }
    if (result == FACET_OK)
        result = gl_context_check(r->context, "picture", error);
    light_setup_destroy(&light);
    stats->shade_s += clock_seconds() - start;
    return result;
}

/* Rows of a film run from the top, OpenGL's from the bottom. */
static void read_picture(const gl_renderer *r, const facet_render_desc *desc, film *target)
{
    const uint32_t *crop = desc->crop;
    glBindFramebuffer(GL_READ_FRAMEBUFFER, r->target.resolved_framebuffer);
    glPixelStorei(GL_PACK_ALIGNMENT, 4);
    for (uint32_t y = 0; y < crop[3]; y++)
        glReadPixels((GLint)crop[0], (GLint)(desc->height - 1 - (crop[1] + y)), (GLsizei)crop[2], 1, GL_RGBA,
                     GL_FLOAT, target->layers[0].pixels + 4 * (size_t)y * crop[2]);
}

facet_result gl_renderer_render(gl_renderer *r, const facet_render_desc *desc, film *target,
                                facet_render_stats *stats, facet_error *error)
{
    double start = clock_seconds();
    *stats = (facet_render_stats){.thread_count = desc->thread_count};
    facet_result result = draw_picture(r, desc, stats, error);
    if (result == FACET_OK)
        read_picture(r, desc, target);
    if (result == FACET_OK)
        result = gl_context_check(r->context, "reading the picture", error);
    gl_context_release(r->context);
    stats->total_s = clock_seconds() - start;
    return result;
}

facet_result gl_renderer_present(gl_renderer *r, const facet_render_desc *desc, uint32_t framebuffer, int x,
                                 int y, facet_render_stats *stats, facet_error *error)
{
    *stats = (facet_render_stats){.thread_count = desc->thread_count};
    facet_result result = draw_picture(r, desc, stats, error);
    if (result != FACET_OK)
        return result;
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    glViewport(x, y, (GLsizei)desc->width, (GLsizei)desc->height);
    glActiveTexture(GL_TEXTURE0);
    glBindTexture(GL_TEXTURE_2D, r->target.color);
    glDisable(GL_DEPTH_TEST);
    return draw_screen(r, GL_MAIN_PRESENT, 0, error);
}
