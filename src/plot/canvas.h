/* canvas.h - the canvas of a chart: paths, text and images in pixels, y down. cairo_canvas.c draws SVG, PDF and PNG;
 * svg_canvas.c, in builds without cairo, SVG only.
 *
 * Drawing errors are kept and returned by canvas_finish(). Coordinates beyond 1e6 px overflow in cairo: clip
 * first. */
#ifndef PLOT_CANVAS_H
#define PLOT_CANVAS_H

#include "base/memory.h"
#include "facet/facet.h"

typedef struct canvas canvas;

typedef struct canvas_color {
    double r, g, b, a; /* sRGB, straight, [0, 1] */
} canvas_color;

typedef struct canvas_stroke {
    canvas_color color;
    double width;
    double dash[4]; /* on, off, on, off */
    int dash_count; /* 0: solid */
    double dash_offset;
    bool is_butt; /* butt caps; else round */
} canvas_stroke;

typedef struct canvas_font {
    double size; /* px */
    bool is_bold;
} canvas_font;

typedef struct canvas_desc {
    facet_allocator allocator;
    facet_plot_format format; /* not CSV */
    uint32_t width, height;   /* px, at most CANVAS_MAX_SIZE */
    const char *title;        /* metadata of the file; UTF-8 */
    const char *library;      /* NULL: the libcairo that facet was built with; another one for tests */
} canvas_desc;

enum { CANVAS_MAX_SIZE = 16384 };

/* FACET_ERROR_SYSTEM, FACET_ERROR_UNSUPPORTED: cairo is missing; FACET_ERROR_MEMORY. */
facet_result canvas_create(const canvas_desc *desc, canvas **out, facet_error *error);
void canvas_destroy(canvas *c); /* NULL is allowed */
/* The bytes of the file, a block of mem_alloc(), and their count. Nothing can be drawn afterwards. */
facet_result canvas_finish(canvas *c, unsigned char **bytes, size_t *size, facet_error *error);

/* The pixels of a raster canvas instead: width * height, premultiplied 0xAARRGGBB, owned by the canvas. */
facet_result canvas_read(canvas *c, const uint32_t **pixels, facet_error *error);

bool canvas_is_raster(const canvas *c); /* pixels of the canvas are pixels of the file */

/* A path, then fill, stroke or clip, which end it. A clip holds until the matching canvas_restore(). */
void canvas_save(canvas *c);
void canvas_restore(canvas *c);
void canvas_move_to(canvas *c, double x, double y);
void canvas_line_to(canvas *c, double x, double y);
void canvas_rectangle(canvas *c, double x, double y, double width, double height);
/* Around (x, y) between two angles, rad, clockwise from the right, since y points down. */
void canvas_arc(canvas *c, double x, double y, double radius, double from_rad, double to_rad);
void canvas_close(canvas *c);
void canvas_clip(canvas *c);
void canvas_fill(canvas *c, canvas_color color);
void canvas_draw(canvas *c, const canvas_stroke *stroke);

/* text is valid UTF-8 without control characters (see label_clean()), drawn from (x, y) along the
 * baseline, rotated clockwise by angle_rad. */
double canvas_text_width(canvas *c, canvas_font font, const char *text);
void canvas_text(canvas *c, double x, double y, double angle_rad, canvas_font font, canvas_color color,
                 const char *text);

/* An image over a rectangle; pixels: width * height, premultiplied 0xAARRGGBB. */
void canvas_image(canvas *c, double x, double y, double width, double height, uint32_t *pixels,
                  uint32_t pixel_width, uint32_t pixel_height);

#endif
