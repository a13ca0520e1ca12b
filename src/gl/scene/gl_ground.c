/* gl_ground.c - see gl_ground.h. */
#include "gl/scene/gl_ground.h"

#include <math.h>
#include <string.h>

#include "base/result.h"
#include "gl/core/gl_api.h"
#include "gl/scene/gl_camera.h"
#include "gl/scene/gl_material.h"

/* ---- casters ---- */

facet_result gl_casters_make_texture(gl_context *context, uint32_t edge, bool compares, uint32_t *texture,
                                     uint32_t *framebuffer, facet_error *error)
{
    static const GLenum none = GL_NONE;
    GLint filter = compares ? GL_LINEAR : GL_NEAREST; /* filter of the comparison results */
    glActiveTexture(GL_TEXTURE0);
    glGenTextures(1, texture);
    glBindTexture(GL_TEXTURE_2D, *texture);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_DEPTH_COMPONENT32F, (GLsizei)edge, (GLsizei)edge, 0, GL_DEPTH_COMPONENT,
                 GL_FLOAT, NULL);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, filter);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, filter);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
    if (compares) {
        glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_COMPARE_MODE, GL_COMPARE_REF_TO_TEXTURE);
        glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_COMPARE_FUNC, GL_LEQUAL);
    }
    glGenFramebuffers(1, framebuffer);
    glBindFramebuffer(GL_FRAMEBUFFER, *framebuffer);
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, *texture, 0);
    glDrawBuffers(1, &none);
    glReadBuffer(GL_NONE);
    return gl_context_check(context, "shadows", error);
}

void gl_casters_begin(const gl_casters *c, uint32_t framebuffer, uint32_t edge)
{
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    gl_camera_end_depth(c->context);
    glDisable(GL_SCISSOR_TEST);
    glDisable(GL_BLEND);
    glEnable(GL_DEPTH_TEST);
    glDepthMask(GL_TRUE);
    glViewport(0, 0, (GLsizei)edge, (GLsizei)edge);
    glClear(GL_DEPTH_BUFFER_BIT);
}

static bool casts(const gl_batch *batch, gl_pass pass)
{
    return !batch->is_sprites &&
           (pass == GL_PASS_OPAQUE || (pass == GL_PASS_TRANSMISSIVE && batch->plan->is_volume));
}

static facet_result draw_batch(const gl_casters *c, const gl_batch *batch, facet_error *error)
{
    uint64_t all = gl_material_features(c->materials, batch) | gl_mesh_features(c->meshes, batch);
    bool is_masked = all >> GL_SURFACE_HAS_ALPHA_MASK & 1;
    uint32_t program;
    gl_program_key key = {GL_MAIN_SHADOW, is_masked ? all : 0};
    TRY(gl_programs_get(c->programs, key, &program, error));
    glUseProgram(program);
    if (is_masked)
        gl_material_bind(c->materials, batch);
    glDisable(GL_CULL_FACE); /* both sides cast shadows */
    gl_mesh_draw(c->meshes, batch);
    return FACET_OK;
}

facet_result gl_casters_draw(gl_casters *c, const float matrix[16], uint32_t x, uint32_t y, uint32_t edge,
                             facet_error *error)
{
    union { /* as large as any block that it stands in for */
        gl_frame_block frame;
        char material[GL_MATERIAL_BLOCK_SIZE];
    } block = {.frame = {.eye = {c->eye[0], c->eye[1], c->eye[2]}}};
    memcpy(block.frame.view_projection, matrix, sizeof block.frame.view_projection);
    if (!c->block)
        glGenBuffers(1, &c->block);
    glBindBuffer(GL_UNIFORM_BUFFER, c->block);
    glBufferData(GL_UNIFORM_BUFFER, sizeof block, &block, GL_STREAM_DRAW);
    glBindBufferBase(GL_UNIFORM_BUFFER, GL_BLOCK_FRAME, c->block);
    /* WebGL demands a buffer for each block of a program, even where nothing of it is read */
    glBindBufferBase(GL_UNIFORM_BUFFER, GL_BLOCK_MATERIAL, c->block);
    glViewport((GLint)x, (GLint)y, (GLsizei)edge, (GLsizei)edge);
    for (gl_pass pass = GL_PASS_OPAQUE; pass < GL_PASS_COUNT; pass++) {
        uint32_t count;
        const gl_batch *batches = gl_mesh_batches(c->meshes, pass, &count);
        for (uint32_t i = 0; i < count; i++) {
            if (!casts(&batches[i], pass) || gl_mesh_is_outside(&batches[i], &block.frame))
                continue;
            TRY(draw_batch(c, &batches[i], error));
        }
    }
    return FACET_OK;
}

/* ---- the ground ---- */

static const float DEPTH_MARGIN = 0.01f; /* over the height, so that geometry in the plane is not clipped */

void gl_ground_destroy(gl_ground *g)
{
    glDeleteTextures(1, &g->heights);
    glDeleteTextures(1, &g->map);
    glDeleteFramebuffers(1, &g->heights_framebuffer);
    glDeleteFramebuffers(1, &g->map_framebuffer);
    glDeleteVertexArrays(1, &g->empty_array);
    *g = (gl_ground){.context = g->context};
}

/* Ambient occlusion reaches at least twice the model's size, and further for tall models. */
void gl_ground_plan(gl_ground *g, const facet_render_desc *desc, const float bounds_min[3],
                    const float bounds_max[3])
{
    float extent[3];
    g->is_wanted = desc->ground == FACET_GROUND_SHADOW && bounds_min[0] <= bounds_max[0];
    if (!g->is_wanted)
        return;
    for (int i = 0; i < 3; i++)
        extent[i] = bounds_max[i] - bounds_min[i];
    float half = fmaxf(0.5f * fmaxf(extent[0], extent[2]), 0.05f * extent[1]);
    half = fmaxf(half + fminf(fmaxf(1.5f * extent[1], 0.75f * half), 2.0f * half), 1e-6f);
    float height = fmaxf(extent[1], 1e-6f * half);
    float place[4] = {0.5f * (bounds_min[0] + bounds_max[0]), 0.5f * (bounds_min[2] + bounds_max[2]), half,
                      bounds_min[1]};
    float heights[2] = {-DEPTH_MARGIN * height, (1.0f + DEPTH_MARGIN) * height};
    if (memcmp(place, g->place, sizeof place) != 0 || memcmp(heights, g->height, sizeof heights) != 0)
        g->drawn_revision = 0;
    memcpy(g->place, place, sizeof place);
    memcpy(g->height, heights, sizeof heights);
}

void gl_ground_describe(const gl_ground *g, gl_light_block *block)
{
    memcpy(block->ground, g->place, sizeof g->place);
    memcpy(block->ground_height, g->height, sizeof g->height);
}

/* ---- drawing ---- */

static facet_result make_textures(gl_ground *g, facet_error *error)
{
    if (g->map)
        return FACET_OK;
    TRY(gl_casters_make_texture(g->context, 4 * GL_GROUND_EDGE, false, &g->heights, &g->heights_framebuffer,
                                error));
    bool is_half = g->context->has_half_target;
    glGenTextures(1, &g->map);
    glBindTexture(GL_TEXTURE_2D, g->map);
    glTexImage2D(GL_TEXTURE_2D, 0, is_half ? GL_R16F : GL_R8, GL_GROUND_EDGE, GL_GROUND_EDGE, 0, GL_RED,
                 is_half ? GL_HALF_FLOAT : GL_UNSIGNED_BYTE, NULL);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
    glGenFramebuffers(1, &g->map_framebuffer);
    glBindFramebuffer(GL_FRAMEBUFFER, g->map_framebuffer);
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, g->map, 0);
    glGenVertexArrays(1, &g->empty_array);
    return gl_context_check(g->context, "the ground", error);
}

/* View from straight below or, at the same position, from above: world x and z become clip-space x and y. */
static void height_matrix(const gl_ground *g, bool is_above, const float eye[3], float out[16])
{
    double scale = 1.0 / (double)g->place[2];
    double depth = 2.0 / ((double)g->height[1] - (double)g->height[0]);
    double low = (double)g->place[3] + (double)g->height[0]; /* world */
    double sign = is_above ? -1.0 : 1.0;
    memset(out, 0, 16 * sizeof *out);
    out[0] = (float)scale;
    out[12] = (float)(((double)eye[0] - (double)g->place[0]) * scale);
    out[9] = (float)scale;
    out[13] = (float)(((double)eye[2] - (double)g->place[1]) * scale);
    out[6] = (float)(sign * depth);
    out[14] = (float)(sign * (((double)eye[1] - low) * depth - 1.0));
    out[15] = 1.0f;
}

static facet_result draw_heights(const gl_ground *g, gl_casters *casters, facet_error *error)
{
    gl_casters_begin(casters, g->heights_framebuffer, 4 * GL_GROUND_EDGE);
    for (uint32_t side = 0; side < 2; side++) {
        float matrix[16];
        height_matrix(g, side == 1, casters->eye, matrix);
        TRY(gl_casters_draw(casters, matrix, side * 2 * GL_GROUND_EDGE, 0, 2 * GL_GROUND_EDGE, error));
    }
    return FACET_OK;
}

static facet_result draw_map(const gl_ground *g, gl_casters *casters, facet_error *error)
{
    uint32_t program;
    TRY(gl_programs_get(casters->programs, (gl_program_key){GL_MAIN_GROUND_MAP, 0}, &program, error));
    glBindFramebuffer(GL_FRAMEBUFFER, g->map_framebuffer);
    glViewport(0, 0, GL_GROUND_EDGE, GL_GROUND_EDGE);
    glDisable(GL_DEPTH_TEST);
    glDisable(GL_CULL_FACE);
    glActiveTexture(GL_TEXTURE0 + GL_UNIT_MATERIAL);
    glBindTexture(GL_TEXTURE_2D, g->heights);
    glBindSampler(GL_UNIT_MATERIAL, 0);
    glUseProgram(program);
    glBindVertexArray(g->empty_array);
    glDrawArrays(GL_TRIANGLES, 0, 3);
    return gl_context_check(g->context, "the ground", error);
}

facet_result gl_ground_draw(gl_ground *g, gl_casters *casters, facet_error *error)
{
    if (!g->is_wanted || g->drawn_revision == casters->revision)
        return FACET_OK;
    g->drawn_revision = 0;
    TRY(make_textures(g, error));
    TRY(draw_heights(g, casters, error));
    TRY(draw_map(g, casters, error));
    g->drawn_revision = casters->revision;
    return FACET_OK;
}
