/* cairo_library.c - see cairo_library.h. */
#include "plot/cairo_library.h"

#include <dlfcn.h>

facet_result cairo_library_open(const char *soname, cairo_library *out, facet_error *error)
{
    *out = (cairo_library){0};
    const library_symbol symbols[] = {CAIRO_FUNCTIONS(LIBRARY_SYMBOL, out)};
    /* libcairo stays loaded: its font libraries keep caches that unloading would leak. */
    const library_desc desc = {
        .subject = "plot",
        .advice = ", which draws SVG, PDF and PNG, is not installed; install it (Debian: libcairo2) or write "
                  "CSV, which needs no graphics library",
        .version = "; cairo 1.16 or later was expected (CSV needs no graphics library)",
        .missing = FACET_ERROR_SYSTEM,
        .stays = true,
        .symbols = symbols,
        .symbol_count = sizeof symbols / sizeof *symbols};
    facet_result result = library_open(soname, &desc, &out->handle, error);
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
