/* limits.c - limits of a command, and the memory of this machine or container. */
#define _DEFAULT_SOURCE
#include "cli/shared/limits.h"

#include "cli/shared/interrupt.h"
#include "cli/shared/value.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <unistd.h>

/* The number in a one-line file; 0: none, or "max". */
static uint64_t read_number(const char *path)
{
    FILE *file = fopen(path, "re");
    if (!file)
        return 0;
    char line[64] = "";
    if (!fgets(line, sizeof line, file))
        line[0] = 0;
    fclose(file);
    return line[0] >= '0' && line[0] <= '9' ? strtoull(line, NULL, 10) : 0;
}

static uint64_t smaller(uint64_t a, uint64_t b)
{
    return b > 0 && b < a ? b : a;
}

/* Path of this process in the unified hierarchy (cgroup v2), "" at its root. */
static void group_path(char *path, size_t size)
{
    path[0] = 0;
    FILE *file = fopen("/proc/self/cgroup", "re");
    if (!file)
        return;
    char line[1024];
    while (fgets(line, sizeof line, file))
        if (strncmp(line, "0::/", 4) == 0) {
            line[strcspn(line, "\n")] = 0;
            snprintf(path, size, "%.*s", (int)size - 1, strcmp(line + 3, "/") == 0 ? "" : line + 3);
        }
    fclose(file);
}

/* 80 % of the smaller of the machine's memory and the limit of the control group, bytes; 0: unknown. */
static uint64_t memory_limit_default(void)
{
    long pages = sysconf(_SC_PHYS_PAGES), page = sysconf(_SC_PAGESIZE);
    if (pages <= 0 || page <= 0)
        return 0;
    uint64_t limit = (uint64_t)pages * (uint64_t)page;
    /* parent groups limit this one, too */
    char group[1024], path[1100];
    group_path(group, sizeof group);
    for (;;) {
        snprintf(path, sizeof path, "/sys/fs/cgroup%s/memory.max", group);
        limit = smaller(limit, read_number(path));
        char *slash = strrchr(group, '/');
        if (!slash)
            break;
        *slash = 0;
    }
    limit = smaller(limit, read_number("/sys/fs/cgroup/memory/memory.limit_in_bytes")); /* cgroup v1 */
    return limit / 5 * 4;
}

uint64_t memory_peak(void)
{
    struct rusage usage;
    if (getrusage(RUSAGE_SELF, &usage) != 0)
        return 0;
    return (uint64_t)usage.ru_maxrss * 1024; /* Linux counts in KiB */
}

/* *seconds is unchanged without a limit. */
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
