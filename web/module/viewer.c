/* viewer.c - what a page calls: viewers of models, which share one context of WebGL. The page hands over bytes and events,
 * and asks for a frame when something changed. Functions that return int give 0, or a facet_result, and then
 * facet_web_error() has its sentence. Functions that return text give a block that the page frees; NULL: as above. */
#include "viewer.h"

#include <emscripten/emscripten.h>
#include <emscripten/html5.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/result.h"
#include "base/text.h"
#include "files.h"
#include "gl/core/gl_api.h"
#include "io/gltf/gltf.h"
#include "io/model_needs.h"
#include "scene/scene.h"
#include "view/view_camera.h"

static struct {
    gl_context context;
    viewer *first;
    facet_error error;
} page;

facet_error *web_error(void)
{
    return &page.error;
}

EMSCRIPTEN_KEEPALIVE const char *facet_web_error(void)
{
    return page.error.message;
}

/* ---- the context ---- */

static facet_result open_context(const char *canvas, facet_error *error)
{
    EmscriptenWebGLContextAttributes wanted;
    emscripten_webgl_init_context_attributes(&wanted);
    wanted.majorVersion = 2;
    wanted.alpha = true;
    wanted.antialias = wanted.depth = wanted.stencil = false; /* all in gl_target.h */
    EMSCRIPTEN_WEBGL_CONTEXT_HANDLE handle = emscripten_webgl_create_context(canvas, &wanted);
    if (handle <= 0 || emscripten_webgl_make_context_current(handle) != EMSCRIPTEN_RESULT_SUCCESS)
        return fail(error, FACET_ERROR_SYSTEM, "this browser has no WebGL 2, which facet draws with");
    page.context = (gl_context){0};
    return gl_context_adopt(&page.context, error);
}

/* canvas: a selector of CSS, or a name in specialHTMLTargets. Once, before anything is drawn. */
EMSCRIPTEN_KEEPALIVE int facet_web_start(const char *canvas)
{
    return open_context(canvas, &page.error);
}

/* The browser has taken the context away. The scenes stay; objects of OpenGL are released now, because those of the
 * old context are errors in the new one. */
EMSCRIPTEN_KEEPALIVE void facet_web_lose(void)
{
    page.context.is_lost = true;
    for (viewer *v = page.first; v; v = v->next) {
        gl_renderer_destroy(v->renderer);
        v->renderer = NULL;
        glDeleteTextures(1, &v->side_texture);
        glDeleteFramebuffers(1, &v->side_framebuffer);
        v->side_texture = v->side_framebuffer = 0;
    }
}

/* The browser has given a new one. */
EMSCRIPTEN_KEEPALIVE int facet_web_restore(void)
{
    facet_result result = gl_context_adopt(&page.context, &page.error);
    page.context.is_lost = false;
    for (viewer *v = page.first; v && result == FACET_OK; v = v->next)
        if (v->scene && !v->renderer)
            result = gl_renderer_create(v->scene, &page.context, NULL, &v->renderer, &page.error);
    return result;
}

/* ---- viewers ---- */

static void note_warning(void *user, facet_log_level level, const char *text)
{
    viewer *v = user;
    if (level == FACET_LOG_LEVEL_WARNING)
        snprintf(v->message, sizeof v->message, "%s", text);
}

facet_log web_viewer_log(viewer *v)
{
    return (facet_log){.message = note_warning, .user = v};
}

EMSCRIPTEN_KEEPALIVE void facet_web_destroy(viewer *v)
{
    if (!v)
        return;
    for (viewer **link = &page.first; *link; link = &(*link)->next)
        if (*link == v) {
            *link = v->next;
            break;
        }
    web_model_close(v);
    web_options_destroy(v);
    glDeleteTextures(1, &v->side_texture);
    glDeleteFramebuffers(1, &v->side_framebuffer);
    free(v);
}

/* Without a model, with the options of facet render. NULL: facet_web_error(). */
EMSCRIPTEN_KEEPALIVE viewer *facet_web_create(void)
{
    viewer *v = calloc(1, sizeof *v);
    if (!v) {
        fail_memory(&page.error, "viewer", sizeof *v);
        return NULL;
    }
    const facet_view_desc desc = {.render = {.renderer = FACET_RENDERER_KIND_GL}, .log = web_viewer_log(v)};
    v->context = &page.context;
    view_state_create(&v->state, &desc);
    view_rig_create(&v->rig);
    v->next = page.first;
    page.first = v;
    if (web_options_create(v, &page.error) == FACET_OK)
        return v;
    facet_web_destroy(v);
    return NULL;
}

/* ---- files and models ---- */

/* bytes: a block of malloc(), owned by the table from now on. */
EMSCRIPTEN_KEEPALIVE int facet_web_put_file(const char *path, void *bytes, size_t size)
{
    return web_files_put(path, bytes, size, &page.error);
}

/* Of all paths; models that were read keep what they need of them. */
EMSCRIPTEN_KEEPALIVE void facet_web_remove_files(void)
{
    web_files_remove();
}

/* The modules with codecs that a model of the table needs, as a JSON array. */
EMSCRIPTEN_KEEPALIVE char *facet_web_list_needs(const char *path)
{
    const facet_scene_desc desc = {.root = ".", .files = web_files_source()};
    unsigned needs = 0;
    text t = {0};
    if (*path && model_needs_of_file(path, &desc, &needs, &page.error) != FACET_OK)
        needs = 0; /* opening it will say why */
    text_json_begin_array(&t, NULL);
    for (unsigned i = 0; i < MODEL_NEED_COUNT; i++)
        if (needs & 1u << i)
            text_json_string(&t, NULL, model_need_name((model_need)(1u << i)));
    text_json_end_array(&t);
    char *copy = t.has_failed ? NULL : strdup(t.data);
    text_destroy(&t);
    return copy;
}

/* A model of the table; "": the built-in scene. Where it fails the last model stays. */
EMSCRIPTEN_KEEPALIVE int facet_web_open(viewer *v, const char *path)
{
    return web_model_open(v, path, &page.error);
}

/* The description of facet inspect. */
EMSCRIPTEN_KEEPALIVE char *facet_web_describe(viewer *v)
{
    char *text = NULL;
    if (!v->scene) {
        fail(&page.error, FACET_ERROR_ARGUMENT, "there is no model to describe");
        return NULL;
    }
    if (facet_scene_describe_json(v->scene, &text, &page.error) != FACET_OK)
        return NULL;
    char *copy = strdup(text);
    facet_text_destroy(text);
    return copy;
}

/* json: a part of a glTF material, whose members replace values; null takes a texture or an extension away. */
EMSCRIPTEN_KEEPALIVE int facet_web_set_material(viewer *v, int material, const char *json)
{
    if (!v->scene)
        return fail(&page.error, FACET_ERROR_ARGUMENT, "there is no model to change");
    return gltf_edit_material(v->scene, (uint32_t)material, json, &page.error);
}

/* The bytes of an image as they are in the file, in memory of the scene. */
EMSCRIPTEN_KEEPALIVE int facet_web_get_image(viewer *v, int index, const void **bytes, size_t *size,
                                             const char **media_type)
{
    if (!v->scene || index < 0 || (uint32_t)index >= v->scene->image_count)
        return fail(&page.error, FACET_ERROR_ARGUMENT, "there is no image %d", index);
    const scene_image *image = &v->scene->images[index];
    *bytes = image->bytes;
    *size = image->size;
    *media_type = image->mime_type;
    if (image->bytes)
        return FACET_OK;
    return fail(&page.error, FACET_ERROR_READ, "image %d (%s) could not be read", index,
                image->uri ? image->uri : image->name);
}

/* ---- options ---- */

/* Long names and values of facet render; text NULL: the default. Where it fails nothing has changed. */
EMSCRIPTEN_KEEPALIVE int facet_web_set_option(viewer *v, const char *name, const char *text)
{
    return web_options_set(v, name, text, &page.error);
}

/* A JSON object of those that are not the default. */
EMSCRIPTEN_KEEPALIVE char *facet_web_get_options(viewer *v)
{
    return web_describe_options(v);
}

/* The command line that renders this view at that size. */
EMSCRIPTEN_KEEPALIVE char *facet_web_command(viewer *v, int width, int height)
{
    return web_options_command(v, (uint32_t)width, (uint32_t)height);
}

EMSCRIPTEN_KEEPALIVE char *facet_web_state(viewer *v)
{
    return web_describe_state(v);
}

/* Two images side by side: "masking", "scattering", "tone-mapping", "variant"; "": none. position: of the divider, in
 * [0, 1] of the width. */
EMSCRIPTEN_KEEPALIVE int facet_web_compare(viewer *v, const char *name, double position)
{
    view_divider *d = &v->state.divider;
    view_comparison wanted;
    if (!web_comparison_find(name, &wanted))
        return fail(&page.error, FACET_ERROR_ARGUMENT,
                    "comparison: \"%.80s\" is none of masking, scattering, tone-mapping, variant", name);
    if (wanted == VIEW_COMPARE_VARIANT && !v->state.counts.variants)
        return fail(&page.error, FACET_ERROR_ARGUMENT, "comparison: the model has no variants");
    d->comparison = wanted;
    d->position = position >= 0.0 && position <= 1.0 ? position : 0.5;
    d->variant = view_state_find_variant(&v->state);
    return FACET_OK;
}

/* Whether the animation runs, and how fast; the first one where none was chosen. */
EMSCRIPTEN_KEEPALIVE void facet_web_play(viewer *v, bool plays, double speed)
{
    view_state *s = &v->state;
    if (speed == speed)
        s->speed = speed;
    if (plays != s->is_playing && s->scene)
        view_state_apply(s, VIEW_ACTION_PLAY, 1);
}

/* ---- images ---- */

/* Into framebuffer 0 from its lower left corner. seconds: since the last frame. */
EMSCRIPTEN_KEEPALIVE int facet_web_draw(viewer *v, int width, int height, double seconds, bool is_draft)
{
    view_state_advance(&v->state, seconds);
    TRY(web_camera_advance(v, (uint32_t)width, (uint32_t)height, seconds, &page.error));
    return web_draw(v, (uint32_t)width, (uint32_t)height, is_draft, &page.error);
}

/* Whether another frame is wanted though nothing was changed from outside. */
EMSCRIPTEN_KEEPALIVE bool facet_web_is_moving(viewer *v)
{
    return v->state.is_playing || web_camera_is_moving(v);
}

/* As facet render --renderer gl makes it at that size: RGBA8, rows from the top, straight alpha, a block that the page
 * frees. */
EMSCRIPTEN_KEEPALIVE int facet_web_read_image(viewer *v, int width, int height, void **rgba)
{
    return web_draw_read(v, (uint32_t)width, (uint32_t)height, rgba, &page.error);
}

/* What the last frame shows at x, y (pixels from its top left): 1 or 0 (nothing), position, normal, and the index of the
 * material, -1 for none. */
EMSCRIPTEN_KEEPALIVE int facet_web_pick(viewer *v, double x, double y, double out[8])
{
    return web_draw_pick(v, x, y, out, &page.error);
}

/* Where a position is in the last frame: x, y in pixels, its depth in m, and 1 or 0 (behind the camera). */
EMSCRIPTEN_KEEPALIVE int facet_web_project(viewer *v, const double position[3], double out[4])
{
    return web_draw_project(v, position, out, &page.error);
}

/* ---- events ---- */

/* kind: a view_event_kind of the pointer. x, y: pixels of the canvas; of a wheel: steps. True: draw again. */
EMSCRIPTEN_KEEPALIVE bool facet_web_point(viewer *v, int kind, int button, unsigned modifiers, double x,
                                          double y)
{
    const view_event event = {
        .kind = (view_event_kind)kind, .button = (view_button)button, .modifiers = modifiers, .x = x, .y = y};
    return view_state_point(&v->state, &event);
}

/* A canvas is moved by keys as <model-viewer> is: arrows turn by pi/8, with Shift they pan. */
static bool move_by_arrow(view_state *s, unsigned key, unsigned modifiers)
{
    static const int directions[4][2] = {{-1, 0}, {1, 0}, {0, -1}, {0, 1}}; /* from VIEW_KEY_LEFT */
    if (key < VIEW_KEY_LEFT || key > VIEW_KEY_DOWN || (modifiers & ~(unsigned)VIEW_SHIFT))
        return false;
    const double step = (double)s->height / 16.0; /* the whole height is a full turn */
    const double dx = step * directions[key - VIEW_KEY_LEFT][0],
                 dy = step * directions[key - VIEW_KEY_LEFT][1];
    view_state_leave_file_camera(s);
    s->is_framed = false;
    s->message[0] = 0;
    if (modifiers)
        view_camera_pan(&s->orbit, -dx, -dy, s->height);
    else
        view_camera_turn(&s->orbit, -dx, -dy, s->height);
    return true;
}

/* What the page does not show: other renderers, the overlay. */
static bool is_for_windows(view_action action)
{
    return action == VIEW_ACTION_RENDERER || action == VIEW_ACTION_DENOISE || action == VIEW_ACTION_HELP ||
           action == VIEW_ACTION_VALUES;
}

/* key: as in view_input.h. True: the key is bound to a change of the image. */
EMSCRIPTEN_KEEPALIVE bool facet_web_key(viewer *v, unsigned key, unsigned modifiers)
{
    if (!v->scene)
        return false;
    if (move_by_arrow(&v->state, key, modifiers))
        return true;
    const view_binding *binding = view_binding_find(key, modifiers);
    if (!binding || is_for_windows(binding->action) ||
        !view_state_apply(&v->state, binding->action, binding->amount))
        return false;
    if (v->state.divider.comparison == VIEW_COMPARE_RENDERER) /* there is one renderer only */
        view_divider_step(&v->state.divider, binding->amount, v->state.counts.variants > 0,
                          FACET_RENDERER_KIND_GL);
    return true;
}
