/* gl_sea_state.c - see gl_sea_state.h: creation, and the loss of the context. */
#include "gl/sea/gl_sea_state.h"

#include "base/memory.h"
#include "base/result.h"
#include "gl/core/gl_blocks.h"
#include "ibl/environment.h"

void gl_sea_forget_light(gl_sea *s)
{
    gl_light_atlas_destroy(&s->atlas);
    gl_sea_textures_forget_light(&s->textures);
    for (int i = 0; i < 2; i++) {
        if (s->environments[i])
            environment_release(s->environments[i]);
        s->environments[i] = NULL;
    }
}

void gl_sea_stop(gl_sea *s)
{
    gl_context spare = {.context = NULL};
    bool is_own = s->context == &s->own;
    if (s->programs && gl_context_make_current_to_delete(s->context, &spare)) {
        gl_programs_destroy(s->programs);
        gl_target_destroy(&s->grid);
        gl_target_destroy(&s->seen);
        gl_target_destroy(&s->target);
        gl_sea_mesh_destroy(&s->mesh);
        const GLuint buffers[] = {s->frame_buffer, s->light_buffer, s->sea_buffer};
        glDeleteBuffers(3, buffers);
        glDeleteVertexArrays(1, &s->empty_array);
        gl_sea_forget_light(s);
        gl_sea_textures_destroy(&s->textures);
    }
    gl_context_destroy(&spare);
    if (is_own)
        gl_context_destroy(&s->own);
    *s = (gl_sea){.allocator = s->allocator, .api = s->api, .context = is_own ? &s->own : s->context};
}

void gl_sea_set_block(GLuint buffer, GLuint point, const void *block, size_t size)
{
    glBindBuffer(GL_UNIFORM_BUFFER, buffer);
    glBufferData(GL_UNIFORM_BUFFER, (GLsizeiptr)size, block, GL_DYNAMIC_DRAW);
    glBindBufferBase(GL_UNIFORM_BUFFER, point, buffer);
}

facet_result gl_sea_start(gl_sea *s, facet_error *error)
{
    bool is_own = s->context == &s->own;
    if (is_own && s->own.is_lost)
        gl_sea_stop(s);
    TRY(is_own && !s->own.context ? gl_context_create_api(&s->own, s->api, error)
                                  : gl_context_make_current(s->context, error));
    if (s->programs)
        return FACET_OK;
    TRY(gl_programs_create(s->context, &s->allocator, NULL, &s->programs, error));
    GLuint buffers[3];
    glGenBuffers(3, buffers);
    s->frame_buffer = buffers[0];
    s->light_buffer = buffers[1];
    s->sea_buffer = buffers[2];
    glGenVertexArrays(1, &s->empty_array);
    /* WebGL refuses to draw with a block that has no data, even if the program reads none of it */
    const gl_frame_block no_frame = {.channel = 0};
    const gl_light_block no_light = {.atlas = {0.0f}};
    gl_sea_set_block(s->frame_buffer, GL_BLOCK_FRAME, &no_frame, sizeof no_frame);
    gl_sea_set_block(s->light_buffer, GL_BLOCK_LIGHT, &no_light, sizeof no_light);
    return FACET_OK;
}

static facet_result create(gl_context *context, gl_api wanted, const facet_allocator *allocator, gl_sea **out,
                           facet_error *error)
{
    gl_sea *s = mem_zalloc(allocator, 1, sizeof *s);
    *out = NULL;
    if (!s)
        return fail_memory(error, "renderer", sizeof *s);
    s->allocator = allocator ? *allocator : (facet_allocator){0};
    s->api = wanted;
    s->context = context ? context : &s->own;
    facet_result result = gl_sea_start(s, error);
    if (result != FACET_OK) {
        gl_sea_destroy(s);
        return result;
    }
    gl_context_release(s->context);
    *out = s;
    return FACET_OK;
}

facet_result gl_sea_create(const facet_allocator *allocator, gl_sea **out, facet_error *error)
{
    return create(NULL, GL_API_ANY, allocator, out, error);
}

facet_result gl_sea_create_api(gl_api wanted, const facet_allocator *allocator, gl_sea **out,
                               facet_error *error)
{
    return create(NULL, wanted, allocator, out, error);
}

facet_result gl_sea_create_within(gl_context *context, const facet_allocator *allocator, gl_sea **out,
                                  facet_error *error)
{
    return create(context, GL_API_ANY, allocator, out, error);
}

void gl_sea_destroy(gl_sea *s)
{
    if (!s)
        return;
    gl_sea_stop(s);
    mem_free(s);
}
