/* chart.c - see chart.h. */
#include "plot/chart.h"

#include "base/result.h"

facet_result chart_draw(const chart *c, facet_plot_format format, const facet_allocator *allocator,
                        unsigned char **bytes, size_t *size, facet_error *error)
{
    (void)c;
    (void)format;
    (void)allocator;
    (void)bytes;
    (void)size;
    return fail(error, FACET_ERROR_UNSUPPORTED, "plot: not built yet");
}

facet_result chart_write_csv(const chart *c, const facet_allocator *allocator, unsigned char **bytes,
                             size_t *size, facet_error *error)
{
    (void)c;
    (void)allocator;
    (void)bytes;
    (void)size;
    return fail(error, FACET_ERROR_UNSUPPORTED, "plot: not built yet");
}
