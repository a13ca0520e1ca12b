/* ocean.c - what the ocean page calls: one sea in one canvas, set by the options of facet ocean (ocean_settings.h). Here it
 * is started, lost, restored, and its options are set and read. */
#include "ocean.h"

#include <emscripten/emscripten.h>
#include <emscripten/html5.h>
#include <string.h>

#include "base/memory.h"
#include "base/result.h"

ocean_page ocean;

/* ---- start, loss ---- */

static facet_result open_context(const char *canvas, facet_error *error)
{
    EmscriptenWebGLContextAttributes wanted;
    emscripten_webgl_init_context_attributes(&wanted);
    wanted.majorVersion = 2;
    wanted.alpha = wanted.antialias = wanted.depth = wanted.stencil = false;
    wanted.preserveDrawingBuffer = true; /* an image at rest is drawn row by row, and may be saved */
    EMSCRIPTEN_WEBGL_CONTEXT_HANDLE handle = emscripten_webgl_create_context(canvas, &wanted);
    if (handle <= 0 || emscripten_webgl_make_context_current(handle) != EMSCRIPTEN_RESULT_SUCCESS)
        return fail(error, FACET_ERROR_SYSTEM, "this browser has no WebGL 2, which facet draws with");
    return FACET_OK;
}

static facet_result start_drawing(facet_error *error)
{
    ocean.context = (gl_context){0};
    TRY(gl_context_adopt(&ocean.context, error));
    return gl_sea_create_within(&ocean.context, NULL, &ocean.renderer, error);
}

/* canvas: a selector of CSS, or a name in specialHTMLTargets. */
EMSCRIPTEN_KEEPALIVE int facet_ocean_start(const char *canvas)
{
    facet_result result = open_context(canvas, &ocean.error);
    if (result == FACET_OK)
        result = start_drawing(&ocean.error);
    if (result == FACET_OK)
        result = ocean_settings_reset(&ocean.settings, &ocean.error);
    return result;
}

EMSCRIPTEN_KEEPALIVE const char *facet_ocean_error(void)
{
    return ocean.error.message;
}

/* The last warning, once. */
EMSCRIPTEN_KEEPALIVE const char *facet_ocean_message(void)
{
    static char taken[sizeof ocean.message];
    memcpy(taken, ocean.message, sizeof taken);
    ocean.message[0] = 0;
    return taken;
}

void ocean_forget_frames(void)
{
    for (int i = 0; i < OCEAN_SIDES; i++) {
        water_frame_destroy(ocean.sides[i].frame);
        ocean.sides[i].frame = NULL;
    }
    ocean.passes = ocean.row = 0;
    ocean.side = OCEAN_BEFORE;
}

/* The browser has taken the context away. Objects of OpenGL are released now, because those of the old context are
 * errors in the new one. */
EMSCRIPTEN_KEEPALIVE void facet_ocean_lose(void)
{
    ocean.context.is_lost = true;
    for (int i = 0; i < OCEAN_SIDES; i++)
        gl_target_destroy(&ocean.sides[i].mean);
    gl_sea_destroy(ocean.renderer);
    ocean.renderer = NULL;
    ocean.passes = ocean.row = 0;
    ocean.side = OCEAN_BEFORE;
}

EMSCRIPTEN_KEEPALIVE int facet_ocean_restore(void)
{
    return start_drawing(&ocean.error);
}

/* ---- options ---- */

/* All options get their defaults. */
EMSCRIPTEN_KEEPALIVE int facet_ocean_reset(void)
{
    ocean.time_s = 0.0;
    ocean.metered_width = 0;
    ocean_forget_frames();
    return ocean_settings_reset(&ocean.settings, &ocean.error);
}

int ocean_set_option(const char *name, const char *text)
{
    facet_result result = ocean_settings_set(&ocean.settings, name, text, &ocean.error);
    if (result != FACET_OK)
        return result;
    if (strcmp(name, "time") == 0)
        ocean.time_s = ocean.settings.run.options.render.time_s;
    ocean.metered_width = 0;
    ocean_forget_frames();
    return FACET_OK;
}

EMSCRIPTEN_KEEPALIVE int facet_ocean_set_option(const char *name, const char *text)
{
    return ocean_set_option(name, text);
}

char *ocean_finish_text(text *t)
{
    if (!t->has_failed)
        return t->data; /* blocks of mem_alloc() are freed by facet_ocean_free() */
    text_destroy(t);
    fail_memory(&ocean.error, "a text", 0);
    return NULL;
}

EMSCRIPTEN_KEEPALIVE void facet_ocean_free(char *text)
{
    mem_free(text);
}

EMSCRIPTEN_KEEPALIVE char *facet_ocean_get_options(void)
{
    text t = {.data = NULL};
    ocean_settings_write(&ocean.settings, &t);
    return ocean_finish_text(&t);
}

EMSCRIPTEN_KEEPALIVE char *facet_ocean_get_help(void)
{
    text t = {.data = NULL};
    ocean_settings_write_help(&t);
    return ocean_finish_text(&t);
}

EMSCRIPTEN_KEEPALIVE char *facet_ocean_get_values(void)
{
    text t = {.data = NULL};
    ocean_settings_write_values(&ocean.settings, &t);
    return ocean_finish_text(&t);
}

EMSCRIPTEN_KEEPALIVE char *facet_ocean_command(int width, int height)
{
    text t = {.data = NULL};
    ocean_settings_write_command(&ocean.settings, ocean.time_s, width, height, &t);
    return ocean_finish_text(&t);
}
