/* view_window.h - the window: GLFW's, with a context of OpenGL 3.3 or ES 3.0. Its input becomes events. */
#ifndef VIEW_VIEW_WINDOW_H
#define VIEW_VIEW_WINDOW_H

#include "view/view_input.h"

#include "facet/facet.h"

typedef struct view_window view_window;

/* Hidden until view_window_show(); its context is current. width, height: of the framebuffer as far as the
 * desktop allows. queue: where events go. Fails with FACET_ERROR_SYSTEM: no GLFW, no display, no OpenGL. */
facet_result view_window_create(const facet_allocator *allocator, uint32_t width, uint32_t height,
                                view_queue *queue, view_window **out, facet_error *error);
void view_window_destroy(view_window *w); /* NULL is allowed */

void view_window_show(view_window *w);
void view_window_set_title(view_window *w, const char *title);
/* Pixels of the framebuffer; 0 x 0 while it is minimised. */
void view_window_size(view_window *w, uint32_t *width, uint32_t *height);
void view_window_resize(view_window *w, uint32_t width, uint32_t height);
float view_window_scale(view_window *w); /* of text: 2 on dense displays */
void view_window_toggle_full_screen(view_window *w);
void view_window_minimise(view_window *w, bool is_minimised);
void view_window_copy(view_window *w, const char *text);
void view_window_present(view_window *w); /* swaps buffers */

/* Takes pending events; waits for one for up to that many seconds (0: not at all, INFINITY: forever). */
void view_window_wait(view_window *w, double seconds);
/* Ends a wait; from any thread. */
void view_window_wake(view_window *w);
/* Whether the content was damaged, or the size changed, since the last call. */
bool view_window_needs_drawing(view_window *w);

#endif
