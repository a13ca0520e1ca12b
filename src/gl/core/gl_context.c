/* gl_context.c - see gl_context.h: capabilities and errors of any context. Contexts are created in
 * gl_context_egl.c and, in a browser, gl_context_web.c. */
#include "gl/core/gl_context.h"

#include <stdio.h>

#include "base/result.h"
#include "gl/core/gl_api.h"

/* ---- capabilities ---- */

static bool has_any(const char *a, const char *b)
{
    return gl_api_has_extension(a) || gl_api_has_extension(b);
}

static void read_limits(gl_context *c)
{
    glGetIntegerv(GL_MAX_TEXTURE_SIZE, &c->max_texture_size);
    glGetIntegerv(GL_MAX_ARRAY_TEXTURE_LAYERS, &c->max_array_layers);
    glGetIntegerv(GL_MAX_TEXTURE_IMAGE_UNITS, &c->max_texture_units);
    glGetIntegerv(GL_MAX_SAMPLES, &c->max_samples);
    c->max_anisotropy = 1.0f;
    if (has_any("GL_EXT_texture_filter_anisotropic", "GL_ARB_texture_filter_anisotropic") ||
        (!c->is_es && c->version >= 46))
        glGetFloatv(GL_MAX_TEXTURE_MAX_ANISOTROPY_EXT, &c->max_anisotropy);
    c->has_parallel_compile = gl_api_has_extension("GL_KHR_parallel_shader_compile");
    c->has_timer_query = !c->is_es || gl_api_has_extension("GL_EXT_disjoint_timer_query");
    c->has_float_linear = !c->is_es || gl_api_has_extension("GL_OES_texture_float_linear");
    c->has_float_target = !c->is_es || gl_api_has_extension("GL_EXT_color_buffer_float");
    c->has_half_target =
        c->has_float_target || has_any("GL_EXT_color_buffer_half_float", "GL_EXT_color_buffer_float");
    c->has_texture_storage =
        c->version >= (c->is_es ? 30 : 42) || gl_api_has_extension("GL_ARB_texture_storage");
    c->has_clip_control =
        has_any("GL_ARB_clip_control", "GL_EXT_clip_control") || (!c->is_es && c->version >= 45);
    gl_context_find_platform(c);
    c->has_debug_output = gl_api_has_extension("GL_KHR_debug");
}

facet_result gl_context_adopt(gl_context *c, facet_error *error)
{
    TRY(gl_context_find_library(error));
    c->is_es = gl_api_is_es();
    c->version = gl_api_version();
    snprintf(c->name, sizeof c->name, "%s, %s", (const char *)glGetString(GL_RENDERER),
             (const char *)glGetString(GL_VERSION));
    if (c->version < (c->is_es ? 30 : 33))
        return fail(error, FACET_ERROR_SYSTEM, "OpenGL: %s is older than OpenGL 3.3 and OpenGL ES 3.0",
                    c->name);
    c->glsl_version = c->is_es ? "300 es" : "330";
    read_limits(c);
    return FACET_OK;
}

bool gl_context_make_current_to_delete(gl_context *c, gl_context *spare)
{
    *spare = (gl_context){.context = NULL};
    return gl_context_make_current(c, NULL) == FACET_OK || gl_context_create(spare, NULL) == FACET_OK;
}

enum { CONTEXT_LOST_WEBGL = 0x9242 }; /* a browser's GL_CONTEXT_LOST */

/* Clears the error flags. A lost context reports the same error forever, so the loop is bounded. */
static GLenum take_error(void)
{
    GLenum first = glGetError();
    for (int i = 0; i < 16 && first != GL_NO_ERROR && glGetError() != GL_NO_ERROR; i++)
        continue;
    return first;
}

facet_result gl_context_check(gl_context *c, const char *while_doing, facet_error *error)
{
    GLenum code = take_error();
    if (code == GL_CONTEXT_LOST || code == CONTEXT_LOST_WEBGL ||
        (c->reset_status && c->reset_status() != GL_NO_ERROR))
        c->is_lost = true;
    if (c->is_lost)
        return fail(error, FACET_ERROR_SYSTEM, "OpenGL (%s): the driver was reset (%s); try again", c->name,
                    while_doing);
    if (code == GL_NO_ERROR)
        return FACET_OK;
    if (code == GL_OUT_OF_MEMORY)
        return fail(error, FACET_ERROR_MEMORY, "OpenGL (%s): there is no memory for %s", c->name,
                    while_doing);
    return fail(error, FACET_ERROR_SYSTEM, "OpenGL (%s): error 0x%04x (%s)", c->name, code, while_doing);
}

facet_result gl_context_check_framebuffer(gl_context *c, const char *while_doing, const char *unsupported,
                                          facet_error *error)
{
    bool is_complete = glCheckFramebufferStatus(GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE;
    TRY(gl_context_check(c, while_doing, error));
    return is_complete ? FACET_OK : fail(error, FACET_ERROR_SYSTEM, "OpenGL (%s): %s", c->name, unsupported);
}
