/* cairo_library.h - the functions of libcairo, loaded when something is drawn: linking it with its X11 and
 * font libraries would delay every start of a program by milliseconds. */
#ifndef PLOT_CAIRO_LIBRARY_H
#define PLOT_CAIRO_LIBRARY_H

#include <cairo.h>
#include <cairo-pdf.h>
#include <cairo-svg.h>

#include "base/library.h"

/* clang-format off */
#define CAIRO_FUNCTIONS(F, out) \
    F(out, cairo_image_surface_create_for_data, image_surface_create_for_data) \
    F(out, cairo_svg_surface_create_for_stream, svg_surface_create_for_stream) \
    F(out, cairo_svg_surface_set_document_unit, svg_surface_set_document_unit) \
    F(out, cairo_pdf_surface_create_for_stream, pdf_surface_create_for_stream) \
    F(out, cairo_pdf_surface_set_metadata, pdf_surface_set_metadata) \
    F(out, cairo_surface_finish, surface_finish) F(out, cairo_surface_flush, surface_flush) \
    F(out, cairo_surface_destroy, surface_destroy) F(out, cairo_surface_status, surface_status) \
    F(out, cairo_status_to_string, status_to_string) F(out, cairo_create, create) \
    F(out, cairo_destroy, destroy) F(out, cairo_status, status) F(out, cairo_save, save) \
    F(out, cairo_restore, restore) F(out, cairo_clip, clip) F(out, cairo_translate, translate) \
    F(out, cairo_scale, scale) F(out, cairo_rotate, rotate) F(out, cairo_new_path, new_path) \
    F(out, cairo_move_to, move_to) F(out, cairo_line_to, line_to) F(out, cairo_arc, arc) \
    F(out, cairo_rectangle, rectangle) F(out, cairo_close_path, close_path) \
    F(out, cairo_set_source_rgba, set_source_rgba) F(out, cairo_set_source_surface, set_source_surface) \
    F(out, cairo_get_source, get_source) F(out, cairo_pattern_set_filter, pattern_set_filter) \
    F(out, cairo_set_line_width, set_line_width) F(out, cairo_set_line_join, set_line_join) \
    F(out, cairo_set_line_cap, set_line_cap) F(out, cairo_set_dash, set_dash) \
    F(out, cairo_stroke, stroke) F(out, cairo_fill, fill) F(out, cairo_paint, paint) \
    F(out, cairo_select_font_face, select_font_face) F(out, cairo_set_font_size, set_font_size) \
    F(out, cairo_font_options_create, font_options_create) \
    F(out, cairo_font_options_destroy, font_options_destroy) \
    F(out, cairo_font_options_set_antialias, font_options_set_antialias) \
    F(out, cairo_font_options_set_hint_style, font_options_set_hint_style) \
    F(out, cairo_font_options_set_hint_metrics, font_options_set_hint_metrics) \
    F(out, cairo_set_font_options, set_font_options) F(out, cairo_text_extents, text_extents) \
    F(out, cairo_show_text, show_text)
/* clang-format on */

/* Members have cairo's names without "cairo_"; {0} is none. */
typedef struct cairo_library {
    void *handle;
    CAIRO_FUNCTIONS(LIBRARY_MEMBER, )
} cairo_library;

/* soname: "libcairo.so.2". FACET_ERROR_SYSTEM: it is not installed, or lacks a function. */
facet_result cairo_library_open(const char *soname, cairo_library *out, facet_error *error);
void cairo_library_close(cairo_library *l); /* {0} is allowed; leaves {0} */

#endif
