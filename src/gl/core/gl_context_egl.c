/* gl_context_egl.c - off-screen contexts by EGL; see gl_context.h.
 *
 * Displays are never terminated: EGL returns the same display to every caller, another renderer in the
 * process may use it, and terminating it would destroy all of their contexts. The cost is one loaded
 * driver per process. */
#include "gl/core/gl_context.h"

#include <dlfcn.h>
#include <epoxy/egl.h>
#include <string.h>

#include "base/result.h"
#include "gl/core/gl_api.h"

static bool has_word(const char *words, const char *word)
{
    size_t length = strlen(word);
    for (const char *at = words; at && (at = strstr(at, word)); at += length)
        if ((at == words || at[-1] == ' ') && (at[length] == ' ' || at[length] == 0))
            return true;
    return false;
}

/* ---- the current context ---- */

facet_result gl_context_make_current(gl_context *c, facet_error *error)
{
    if (!c->context || eglGetCurrentContext() == c->context)
        return FACET_OK;
    void *previous[4] = {eglGetCurrentDisplay(), eglGetCurrentSurface(EGL_DRAW),
                         eglGetCurrentSurface(EGL_READ), eglGetCurrentContext()};
    if (!eglMakeCurrent(c->display, c->surface, c->surface, c->context)) {
        EGLint code = eglGetError();
        c->is_lost = c->is_lost || code == EGL_CONTEXT_LOST;
        return fail(
            error, FACET_ERROR_SYSTEM, "OpenGL (%s): the context cannot be used%s (0x%04x)", c->name,
            code == EGL_BAD_ACCESS ? ", because this thread draws with another one, or another with it" : "",
            (unsigned)code);
    }
    memcpy(c->previous, previous, sizeof previous);
    return FACET_OK;
}

void gl_context_release(gl_context *c)
{
    if (!c->context || eglGetCurrentContext() != c->context)
        return;
    eglMakeCurrent(c->display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    if (c->previous[3])
        eglMakeCurrent(c->previous[0], c->previous[1], c->previous[2], c->previous[3]);
    memset(c->previous, 0, sizeof c->previous);
}

void gl_context_destroy(gl_context *c)
{
    if (c->context) {
        gl_context_release(c);
        eglDestroyContext(c->display, c->context);
        if (c->surface)
            eglDestroySurface(c->display, c->surface);
    }
    *c = (gl_context){0};
}

/* ---- creation ---- */

/* Enables notification of resets where the driver has it: level 0 by EGL 1.5, 1 by its extension, 2 not at
 * all. */
static EGLContext new_context(EGLDisplay display, EGLConfig config, bool is_es, int level)
{
    EGLint wanted[16];
    int count = 0;
    wanted[count++] = EGL_CONTEXT_MAJOR_VERSION;
    wanted[count++] = 3;
    if (!is_es) {
        wanted[count++] = EGL_CONTEXT_MINOR_VERSION;
        wanted[count++] = 3;
        wanted[count++] = EGL_CONTEXT_OPENGL_PROFILE_MASK;
        wanted[count++] = EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT;
    }
    if (level < 2) {
        wanted[count++] = level == 0 ? EGL_CONTEXT_OPENGL_RESET_NOTIFICATION_STRATEGY
                                     : EGL_CONTEXT_OPENGL_RESET_NOTIFICATION_STRATEGY_EXT;
        wanted[count++] = EGL_LOSE_CONTEXT_ON_RESET;
    }
    wanted[count] = EGL_NONE;
    return eglCreateContext(display, config, EGL_NO_CONTEXT, wanted);
}

static bool create_of(gl_context *c, EGLDisplay display, const char *extensions, bool is_es)
{
    const EGLint wanted[] = {EGL_SURFACE_TYPE, EGL_PBUFFER_BIT, EGL_RENDERABLE_TYPE,
                             is_es ? EGL_OPENGL_ES3_BIT : EGL_OPENGL_BIT, EGL_NONE};
    EGLConfig config = NULL;
    EGLint count = 0;
    if (!eglBindAPI(is_es ? EGL_OPENGL_ES_API : EGL_OPENGL_API))
        return false;
    bool has_config = eglChooseConfig(display, wanted, &config, 1, &count) && count == 1;
    if (!has_config && !has_word(extensions, "EGL_KHR_no_config_context"))
        return false;
    EGLContext context = EGL_NO_CONTEXT;
    for (int level = 0; level < 3 && context == EGL_NO_CONTEXT; level++)
        context = new_context(display, has_config ? config : NULL, is_es, level);
    if (context == EGL_NO_CONTEXT)
        return false;
    EGLSurface surface = EGL_NO_SURFACE;
    const EGLint size[] = {EGL_WIDTH, 1, EGL_HEIGHT, 1, EGL_NONE};
    if (!has_word(extensions, "EGL_KHR_surfaceless_context") && has_config)
        surface = eglCreatePbufferSurface(display, config, size);
    *c = (gl_context){.display = display, .context = context, .surface = surface};
    if (gl_context_make_current(c, NULL) == FACET_OK)
        return true;
    gl_context_destroy(c);
    return false;
}

static bool create_on(gl_context *c, EGLDisplay display, gl_api wanted)
{
    if (display == EGL_NO_DISPLAY || !eglInitialize(display, NULL, NULL))
        return false;
    const char *extensions = eglQueryString(display, EGL_EXTENSIONS);
    return (wanted != GL_API_ES && create_of(c, display, extensions, false)) ||
           (wanted != GL_API_CORE && create_of(c, display, extensions, true));
}

/* A GPU, else a software renderer, else the window system's display. */
static bool create_anywhere(gl_context *c, gl_api wanted)
{
    const char *extensions = eglQueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS);
    EGLDeviceEXT devices[16];
    EGLint count = 0;
    if (has_word(extensions, "EGL_EXT_platform_device") &&
        has_word(extensions, "EGL_EXT_device_enumeration") && eglQueryDevicesEXT(16, devices, &count))
        for (int i = 0; i < count; i++)
            if (!has_word(eglQueryDeviceStringEXT(devices[i], EGL_EXTENSIONS), "EGL_MESA_device_software") &&
                create_on(c, eglGetPlatformDisplayEXT(EGL_PLATFORM_DEVICE_EXT, devices[i], NULL), wanted))
                return true;
    if (has_word(extensions, "EGL_MESA_platform_surfaceless") &&
        create_on(c, eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA, NULL, NULL), wanted))
        return true;
    return create_on(c, eglGetDisplay(EGL_DEFAULT_DISPLAY), wanted);
}

facet_result gl_context_create_api(gl_context *c, gl_api wanted, facet_error *error)
{
    *c = (gl_context){0};
    bool has_egl = epoxy_has_egl();
    EGLenum api = has_egl ? eglQueryAPI() : EGL_NONE; /* the thread's API, which is the caller's to choose */
    bool is_created = has_egl && create_anywhere(c, wanted);
    if (api != EGL_NONE)
        eglBindAPI(api);
    if (!is_created)
        return fail(
            error, FACET_ERROR_SYSTEM,
            "OpenGL: there is no driver that draws without a window (EGL with OpenGL 3.3 or OpenGL ES 3.0)");
    facet_result result = gl_context_adopt(c, error);
    if (result != FACET_OK)
        gl_context_destroy(c);
    return result;
}

facet_result gl_context_create(gl_context *c, facet_error *error)
{
    return gl_context_create_api(c, GL_API_ANY, error);
}

/* ---- what gl_context_adopt() asks for ---- */

/* epoxy ends the process where it finds neither library, which can happen where only libEGL is installed. */
facet_result gl_context_find_library(facet_error *error)
{
    static const char *const names[] = {"libOpenGL.so.0", "libGL.so.1"};
    for (int i = 0; i < 2; i++) {
        void *library = dlopen(names[i], RTLD_LAZY | RTLD_LOCAL);
        if (library) {
            dlclose(library);
            return FACET_OK;
        }
    }
    return fail(error, FACET_ERROR_SYSTEM, "OpenGL: neither libOpenGL.so.0 nor libGL.so.1 is installed");
}

/* Function pointers of epoxy are variables, so wrap them in functions. */
static unsigned core_reset_status(void)
{
    return glGetGraphicsResetStatus();
}

static unsigned khr_reset_status(void)
{
    return glGetGraphicsResetStatusKHR();
}

static unsigned arb_reset_status(void)
{
    return glGetGraphicsResetStatusARB();
}

static unsigned ext_reset_status(void)
{
    return glGetGraphicsResetStatusEXT();
}

void gl_context_find_platform(gl_context *c)
{
    if (c->version >= (c->is_es ? 32 : 45))
        c->reset_status = core_reset_status;
    else if (gl_api_has_extension("GL_KHR_robustness"))
        c->reset_status = khr_reset_status;
    else if (!c->is_es && gl_api_has_extension("GL_ARB_robustness"))
        c->reset_status = arb_reset_status;
    else if (c->is_es && gl_api_has_extension("GL_EXT_robustness"))
        c->reset_status = ext_reset_status;
}
