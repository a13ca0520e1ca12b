/* glfw_library.c - see glfw_library.h. */
#include "view/glfw_library.h"

#include <dlfcn.h>
#include <string.h>

#include "base/library.h"
#include "base/result.h"

facet_result glfw_library_open(const char *name, glfw_library *out, facet_error *error)
{
    const struct {
        const char *symbol;
        void *place; /* of the pointer */
    } functions[] = {{"glfwInit", &out->init},
                     {"glfwTerminate", &out->terminate},
                     {"glfwGetError", &out->get_error},
                     {"glfwWindowHint", &out->window_hint},
                     {"glfwWindowHintString", &out->window_hint_string},
                     {"glfwCreateWindow", &out->create_window},
                     {"glfwDestroyWindow", &out->destroy_window},
                     {"glfwShowWindow", &out->show_window},
                     {"glfwIconifyWindow", &out->iconify_window},
                     {"glfwRestoreWindow", &out->restore_window},
                     {"glfwGetWindowAttrib", &out->get_window_attrib},
                     {"glfwSetWindowTitle", &out->set_window_title},
                     {"glfwSetWindowUserPointer", &out->set_window_user_pointer},
                     {"glfwGetWindowUserPointer", &out->get_window_user_pointer},
                     {"glfwGetWindowSize", &out->get_window_size},
                     {"glfwSetWindowSize", &out->set_window_size},
                     {"glfwGetWindowPos", &out->get_window_pos},
                     {"glfwGetFramebufferSize", &out->get_framebuffer_size},
                     {"glfwGetWindowContentScale", &out->get_window_content_scale},
                     {"glfwGetPrimaryMonitor", &out->get_primary_monitor},
                     {"glfwGetMonitors", &out->get_monitors},
                     {"glfwGetMonitorPos", &out->get_monitor_pos},
                     {"glfwGetVideoMode", &out->get_video_mode},
                     {"glfwSetWindowMonitor", &out->set_window_monitor},
                     {"glfwMakeContextCurrent", &out->make_context_current},
                     {"glfwSwapInterval", &out->swap_interval},
                     {"glfwSwapBuffers", &out->swap_buffers},
                     {"glfwPollEvents", &out->poll_events},
                     {"glfwWaitEvents", &out->wait_events},
                     {"glfwWaitEventsTimeout", &out->wait_events_timeout},
                     {"glfwPostEmptyEvent", &out->post_empty_event},
                     {"glfwGetKey", &out->get_key},
                     {"glfwGetKeyName", &out->get_key_name},
                     {"glfwSetClipboardString", &out->set_clipboard_string},
                     {"glfwSetKeyCallback", &out->set_key_callback},
                     {"glfwSetCharCallback", &out->set_char_callback},
                     {"glfwSetMouseButtonCallback", &out->set_mouse_button_callback},
                     {"glfwSetCursorPosCallback", &out->set_cursor_pos_callback},
                     {"glfwSetScrollCallback", &out->set_scroll_callback},
                     {"glfwSetDropCallback", &out->set_drop_callback},
                     {"glfwSetWindowCloseCallback", &out->set_window_close_callback},
                     {"glfwSetWindowRefreshCallback", &out->set_window_refresh_callback}};
    *out = (glfw_library){0};
    /* RTLD_NODELETE: it opens libraries of the display that do not bear being unloaded */
    const library_desc desc = {.subject = "window",
                               .advice = ", which opens windows, is not installed (Debian: libglfw3)",
                               .missing = FACET_ERROR_SYSTEM,
                               .stays = true};
    facet_result result = library_open(name, &desc, &out->handle, error);
    if (result != FACET_OK)
        return result;
    for (size_t i = 0; i < sizeof functions / sizeof *functions; i++) {
        void *symbol = dlsym(out->handle, functions[i].symbol);
        if (!symbol)
            return fail(error, FACET_ERROR_SYSTEM, "window: %s has no %s; GLFW 3.3 or later was expected",
                        name, functions[i].symbol);
        memcpy(functions[i].place, &symbol, sizeof symbol);
    }
    return FACET_OK;
}
