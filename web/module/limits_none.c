/* limits_none.c - see cli/shared/limits.h: a page has no files that tell its limits; the browser sets them. */
#include "cli/shared/limits.h"

#include "base/result.h"

facet_result limits_read(const command_line *c, limits *out, facet_error *error)
{
    (void)c, (void)error;
    *out = (limits){.thread_count = 1};
    return FACET_OK;
}

facet_result limits_start_clock(const command_line *c, facet_error *error)
{
    (void)c, (void)error;
    return FACET_OK;
}

uint64_t memory_peak(void)
{
    return 0;
}
