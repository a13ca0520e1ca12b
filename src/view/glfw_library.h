/* glfw_library.h - GLFW, opened when a window is wanted: machines without a display need no window library. */
#ifndef VIEW_GLFW_LIBRARY_H
#define VIEW_GLFW_LIBRARY_H

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include "facet/facet.h"

/* Its functions by GLFW's names. */
typedef struct glfw_library {
    void *handle;
    int (*init)(void);
    void (*terminate)(void);
    int (*get_error)(const char **description);
    void (*window_hint)(int hint, int value);
    void (*window_hint_string)(int hint, const char *value);
    GLFWwindow *(*create_window)(int width, int height, const char *title, GLFWmonitor *monitor,
                                 GLFWwindow *share);
    void (*destroy_window)(GLFWwindow *window);
    void (*show_window)(GLFWwindow *window);
    void (*iconify_window)(GLFWwindow *window);
    void (*restore_window)(GLFWwindow *window);
    int (*get_window_attrib)(GLFWwindow *window, int attribute);
    void (*set_window_title)(GLFWwindow *window, const char *title);
    void (*set_window_user_pointer)(GLFWwindow *window, void *pointer);
    void *(*get_window_user_pointer)(GLFWwindow *window);
    void (*get_window_size)(GLFWwindow *window, int *width, int *height);
    void (*set_window_size)(GLFWwindow *window, int width, int height);
    void (*get_window_pos)(GLFWwindow *window, int *x, int *y);
    void (*get_framebuffer_size)(GLFWwindow *window, int *width, int *height);
    void (*get_window_content_scale)(GLFWwindow *window, float *x, float *y);
    GLFWmonitor *(*get_primary_monitor)(void);
    GLFWmonitor **(*get_monitors)(int *count);
    void (*get_monitor_pos)(GLFWmonitor *monitor, int *x, int *y);
    const GLFWvidmode *(*get_video_mode)(GLFWmonitor *monitor);
    void (*set_window_monitor)(GLFWwindow *window, GLFWmonitor *monitor, int x, int y, int width, int height,
                               int rate);
    void (*make_context_current)(GLFWwindow *window);
    void (*swap_interval)(int interval);
    void (*swap_buffers)(GLFWwindow *window);
    void (*poll_events)(void);
    void (*wait_events)(void);
    void (*wait_events_timeout)(double timeout);
    void (*post_empty_event)(void);
    int (*get_key)(GLFWwindow *window, int key);
    const char *(*get_key_name)(int key, int scancode);
    void (*set_clipboard_string)(GLFWwindow *window, const char *text);
    GLFWkeyfun (*set_key_callback)(GLFWwindow *window, GLFWkeyfun function);
    GLFWcharfun (*set_char_callback)(GLFWwindow *window, GLFWcharfun function);
    GLFWmousebuttonfun (*set_mouse_button_callback)(GLFWwindow *window, GLFWmousebuttonfun function);
    GLFWcursorposfun (*set_cursor_pos_callback)(GLFWwindow *window, GLFWcursorposfun function);
    GLFWscrollfun (*set_scroll_callback)(GLFWwindow *window, GLFWscrollfun function);
    GLFWdropfun (*set_drop_callback)(GLFWwindow *window, GLFWdropfun function);
    GLFWwindowclosefun (*set_window_close_callback)(GLFWwindow *window, GLFWwindowclosefun function);
    GLFWwindowrefreshfun (*set_window_refresh_callback)(GLFWwindow *window, GLFWwindowrefreshfun function);
} glfw_library;

/* name: of the library, such as "libglfw.so.3". Fails with FACET_ERROR_SYSTEM: it is not installed, or too old. */
facet_result glfw_library_open(const char *name, glfw_library *out, facet_error *error);

#endif
