/* memory_limit.c - how much memory this process may take: the machine's, or the container's. */
#define _DEFAULT_SOURCE
#include "cli/shared/memory_limit.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <unistd.h>

/* The number in a file of one line; 0: there is none, or it says "max". */
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

uint64_t memory_limit_default(void)
{
    long pages = sysconf(_SC_PHYS_PAGES), page = sysconf(_SC_PAGESIZE);
    if (pages <= 0 || page <= 0)
        return 0;
    uint64_t limit = (uint64_t)pages * (uint64_t)page;
    /* every group above this one limits it too */
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
