/* plot.c - see plot.h. */
#include "plot/plot.h"

#include "base/result.h"

facet_result plot_create(const facet_plot_desc *desc, arena *memory, chart *out, facet_error *error)
{
    (void)desc;
    (void)memory;
    (void)out;
    return fail(error, FACET_ERROR_UNSUPPORTED, "plot: not built yet");
}
