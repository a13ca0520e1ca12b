/* view_draw.h - image rectangles on the window: the model, path traced images, panels of text. */
#ifndef VIEW_VIEW_DRAW_H
#define VIEW_VIEW_DRAW_H

#include "gl/core/gl_context.h"

/* A texture of RGBA8, and its framebuffer where it is rendered to. {0}: none. */
typedef struct view_surface {
    uint32_t width, height;
    uint32_t texture, framebuffer;
    bool is_upside_down; /* rows from the top, as uploaded; OpenGL's rows begin at the bottom */
} view_surface;

/* As a render target. FACET_ERROR_MEMORY. */
facet_result view_surface_resize(view_surface *s, gl_context *context, uint32_t width, uint32_t height,
                                 facet_error *error);
void view_surface_upload(view_surface *s, uint32_t width, uint32_t height, const unsigned char *pixels);
/* Its pixels, rows from the top. pixels: width * height * 4 bytes. */
void view_surface_read(const view_surface *s, unsigned char *pixels);
void view_surface_destroy(view_surface *s);

/* How an image is composed onto the window. */
typedef enum view_laying {
    VIEW_LAY_IMAGE, /* straight alpha, over a checkerboard */
    VIEW_LAY_PANEL  /* premultiplied alpha, over the existing content */
} view_laying;

typedef struct view_draw view_draw;
facet_result view_draw_create(gl_context *context, const facet_allocator *allocator, view_draw **out,
                              facet_error *error);
void view_draw_destroy(view_draw *d); /* NULL is allowed */

/* Draws into that framebuffer (0: the window's) of that size from now on. square: of the checkerboard,
 * pixels. */
void view_draw_begin(view_draw *d, uint32_t framebuffer, uint32_t width, uint32_t height, float square);
/* x, y: of the top left corner, pixels from the top left. left, right: columns of the window; the
 * rectangle is clipped to them. */
void view_draw_surface(view_draw *d, const view_surface *s, view_laying laying, int x, int y, uint32_t width,
                       uint32_t height, int left, int right);
/* A vertical line, width pixels around x, of one color. */
void view_draw_bar(view_draw *d, int x, int width, const float color[4]);

#endif
