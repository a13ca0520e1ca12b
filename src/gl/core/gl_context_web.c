/* gl_context_web.c - contexts in a browser (WebGL 2); see gl_context.h and gl_api.h. The page creates the
 * context of its canvas and makes it current; gl_context_adopt() does the rest. */
#include "gl/core/gl_context.h"

#include <emscripten/em_js.h>
#include <emscripten/html5.h>
#include <string.h>

#include "base/result.h"
#include "gl/core/gl_api.h"

/* Emscripten's list of functions ends before EXT_clip_control. */
EM_JS(void, call_clip_control, (unsigned origin, unsigned depth),
      { GLctx.getExtension("EXT_clip_control").clipControlEXT(origin, depth); })

/* ---- gl_api.h ---- */

/* Asking for an extension by its name enables it; only then does WebGL accept its constants. */
bool gl_api_has_extension(const char *name)
{
    EMSCRIPTEN_WEBGL_CONTEXT_HANDLE current = emscripten_webgl_get_current_context();
    return current > 0 && strncmp(name, "GL_", 3) == 0 &&
           emscripten_webgl_enable_extension(current, name + 3);
}

void gl_api_clip_control(unsigned origin, unsigned depth)
{
    call_clip_control(origin, depth);
}

/* ---- what gl_context_adopt() asks for ---- */

facet_result gl_context_find_library(facet_error *error)
{
    if (emscripten_webgl_get_current_context() > 0)
        return FACET_OK;
    return fail(error, FACET_ERROR_SYSTEM, "OpenGL: the page has no WebGL 2 context");
}

static unsigned lost_status(void)
{
    return emscripten_is_webgl_context_lost(emscripten_webgl_get_current_context()) ? GL_CONTEXT_LOST
                                                                                    : GL_NO_ERROR;
}

void gl_context_find_platform(gl_context *c)
{
    c->reset_status = lost_status;
    c->is_canvas = true;
}

/* ---- contexts ---- */

facet_result gl_context_create_api(gl_context *c, gl_api wanted, facet_error *error)
{
    *c = (gl_context){0};
    if (wanted == GL_API_CORE)
        return fail(error, FACET_ERROR_SYSTEM, "OpenGL: browsers have WebGL 2 only");
    return gl_context_adopt(c, error);
}

facet_result gl_context_create(gl_context *c, facet_error *error)
{
    return gl_context_create_api(c, GL_API_ES, error);
}

facet_result gl_context_make_current(gl_context *c, facet_error *error)
{
    (void)c; /* The page's context is always current. */
    (void)error;
    return FACET_OK;
}

void gl_context_release(gl_context *c)
{
    (void)c;
}

void gl_context_destroy(gl_context *c)
{
    *c = (gl_context){0};
}
