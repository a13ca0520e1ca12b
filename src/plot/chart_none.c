/* chart_none.c - chart_draw() in builds without cairo. */
#include "plot/chart.h"

#include "base/result.h"

facet_result chart_draw(const chart *c, facet_plot_format format, const facet_allocator *allocator,
                        unsigned char **bytes, size_t *size, facet_error *error)
{
    *bytes = NULL;
    *size = 0;
    if (format == FACET_PLOT_FORMAT_CSV)
        return chart_write_csv(c, allocator, bytes, size, error);
    return fail(error, FACET_ERROR_UNSUPPORTED,
                "plot: this build draws no SVG, PDF or PNG; build it with cairo 1.16 or later (Debian: "
                "libcairo2-dev) or write CSV, which needs no graphics library");
}
