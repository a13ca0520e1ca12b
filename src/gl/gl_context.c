/* gl_context.c - see gl_context.h. */
#include "gl/gl_context.h"

#include <epoxy/egl.h>
#include <epoxy/gl.h>
#include <stdio.h>
#include <string.h>

#include "base/result.h"

/* ---- what a context can do ---- */

static void read_limits(gl_context *c)
{
    glGetIntegerv(GL_MAX_TEXTURE_SIZE, &c->max_texture_size);
    glGetIntegerv(GL_MAX_ARRAY_TEXTURE_LAYERS, &c->max_array_layers);
    glGetIntegerv(GL_MAX_TEXTURE_IMAGE_UNITS, &c->max_texture_units);
    glGetIntegerv(GL_MAX_SAMPLES, &c->max_samples);
    c->max_anisotropy = 1.0f;
    if (epoxy_has_gl_extension("GL_EXT_texture_filter_anisotropic") ||
        epoxy_has_gl_extension("GL_ARB_texture_filter_anisotropic") || (!c->is_es && c->version >= 46))
        glGetFloatv(GL_MAX_TEXTURE_MAX_ANISOTROPY_EXT, &c->max_anisotropy);
    c->has_parallel_compile = epoxy_has_gl_extension("GL_KHR_parallel_shader_compile");
    c->has_timer_query = !c->is_es || epoxy_has_gl_extension("GL_EXT_disjoint_timer_query");
    c->has_float_linear = !c->is_es || epoxy_has_gl_extension("GL_OES_texture_float_linear");
    c->has_debug_output = epoxy_has_gl_extension("GL_KHR_debug");
}

facet_result gl_context_adopt(gl_context *c, facet_error *error)
{
    c->is_es = !epoxy_is_desktop_gl();
    c->version = epoxy_gl_version();
    snprintf(c->name, sizeof c->name, "%s, %s", (const char *)glGetString(GL_RENDERER),
             (const char *)glGetString(GL_VERSION));
    if (c->version < (c->is_es ? 30 : 33))
        return fail(error, FACET_ERROR_ENVIRONMENT, "OpenGL: %s is older than OpenGL 3.3 and OpenGL ES 3.0",
                    c->name);
    c->glsl_version = c->is_es ? "300 es" : "330";
    read_limits(c);
    return FACET_OK;
}

/* ---- without a window ---- */

static bool has_word(const char *words, const char *word)
{
    const char *at = words ? strstr(words, word) : NULL;
    size_t length = strlen(word);
    return at && (at[length] == ' ' || at[length] == 0);
}

/* A context of OpenGL 3.3 core, else ES 3.0, on an initialised display. */
static bool create_on(gl_context *c, EGLDisplay display)
{
    const char *extensions = eglQueryString(display, EGL_EXTENSIONS);
    bool is_surfaceless = has_word(extensions, "EGL_KHR_surfaceless_context");
    for (int is_es = 0; is_es < 2; is_es++) {
        const EGLint wanted[] = {EGL_SURFACE_TYPE, EGL_PBUFFER_BIT, EGL_RENDERABLE_TYPE,
                                 is_es ? EGL_OPENGL_ES3_BIT : EGL_OPENGL_BIT, EGL_NONE};
        const EGLint core[] = {EGL_CONTEXT_MAJOR_VERSION,
                               3,
                               EGL_CONTEXT_MINOR_VERSION,
                               3,
                               EGL_CONTEXT_OPENGL_PROFILE_MASK,
                               EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                               EGL_NONE};
        const EGLint es[] = {EGL_CONTEXT_MAJOR_VERSION, 3, EGL_NONE};
        EGLConfig config = NULL;
        EGLint count = 0;
        if (!eglBindAPI(is_es ? EGL_OPENGL_ES_API : EGL_OPENGL_API))
            continue;
        bool has_config = eglChooseConfig(display, wanted, &config, 1, &count) && count == 1;
        if (!has_config && !has_word(extensions, "EGL_KHR_no_config_context"))
            continue;
        EGLContext context =
            eglCreateContext(display, has_config ? config : NULL, EGL_NO_CONTEXT, is_es ? es : core);
        if (context == EGL_NO_CONTEXT)
            continue;
        EGLSurface surface = EGL_NO_SURFACE;
        const EGLint size[] = {EGL_WIDTH, 1, EGL_HEIGHT, 1, EGL_NONE};
        if (!is_surfaceless && has_config)
            surface = eglCreatePbufferSurface(display, config, size);
        if (eglMakeCurrent(display, surface, surface, context)) {
            *c = (gl_context){.display = display, .context = context, .surface = surface};
            return true;
        }
        eglDestroyContext(display, context);
    }
    return false;
}

static bool create_on_platform(gl_context *c, EGLenum platform, void *native)
{
    EGLDisplay display =
        platform ? eglGetPlatformDisplayEXT(platform, native, NULL) : eglGetDisplay(EGL_DEFAULT_DISPLAY);
    if (display == EGL_NO_DISPLAY || !eglInitialize(display, NULL, NULL))
        return false;
    if (create_on(c, display))
        return true;
    eglTerminate(display);
    return false;
}

static bool create_anywhere(gl_context *c)
{
    const char *extensions = eglQueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS);
    EGLDeviceEXT devices[16];
    EGLint count = 0;
    if (has_word(extensions, "EGL_EXT_platform_device") &&
        has_word(extensions, "EGL_EXT_device_enumeration") && eglQueryDevicesEXT(16, devices, &count))
        for (int i = 0; i < count; i++)
            if (!has_word(eglQueryDeviceStringEXT(devices[i], EGL_EXTENSIONS), "EGL_MESA_device_software") &&
                create_on_platform(c, EGL_PLATFORM_DEVICE_EXT, devices[i]))
                return true;
    if (has_word(extensions, "EGL_MESA_platform_surfaceless") &&
        create_on_platform(c, EGL_PLATFORM_SURFACELESS_MESA, NULL))
        return true;
    return create_on_platform(c, 0, NULL);
}

facet_result gl_context_create(gl_context *c, facet_error *error)
{
    *c = (gl_context){0};
    if (!epoxy_has_egl() || !create_anywhere(c))
        return fail(
            error, FACET_ERROR_ENVIRONMENT,
            "OpenGL: there is no driver that draws without a window (EGL with OpenGL 3.3 or OpenGL ES 3.0)");
    facet_result result = gl_context_adopt(c, error);
    if (result != FACET_OK)
        gl_context_destroy(c);
    return result;
}

facet_result gl_context_make_current(gl_context *c, facet_error *error)
{
    if (c->context && !eglMakeCurrent(c->display, c->surface, c->surface, c->context))
        return fail(error, FACET_ERROR_ENVIRONMENT, "OpenGL (%s): the context cannot be used", c->name);
    return FACET_OK;
}

void gl_context_release(gl_context *c)
{
    if (c->context)
        eglMakeCurrent(c->display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
}

void gl_context_destroy(gl_context *c)
{
    if (c->context) {
        gl_context_release(c);
        eglDestroyContext(c->display, c->context);
        if (c->surface)
            eglDestroySurface(c->display, c->surface);
        eglTerminate(c->display);
    }
    *c = (gl_context){0};
}

facet_result gl_context_check(gl_context *c, const char *while_doing, facet_error *error)
{
    GLenum code = glGetError();
    switch (code) {
    case GL_NO_ERROR:
        return FACET_OK;
    case GL_OUT_OF_MEMORY:
        return fail(error, FACET_ERROR_MEMORY, "OpenGL (%s): there is no memory for %s", c->name,
                    while_doing);
    case GL_CONTEXT_LOST:
        return fail(error, FACET_ERROR_ENVIRONMENT, "OpenGL (%s): the context was lost (%s)", c->name,
                    while_doing);
    default:
        return fail(error, FACET_ERROR_ENVIRONMENT, "OpenGL (%s): error 0x%04x (%s)", c->name, code,
                    while_doing);
    }
}
