/* viewer.c - what a page calls: one model in one canvas. The state is the window's (view_state.h), the image
 * gl_renderer.h's; the page hands over bytes and events and asks for a frame when something changed. */
#include <emscripten/emscripten.h>
#include <emscripten/html5.h>
#include <stdio.h>
#include <string.h>

#include "base/result.h"
#include "gl/core/gl_api.h"
#include "gl/scene/gl_renderer.h"
#include "render/renderer.h"
#include "scene/scene.h"
#include "view/view_camera.h"
#include "view/view_state.h"

static struct {
    gl_context context;
    facet_scene *scene;
    facet_environment *environment;
    gl_renderer *renderer;
    view_state state;
    facet_error error;
    char message[512]; /* about the last change, or the reader's last warning */
} page;

static void note_warning(void *user, facet_log_level level, const char *text)
{
    (void)user;
    if (level == FACET_LOG_LEVEL_WARNING)
        snprintf(page.message, sizeof page.message, "%s", text);
}

static const facet_log page_log = {.message = note_warning};

/* ---- start ---- */

static facet_result open_context(const char *canvas, facet_error *error)
{
    EmscriptenWebGLContextAttributes wanted;
    emscripten_webgl_init_context_attributes(&wanted);
    wanted.majorVersion = 2;
    wanted.alpha = true;
    wanted.premultipliedAlpha = false;
    wanted.antialias = wanted.depth = wanted.stencil = false; /* all in gl_target.h */
    EMSCRIPTEN_WEBGL_CONTEXT_HANDLE handle = emscripten_webgl_create_context(canvas, &wanted);
    if (handle <= 0 || emscripten_webgl_make_context_current(handle) != EMSCRIPTEN_RESULT_SUCCESS)
        return fail(error, FACET_ERROR_SYSTEM, "this browser has no WebGL 2, which facet draws with");
    page.context = (gl_context){0};
    return gl_context_adopt(&page.context, error);
}

/* canvas: a selector of CSS, or a name in specialHTMLTargets. 0: drawn from now on; else facet_web_error(). */
EMSCRIPTEN_KEEPALIVE int facet_web_start(const char *canvas)
{
    const facet_view_desc desc = {
        .render = {.renderer = FACET_RENDERER_KIND_GL, .tonemap = FACET_TONEMAP_NEUTRAL}, .log = page_log};
    facet_result result = open_context(canvas, &page.error);
    if (result == FACET_OK && !page.environment)
        result = facet_environment_create_studio(NULL, &page.environment, &page.error);
    if (result == FACET_OK && !page.scene)
        view_state_create(&page.state, &desc);
    return result;
}

EMSCRIPTEN_KEEPALIVE const char *facet_web_error(void)
{
    return page.error.message;
}

EMSCRIPTEN_KEEPALIVE const char *facet_web_message(void)
{
    return page.state.message[0] ? page.state.message : page.message;
}

/* ---- the model ---- */

static facet_result show(facet_scene *scene, facet_error *error)
{
    scene_pose pose;
    gl_renderer *renderer = NULL;
    facet_view_model model = {.scene = scene, .orbit = scene_orbit_default()};
    TRY(scene_pose_create(scene, &model.pose, NULL, 1, &pose, error));
    facet_result result = gl_renderer_create(scene, &page.context, NULL, &renderer, error);
    if (result == FACET_OK) {
        gl_renderer_destroy(page.renderer);
        facet_scene_destroy(page.scene);
        page.renderer = renderer;
        page.scene = scene;
        view_state_set_model(&page.state, &model, pose.bounds_min, pose.bounds_max, false);
    }
    scene_pose_destroy(&pose);
    return result;
}

/* Takes the scene; where it cannot be drawn the last one stays. */
static int show_or_destroy(facet_scene *scene)
{
    facet_result result = show(scene, &page.error);
    if (result != FACET_OK && page.scene != scene)
        facet_scene_destroy(scene);
    return result;
}

/* bytes NULL: the built-in scene. Where it fails the last model stays. */
EMSCRIPTEN_KEEPALIVE int facet_web_load(const void *bytes, size_t size, const char *name)
{
    const facet_scene_desc desc = {.log = page_log};
    facet_scene *scene;
    page.message[0] = 0;
    facet_result result = bytes ? facet_scene_load_memory(bytes, size, name, &desc, &scene, &page.error)
                                : facet_scene_create_builtin(&desc, &scene, &page.error);
    return result == FACET_OK ? show_or_destroy(scene) : (int)result;
}

/* A model of several files, which the page has written to emscripten's file system in memory. */
EMSCRIPTEN_KEEPALIVE int facet_web_open(const char *path, const char *folder)
{
    const facet_scene_desc desc = {.log = page_log, .root = folder};
    facet_scene *scene;
    page.message[0] = 0;
    facet_result result = facet_scene_load(path, &desc, &scene, &page.error);
    return result == FACET_OK ? show_or_destroy(scene) : (int)result;
}

/* A panorama or cube map as light, of any format that facet reads. bytes NULL: the built-in studio. Where it fails the last
 * light stays. */
EMSCRIPTEN_KEEPALIVE int facet_web_light(const void *bytes, size_t size, const char *name)
{
    const facet_environment_desc desc = {.log = page_log};
    facet_environment *environment;
    page.message[0] = 0;
    facet_result result =
        bytes ? facet_environment_load_memory(bytes, size, name, &desc, &environment, &page.error)
              : facet_environment_create_studio(&desc, &environment, &page.error);
    if (result != FACET_OK)
        return result;
    facet_environment_destroy(page.environment);
    page.environment = environment;
    return FACET_OK;
}

/* The browser has taken the context away. The scene stays; objects of OpenGL are released now, because those of the
 * old context are errors in the new one. */
EMSCRIPTEN_KEEPALIVE void facet_web_lose(void)
{
    page.context.is_lost = true;
    gl_renderer_destroy(page.renderer);
    page.renderer = NULL;
}

/* The browser has given a new one. */
EMSCRIPTEN_KEEPALIVE int facet_web_restore(void)
{
    facet_result result = gl_context_adopt(&page.context, &page.error);
    page.context.is_lost = false;
    if (result == FACET_OK && page.scene)
        result = gl_renderer_create(page.scene, &page.context, NULL, &page.renderer, &page.error);
    return result;
}

/* ---- the image ---- */

EMSCRIPTEN_KEEPALIVE int facet_web_draw(int width, int height, double seconds)
{
    facet_camera camera;
    facet_render_stats stats;
    facet_render_desc desc, resolved;
    view_state *s = &page.state;
    if (!page.renderer)
        return fail(&page.error, FACET_ERROR_ARGUMENT, "there is no model to draw");
    view_state_advance(s, seconds);
    s->width = (uint32_t)width;
    s->height = (uint32_t)height;
    facet_result result = view_state_frame(s, (float)width / (float)height, &page.error);
    if (result != FACET_OK)
        return result;
    desc = view_state_desc(s, s->width, s->height, &camera);
    desc.environment = page.environment;
    result = render_desc_resolve(&desc, &resolved, &page.error);
    if (result == FACET_OK)
        result = gl_renderer_present(page.renderer, &resolved, 0, 0, 0, &stats, &page.error);
    return result;
}

EMSCRIPTEN_KEEPALIVE bool facet_web_is_playing(void)
{
    return page.state.is_playing;
}

/* ---- events ---- */

/* kind: a view_event_kind of the pointer. x, y: pixels of the canvas; of a wheel: steps. True: draw again. */
EMSCRIPTEN_KEEPALIVE bool facet_web_point(int kind, int button, unsigned modifiers, double x, double y)
{
    const view_event event = {
        .kind = (view_event_kind)kind, .button = (view_button)button, .modifiers = modifiers, .x = x, .y = y};
    return view_state_point(&page.state, &event);
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

/* What the page does not show: other renderers, the divider, the overlay. */
static bool is_for_windows(view_action action)
{
    return action == VIEW_ACTION_RENDERER || action == VIEW_ACTION_DENOISE || action == VIEW_ACTION_DIVIDER ||
           action == VIEW_ACTION_HELP || action == VIEW_ACTION_VALUES;
}

/* key: as in view_input.h. True: the key is bound to a change of the image. */
EMSCRIPTEN_KEEPALIVE bool facet_web_key(unsigned key, unsigned modifiers)
{
    if (!page.scene)
        return false;
    if (move_by_arrow(&page.state, key, modifiers))
        return true;
    const view_binding *binding = view_binding_find(key, modifiers);
    return binding && !is_for_windows(binding->action) &&
           view_state_apply(&page.state, binding->action, binding->amount);
}

/* Settings of the page's controls. False: there is no such name. */
EMSCRIPTEN_KEEPALIVE bool facet_web_set(const char *name, double value)
{
    facet_render_desc *render = &page.state.render;
    if (strcmp(name, "exposure") == 0)
        render->exposure_ev = (float)value;
    else if (strcmp(name, "rotation") == 0)
        render->environment_rotation_rad = (float)value;
    else if (strcmp(name, "tonemap") == 0)
        render->tonemap = (facet_tonemap)value;
    else if (strcmp(name, "background") == 0)
        render->background = (facet_background)value;
    else
        return false;
    return true;
}
