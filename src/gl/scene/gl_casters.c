/* gl_casters.c - see gl_casters.h. */
#include "gl/scene/gl_casters.h"

#include <epoxy/gl.h>
#include <string.h>

#include "gl/scene/gl_camera.h"

facet_result gl_casters_make_texture(gl_context *context, uint32_t edge, bool compares, uint32_t *texture,
                                     uint32_t *framebuffer, facet_error *error)
{
    static const GLenum none = GL_NONE;
    GLint filter = compares ? GL_LINEAR : GL_NEAREST; /* of what comparing gives */
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
    facet_result result = gl_programs_get(c->programs, key, &program, error);
    if (result != FACET_OK)
        return result;
    glUseProgram(program);
    if (is_masked)
        gl_material_bind(c->materials, batch);
    glDisable(GL_CULL_FACE); /* whichever side the light sees is in its way */
    gl_mesh_draw(c->meshes, batch);
    return FACET_OK;
}

facet_result gl_casters_draw(gl_casters *c, const float matrix[16], uint32_t x, uint32_t y, uint32_t edge,
                             facet_error *error)
{
    gl_frame_block frame = {.eye = {c->eye[0], c->eye[1], c->eye[2]}};
    memcpy(frame.view_projection, matrix, sizeof frame.view_projection);
    if (!c->block)
        glGenBuffers(1, &c->block);
    glBindBuffer(GL_UNIFORM_BUFFER, c->block);
    glBufferData(GL_UNIFORM_BUFFER, sizeof frame, &frame, GL_STREAM_DRAW);
    glBindBufferBase(GL_UNIFORM_BUFFER, GL_BLOCK_FRAME, c->block);
    glViewport((GLint)x, (GLint)y, (GLsizei)edge, (GLsizei)edge);
    for (gl_pass pass = GL_PASS_OPAQUE; pass < GL_PASS_COUNT; pass++) {
        uint32_t count;
        const gl_batch *batches = gl_mesh_batches(c->meshes, pass, &count);
        for (uint32_t i = 0; i < count; i++) {
            if (!casts(&batches[i], pass) || gl_mesh_is_outside(&batches[i], &frame))
                continue;
            facet_result result = draw_batch(c, &batches[i], error);
            if (result != FACET_OK)
                return result;
        }
    }
    return FACET_OK;
}
