/* http_library.c - see http_library.h. */
#include "cli/serve/http_library.h"

#include <dlfcn.h>

facet_result http_library_open(http_library *out, facet_error *error)
{
    *out = (http_library){0};
    const library_symbol symbols[] = {HTTP_FUNCTIONS(LIBRARY_SYMBOL, out)};
    /* It stays loaded: GnuTLS, which it opens, does not support unloading. */
    const library_desc desc = {
        .subject = "--http",
        .advice = ", which speaks HTTP, is not installed; install it (Debian: libmicrohttpd12)",
        .version = "; libmicrohttpd 0.9.71 or later was expected",
        .missing = FACET_ERROR_SYSTEM,
        .stays = true,
        .symbols = symbols,
        .symbol_count = sizeof symbols / sizeof *symbols};
    facet_result result = library_open(FACET_MICROHTTPD_SONAME, &desc, &out->handle, error);
    if (result != FACET_OK)
        http_library_close(out);
    return result;
}

void http_library_close(http_library *l)
{
    if (l->handle)
        dlclose(l->handle);
    *l = (http_library){0};
}
