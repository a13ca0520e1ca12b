/* cairo_library.h - the functions of libcairo that are called, found when something is drawn: linked, its X11 and
 * font libraries would cost every start of a program milliseconds. */
#ifndef PLOT_CAIRO_LIBRARY_H
#define PLOT_CAIRO_LIBRARY_H

#include <cairo.h>
#include <cairo-pdf.h>
#include <cairo-svg.h>

#include "facet/facet.h"

/* Each name is that of cairo without "cairo_"; {0} is none. */
typedef struct cairo_library {
    void *handle;
    cairo_surface_t *(*image_surface_create_for_data)(unsigned char *, cairo_format_t, int, int, int);
    cairo_surface_t *(*svg_surface_create_for_stream)(cairo_write_func_t, void *, double, double);
    void (*svg_surface_set_document_unit)(cairo_surface_t *, cairo_svg_unit_t);
    cairo_surface_t *(*pdf_surface_create_for_stream)(cairo_write_func_t, void *, double, double);
    void (*pdf_surface_set_metadata)(cairo_surface_t *, cairo_pdf_metadata_t, const char *);
    void (*surface_finish)(cairo_surface_t *);
    void (*surface_flush)(cairo_surface_t *);
    void (*surface_destroy)(cairo_surface_t *);
    cairo_status_t (*surface_status)(cairo_surface_t *);
    const char *(*status_to_string)(cairo_status_t);
    cairo_t *(*create)(cairo_surface_t *);
    void (*destroy)(cairo_t *);
    cairo_status_t (*status)(cairo_t *);
    void (*save)(cairo_t *);
    void (*restore)(cairo_t *);
    void (*clip)(cairo_t *);
    void (*translate)(cairo_t *, double, double);
    void (*scale)(cairo_t *, double, double);
    void (*rotate)(cairo_t *, double);
    void (*new_path)(cairo_t *);
    void (*move_to)(cairo_t *, double, double);
    void (*line_to)(cairo_t *, double, double);
    void (*arc)(cairo_t *, double, double, double, double, double);
    void (*rectangle)(cairo_t *, double, double, double, double);
    void (*close_path)(cairo_t *);
    void (*set_source_rgba)(cairo_t *, double, double, double, double);
    void (*set_source_surface)(cairo_t *, cairo_surface_t *, double, double);
    cairo_pattern_t *(*get_source)(cairo_t *);
    void (*pattern_set_filter)(cairo_pattern_t *, cairo_filter_t);
    void (*set_line_width)(cairo_t *, double);
    void (*set_line_join)(cairo_t *, cairo_line_join_t);
    void (*set_line_cap)(cairo_t *, cairo_line_cap_t);
    void (*set_dash)(cairo_t *, const double *, int, double);
    void (*stroke)(cairo_t *);
    void (*fill)(cairo_t *);
    void (*paint)(cairo_t *);
    void (*select_font_face)(cairo_t *, const char *, cairo_font_slant_t, cairo_font_weight_t);
    void (*set_font_size)(cairo_t *, double);
    cairo_font_options_t *(*font_options_create)(void);
    void (*font_options_destroy)(cairo_font_options_t *);
    void (*font_options_set_antialias)(cairo_font_options_t *, cairo_antialias_t);
    void (*font_options_set_hint_style)(cairo_font_options_t *, cairo_hint_style_t);
    void (*font_options_set_hint_metrics)(cairo_font_options_t *, cairo_hint_metrics_t);
    void (*set_font_options)(cairo_t *, const cairo_font_options_t *);
    void (*text_extents)(cairo_t *, const char *, cairo_text_extents_t *);
    void (*show_text)(cairo_t *, const char *);
} cairo_library;

/* soname: "libcairo.so.2". FACET_ERROR_SYSTEM: it is not installed, or lacks a function. */
facet_result cairo_library_open(const char *soname, cairo_library *out, facet_error *error);
void cairo_library_close(cairo_library *l); /* {0} is allowed; leaves {0} */

#endif
