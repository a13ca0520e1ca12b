/* limits.c - what a command may use. */
#include "cli/shared/limits.h"

#include "cli/shared/interrupt.h"
#include "cli/shared/memory_limit.h"
#include "cli/shared/value.h"

/* *seconds stays where no limit is given. */
static facet_result read_time_limit(const command_line *c, double *seconds, facet_error *error)
{
    if (is_given(c, OPT_TIME_LIMIT) && !value_seconds(option_text(c, OPT_TIME_LIMIT, ""), seconds))
        return option_fail(c, OPT_TIME_LIMIT, "a time such as 30s, 500ms or 5m", error);
    return FACET_OK;
}

facet_result limits_read(const command_line *c, limits *out, facet_error *error)
{
    *out = (limits){.thread_count = (uint32_t)option_number(c, OPT_THREADS, 0.0),
                    .max_texture_size = (uint32_t)option_number(c, OPT_MAX_TEXTURE, 0.0)};
    if (!is_given(c, OPT_MAX_MEMORY))
        out->max_memory_bytes = memory_limit_default();
    else if (!value_bytes(option_text(c, OPT_MAX_MEMORY, ""), &out->max_memory_bytes))
        return option_fail(c, OPT_MAX_MEMORY, "a size such as 512M or 2G", error);
    return read_time_limit(c, &out->time_limit_s, error);
}

facet_result limits_start_clock(const command_line *c, facet_error *error)
{
    double seconds = 0.0;
    facet_result result = read_time_limit(c, &seconds, error);
    if (result == FACET_OK && seconds > 0.0)
        interrupt_set_deadline(seconds);
    return result;
}
