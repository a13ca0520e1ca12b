/* view_window.c - see view_window.h. */
#define _POSIX_C_SOURCE 200809L /* strdup */
#include "view/view_window.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/library.h"
#include "base/memory.h"
#include "base/result.h"
#include "build_config.h"

/* clang-format off */
#define GLFW_FUNCTIONS(F, out) \
    F(out, glfwInit, init) F(out, glfwTerminate, terminate) F(out, glfwGetError, get_error) \
    F(out, glfwWindowHint, window_hint) F(out, glfwWindowHintString, window_hint_string) \
    F(out, glfwCreateWindow, create_window) F(out, glfwDestroyWindow, destroy_window) \
    F(out, glfwShowWindow, show_window) F(out, glfwIconifyWindow, iconify_window) \
    F(out, glfwRestoreWindow, restore_window) F(out, glfwGetWindowAttrib, get_window_attrib) \
    F(out, glfwSetWindowTitle, set_window_title) \
    F(out, glfwSetWindowUserPointer, set_window_user_pointer) \
    F(out, glfwGetWindowUserPointer, get_window_user_pointer) F(out, glfwGetWindowSize, get_window_size) \
    F(out, glfwSetWindowSize, set_window_size) F(out, glfwGetWindowPos, get_window_pos) \
    F(out, glfwGetFramebufferSize, get_framebuffer_size) \
    F(out, glfwGetWindowContentScale, get_window_content_scale) \
    F(out, glfwGetPrimaryMonitor, get_primary_monitor) F(out, glfwGetMonitors, get_monitors) \
    F(out, glfwGetMonitorPos, get_monitor_pos) F(out, glfwGetVideoMode, get_video_mode) \
    F(out, glfwSetWindowMonitor, set_window_monitor) F(out, glfwMakeContextCurrent, make_context_current) \
    F(out, glfwSwapInterval, swap_interval) F(out, glfwSwapBuffers, swap_buffers) \
    F(out, glfwPollEvents, poll_events) F(out, glfwWaitEvents, wait_events) \
    F(out, glfwWaitEventsTimeout, wait_events_timeout) F(out, glfwPostEmptyEvent, post_empty_event) \
    F(out, glfwGetKey, get_key) F(out, glfwGetKeyName, get_key_name) \
    F(out, glfwSetClipboardString, set_clipboard_string) F(out, glfwSetKeyCallback, set_key_callback) \
    F(out, glfwSetCharCallback, set_char_callback) \
    F(out, glfwSetMouseButtonCallback, set_mouse_button_callback) \
    F(out, glfwSetCursorPosCallback, set_cursor_pos_callback) \
    F(out, glfwSetScrollCallback, set_scroll_callback) F(out, glfwSetDropCallback, set_drop_callback) \
    F(out, glfwSetWindowCloseCallback, set_window_close_callback) \
    F(out, glfwSetWindowRefreshCallback, set_window_refresh_callback)
/* clang-format on */

/* Members have GLFW's names. */
typedef struct glfw_library {
    void *handle;
    GLFW_FUNCTIONS(LIBRARY_MEMBER, )
} glfw_library;

struct view_window {
    glfw_library glfw;
    GLFWwindow *handle;
    view_queue *queue;
    double x, y; /* of the pointer, pixels */
    bool is_started, is_damaged;
    int drawn_width, drawn_height;
    bool is_full_screen;
    bool is_minimised;                       /* requested; not every desktop minimises at once, or at all */
    int old_x, old_y, old_width, old_height; /* before full screen */
};

/* GLFW's callbacks get only a handle; its user data is read through the library, whose functions are found
 * at run time. GLFW has one instance per process, on its first thread: so has this. */
static void *(*get_user_pointer)(GLFWwindow *handle);

static view_window *of(GLFWwindow *handle)
{
    return get_user_pointer(handle);
}

/* ---- keys ---- */

static unsigned modifiers_of(int mods)
{
    return (mods & GLFW_MOD_SHIFT ? (unsigned)VIEW_SHIFT : 0) |
           (mods & GLFW_MOD_CONTROL ? (unsigned)VIEW_CONTROL : 0) |
           (mods & GLFW_MOD_ALT ? (unsigned)VIEW_ALT : 0);
}

/* Letters and digits by what is printed on the key, whatever the layout; 0: not bound. Other characters come
 * through on_character(), which knows how they are typed. */
static uint32_t key_of(const view_window *w, int key, int scancode)
{
    static const struct {
        int glfw;
        uint32_t key;
    } keys[] = {{GLFW_KEY_LEFT, VIEW_KEY_LEFT},
                {GLFW_KEY_RIGHT, VIEW_KEY_RIGHT},
                {GLFW_KEY_UP, VIEW_KEY_UP},
                {GLFW_KEY_DOWN, VIEW_KEY_DOWN},
                {GLFW_KEY_ENTER, VIEW_KEY_ENTER},
                {GLFW_KEY_KP_ENTER, VIEW_KEY_ENTER},
                {GLFW_KEY_TAB, VIEW_KEY_TAB},
                {GLFW_KEY_ESCAPE, VIEW_KEY_ESCAPE},
                {GLFW_KEY_HOME, VIEW_KEY_HOME},
                {GLFW_KEY_KP_DECIMAL, VIEW_KEY_HOME},
                {GLFW_KEY_F11, VIEW_KEY_F11},
                {GLFW_KEY_F12, VIEW_KEY_F12},
                {GLFW_KEY_SPACE, ' '}};
    for (size_t i = 0; i < sizeof keys / sizeof *keys; i++)
        if (keys[i].glfw == key)
            return keys[i].key;
    if (key >= GLFW_KEY_KP_0 && key <= GLFW_KEY_KP_9)
        return (uint32_t)('0' + key - GLFW_KEY_KP_0);
    if (key >= GLFW_KEY_0 && key <= GLFW_KEY_9)
        return (uint32_t)('0' + key - GLFW_KEY_0);
    const char *name = w->glfw.get_key_name(key, scancode);
    if (name && !name[1] && name[0] >= 'a' && name[0] <= 'z')
        return (uint32_t)(name[0] - 'a' + 'A');
    return 0;
}

static void on_key(GLFWwindow *handle, int key, int scancode, int action, int mods)
{
    view_window *w = of(handle);
    uint32_t code = action == GLFW_RELEASE ? 0 : key_of(w, key, scancode);
    if (code)
        view_queue_put(w->queue,
                       (view_event){.kind = VIEW_KEY, .key = code, .modifiers = modifiers_of(mods)});
}

static void on_character(GLFWwindow *handle, unsigned character)
{
    view_window *w = of(handle);
    bool is_other = character > ' ' && character < 127 && !(character >= '0' && character <= '9') &&
                    !((character | 32u) >= 'a' && (character | 32u) <= 'z');
    if (is_other)
        view_queue_put(w->queue, (view_event){.kind = VIEW_KEY, .key = character});
}

/* ---- pointer, files, window ---- */

/* Windows are measured in points, images in pixels. */
static void to_pixels(const view_window *w, double *x, double *y)
{
    int width = 1;
    int height = 1;
    int pixel_width = 1;
    int pixel_height = 1;
    w->glfw.get_window_size(w->handle, &width, &height);
    w->glfw.get_framebuffer_size(w->handle, &pixel_width, &pixel_height);
    if (width > 0 && height > 0) {
        *x *= (double)pixel_width / width;
        *y *= (double)pixel_height / height;
    }
}

static void on_button(GLFWwindow *handle, int button, int action, int mods)
{
    view_window *w = of(handle);
    if (button > GLFW_MOUSE_BUTTON_MIDDLE)
        return;
    static const view_button buttons[] = {VIEW_LEFT_BUTTON, VIEW_RIGHT_BUTTON, VIEW_MIDDLE_BUTTON};
    view_queue_put(w->queue, (view_event){.kind = action == GLFW_PRESS ? VIEW_PRESS : VIEW_RELEASE,
                                          .button = buttons[button],
                                          .modifiers = modifiers_of(mods),
                                          .x = w->x,
                                          .y = w->y});
}

static void on_move(GLFWwindow *handle, double x, double y)
{
    view_window *w = of(handle);
    to_pixels(w, &x, &y);
    w->x = x;
    w->y = y;
    view_queue_put(w->queue, (view_event){.kind = VIEW_MOVE, .x = x, .y = y});
}

/* GLFW does not report a scroll's modifiers. */
static unsigned held_modifiers(const view_window *w)
{
    static const struct {
        int key;
        unsigned modifier;
    } keys[] = {{GLFW_KEY_LEFT_SHIFT, VIEW_SHIFT},     {GLFW_KEY_RIGHT_SHIFT, VIEW_SHIFT},
                {GLFW_KEY_LEFT_CONTROL, VIEW_CONTROL}, {GLFW_KEY_RIGHT_CONTROL, VIEW_CONTROL},
                {GLFW_KEY_LEFT_ALT, VIEW_ALT},         {GLFW_KEY_RIGHT_ALT, VIEW_ALT}};
    unsigned modifiers = 0;
    for (size_t i = 0; i < sizeof keys / sizeof *keys; i++)
        if (w->glfw.get_key(w->handle, keys[i].key) == GLFW_PRESS)
            modifiers |= keys[i].modifier;
    return modifiers;
}

static void on_scroll(GLFWwindow *handle, double dx, double dy)
{
    view_window *w = of(handle);
    view_queue_put(w->queue,
                   (view_event){.kind = VIEW_SCROLL, .x = dx, .y = dy, .modifiers = held_modifiers(w)});
}

static void on_drop(GLFWwindow *handle, int count, const char **paths)
{
    view_window *w = of(handle);
    for (int i = 0; i < count; i++)
        view_queue_put(w->queue, (view_event){.kind = VIEW_DROP, .path = strdup(paths[i])});
}

static void on_close(GLFWwindow *handle)
{
    view_queue_put(of(handle)->queue, (view_event){.kind = VIEW_CLOSE});
}

static void on_refresh(GLFWwindow *handle)
{
    of(handle)->is_damaged = true;
}

/* ---- create ---- */

static facet_result open_glfw(glfw_library *out, facet_error *error)
{
    const library_symbol symbols[] = {GLFW_FUNCTIONS(LIBRARY_SYMBOL, out)};
    /* Never unloaded: it loads display libraries that do not support it. */
    const library_desc desc = {.subject = "window",
                               .advice = ", which opens windows, is not installed (Debian: libglfw3)",
                               .version = "; GLFW 3.3 or later was expected",
                               .missing = FACET_ERROR_SYSTEM,
                               .stays = true,
                               .symbols = symbols,
                               .symbol_count = sizeof symbols / sizeof *symbols};
    return library_open(FACET_GLFW_FILE, &desc, &out->handle, error);
}

static facet_result fail_glfw(const view_window *w, const char *what, facet_error *error)
{
    const char *why = NULL;
    w->glfw.get_error(&why);
    size_t length = why ? strlen(why) : 0;
    while (length && why[length - 1] == ' ') /* which a name was to follow */
        length--;
    return fail(error, FACET_ERROR_SYSTEM, "window: %s (%.*s)", what, (int)length, why ? why : "");
}

/* OpenGL 3.3, else ES 3.0. */
static bool create_handle(view_window *w, int width, int height)
{
    for (int is_es = 0; is_es < 2 && !w->handle; is_es++) {
        const glfw_library *g = &w->glfw;
        g->window_hint(GLFW_VISIBLE, GLFW_FALSE);
        g->window_hint(GLFW_CLIENT_API, is_es ? GLFW_OPENGL_ES_API : GLFW_OPENGL_API);
        g->window_hint(GLFW_CONTEXT_VERSION_MAJOR, 3);
        g->window_hint(GLFW_CONTEXT_VERSION_MINOR, is_es ? 0 : 3);
        g->window_hint(GLFW_OPENGL_PROFILE, is_es ? GLFW_OPENGL_ANY_PROFILE : GLFW_OPENGL_CORE_PROFILE);
        g->window_hint(GLFW_DEPTH_BITS, 0); /* rendering uses targets of its own */
        g->window_hint(GLFW_STENCIL_BITS, 0);
        g->window_hint_string(GLFW_X11_CLASS_NAME, "facet");
        w->handle = g->create_window(width, height, "facet", NULL, NULL);
    }
    return w->handle != NULL;
}

static void listen(view_window *w)
{
    const glfw_library *g = &w->glfw;
    get_user_pointer = g->get_window_user_pointer;
    g->set_window_user_pointer(w->handle, w);
    g->set_key_callback(w->handle, on_key);
    g->set_char_callback(w->handle, on_character);
    g->set_mouse_button_callback(w->handle, on_button);
    g->set_cursor_pos_callback(w->handle, on_move);
    g->set_scroll_callback(w->handle, on_scroll);
    g->set_drop_callback(w->handle, on_drop);
    g->set_window_close_callback(w->handle, on_close);
    g->set_window_refresh_callback(w->handle, on_refresh);
}

facet_result view_window_create(const facet_allocator *allocator, uint32_t width, uint32_t height,
                                view_queue *queue, view_window **out, facet_error *error)
{
    *out = NULL;
    view_window *w = mem_zalloc(allocator, 1, sizeof *w);
    if (!w)
        return fail_memory(error, "window", sizeof *w);
    w->queue = queue;
    facet_result result = open_glfw(&w->glfw, error);
    if (result == FACET_OK && !w->glfw.init())
        result = fail_glfw(w, "there is no display to open one on", error);
    w->is_started = result == FACET_OK;
    if (result == FACET_OK && !create_handle(w, (int)width, (int)height))
        result = fail_glfw(w, "neither OpenGL 3.3 nor OpenGL ES 3.0 is there", error);
    if (result != FACET_OK) {
        view_window_destroy(w);
        return result;
    }
    listen(w);
    w->glfw.make_context_current(w->handle);
    w->glfw.swap_interval(1);
    w->is_damaged = true;
    uint32_t pixel_width;
    uint32_t pixel_height;
    view_window_size(w, &pixel_width, &pixel_height);
    if (pixel_width != width || pixel_height != height)
        view_window_resize(w, width, height);
    *out = w;
    return FACET_OK;
}

void view_window_destroy(view_window *w)
{
    if (!w)
        return;
    if (w->handle)
        w->glfw.destroy_window(w->handle);
    if (w->is_started)
        w->glfw.terminate();
    mem_free(w);
}

/* ---- operations ---- */

void view_window_show(view_window *w)
{
    w->glfw.show_window(w->handle);
}

void view_window_set_title(view_window *w, const char *title)
{
    w->glfw.set_window_title(w->handle, title);
}

void view_window_size(view_window *w, uint32_t *width, uint32_t *height)
{
    int x = 0;
    int y = 0;
    if (!w->is_minimised && !w->glfw.get_window_attrib(w->handle, GLFW_ICONIFIED))
        w->glfw.get_framebuffer_size(w->handle, &x, &y);
    bool is_empty = x <= 0 || y <= 0;
    *width = is_empty ? 0 : (uint32_t)x;
    *height = is_empty ? 0 : (uint32_t)y;
}

void view_window_resize(view_window *w, uint32_t width, uint32_t height)
{
    double x = 1.0; /* pixels per point */
    double y = 1.0;
    to_pixels(w, &x, &y);
    w->glfw.set_window_size(w->handle, (int)fmax(1.0, round(width / x)), (int)fmax(1.0, round(height / y)));
}

float view_window_scale(view_window *w)
{
    float x = 1.0f;
    float y = 1.0f;
    w->glfw.get_window_content_scale(w->handle, &x, &y);
    return y >= 1.0f && y <= 8.0f ? y : 1.0f;
}

/* The monitor that contains the window's middle; else the first. */
static GLFWmonitor *find_monitor(const view_window *w)
{
    int count = 0;
    GLFWmonitor **monitors = w->glfw.get_monitors(&count);
    int middle_x = w->old_x + w->old_width / 2;
    int middle_y = w->old_y + w->old_height / 2;
    for (int i = 0; i < count; i++) {
        int x;
        int y;
        const GLFWvidmode *mode = w->glfw.get_video_mode(monitors[i]);
        w->glfw.get_monitor_pos(monitors[i], &x, &y);
        if (mode && middle_x >= x && middle_x < x + mode->width && middle_y >= y &&
            middle_y < y + mode->height)
            return monitors[i];
    }
    return w->glfw.get_primary_monitor();
}

void view_window_toggle_full_screen(view_window *w)
{
    if (w->is_full_screen) {
        w->glfw.set_window_monitor(w->handle, NULL, w->old_x, w->old_y, w->old_width, w->old_height, 0);
        w->is_full_screen = false;
        return;
    }
    w->glfw.get_window_pos(w->handle, &w->old_x, &w->old_y);
    w->glfw.get_window_size(w->handle, &w->old_width, &w->old_height);
    GLFWmonitor *monitor = find_monitor(w);
    const GLFWvidmode *mode = monitor ? w->glfw.get_video_mode(monitor) : NULL;
    if (!mode)
        return;
    w->glfw.set_window_monitor(w->handle, monitor, 0, 0, mode->width, mode->height, mode->refreshRate);
    w->is_full_screen = true;
}

void view_window_minimise(view_window *w, bool is_minimised)
{
    w->is_minimised = is_minimised;
    if (is_minimised)
        w->glfw.iconify_window(w->handle);
    else
        w->glfw.restore_window(w->handle);
}

void view_window_copy(view_window *w, const char *text)
{
    w->glfw.set_clipboard_string(w->handle, text);
}

void view_window_present(view_window *w)
{
    w->glfw.swap_buffers(w->handle);
}

void view_window_wait(view_window *w, double seconds)
{
    if (!(seconds > 0.0))
        w->glfw.poll_events();
    else if (isinf(seconds))
        w->glfw.wait_events();
    else
        w->glfw.wait_events_timeout(seconds);
}

void view_window_wake(view_window *w)
{
    w->glfw.post_empty_event();
}

bool view_window_needs_drawing(view_window *w)
{
    uint32_t width;
    uint32_t height;
    view_window_size(w, &width, &height);
    bool needs = w->is_damaged || (int)width != w->drawn_width || (int)height != w->drawn_height;
    w->is_damaged = false;
    w->drawn_width = (int)width;
    w->drawn_height = (int)height;
    return needs;
}
