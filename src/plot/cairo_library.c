/* cairo_library.c - see cairo_library.h. */
#include "plot/cairo_library.h"

#include <dlfcn.h>

#include <string.h>

#include "base/library.h"
#include "base/result.h"

static facet_result find_functions(cairo_library *out, const char *soname, facet_error *error)
{
    const struct {
        const char *symbol;
        void *place; /* of the pointer */
    } functions[] = {{"cairo_image_surface_create_for_data", &out->image_surface_create_for_data},
                     {"cairo_svg_surface_create_for_stream", &out->svg_surface_create_for_stream},
                     {"cairo_svg_surface_set_document_unit", &out->svg_surface_set_document_unit},
                     {"cairo_pdf_surface_create_for_stream", &out->pdf_surface_create_for_stream},
                     {"cairo_pdf_surface_set_metadata", &out->pdf_surface_set_metadata},
                     {"cairo_surface_finish", &out->surface_finish},
                     {"cairo_surface_flush", &out->surface_flush},
                     {"cairo_surface_destroy", &out->surface_destroy},
                     {"cairo_surface_status", &out->surface_status},
                     {"cairo_status_to_string", &out->status_to_string},
                     {"cairo_create", &out->create},
                     {"cairo_destroy", &out->destroy},
                     {"cairo_status", &out->status},
                     {"cairo_save", &out->save},
                     {"cairo_restore", &out->restore},
                     {"cairo_clip", &out->clip},
                     {"cairo_translate", &out->translate},
                     {"cairo_scale", &out->scale},
                     {"cairo_rotate", &out->rotate},
                     {"cairo_new_path", &out->new_path},
                     {"cairo_move_to", &out->move_to},
                     {"cairo_line_to", &out->line_to},
                     {"cairo_arc", &out->arc},
                     {"cairo_rectangle", &out->rectangle},
                     {"cairo_close_path", &out->close_path},
                     {"cairo_set_source_rgba", &out->set_source_rgba},
                     {"cairo_set_source_surface", &out->set_source_surface},
                     {"cairo_get_source", &out->get_source},
                     {"cairo_pattern_set_filter", &out->pattern_set_filter},
                     {"cairo_set_line_width", &out->set_line_width},
                     {"cairo_set_line_join", &out->set_line_join},
                     {"cairo_set_line_cap", &out->set_line_cap},
                     {"cairo_set_dash", &out->set_dash},
                     {"cairo_stroke", &out->stroke},
                     {"cairo_fill", &out->fill},
                     {"cairo_paint", &out->paint},
                     {"cairo_select_font_face", &out->select_font_face},
                     {"cairo_set_font_size", &out->set_font_size},
                     {"cairo_font_options_create", &out->font_options_create},
                     {"cairo_font_options_destroy", &out->font_options_destroy},
                     {"cairo_font_options_set_antialias", &out->font_options_set_antialias},
                     {"cairo_font_options_set_hint_style", &out->font_options_set_hint_style},
                     {"cairo_font_options_set_hint_metrics", &out->font_options_set_hint_metrics},
                     {"cairo_set_font_options", &out->set_font_options},
                     {"cairo_text_extents", &out->text_extents},
                     {"cairo_show_text", &out->show_text}};
    for (size_t i = 0; i < sizeof functions / sizeof *functions; i++) {
        void *symbol = dlsym(out->handle, functions[i].symbol);
        if (!symbol)
            return fail(
                error, FACET_ERROR_SYSTEM,
                "plot: %s has no %s; cairo 1.16 or later was expected (CSV needs no graphics library)",
                soname, functions[i].symbol);
        memcpy(functions[i].place, &symbol, sizeof symbol);
    }
    return FACET_OK;
}

facet_result cairo_library_open(const char *soname, cairo_library *out, facet_error *error)
{
    *out = (cairo_library){0};
    /* RTLD_NODELETE: it and its font libraries keep caches that unloading would leak */
    const library_desc desc = {
        .subject = "plot",
        .advice = ", which draws SVG, PDF and PNG, is not installed; install it (Debian: libcairo2) or write "
                  "CSV, which needs no graphics library",
        .missing = FACET_ERROR_SYSTEM,
        .stays = true};
    facet_result result = library_open(soname, &desc, &out->handle, error);
    if (result == FACET_OK)
        result = find_functions(out, soname, error);
    if (result != FACET_OK)
        cairo_library_close(out);
    return result;
}

void cairo_library_close(cairo_library *l)
{
    if (l->handle)
        dlclose(l->handle);
    *l = (cairo_library){0};
}
