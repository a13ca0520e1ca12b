/* fuzz_support.h - shared by the fuzz targets: a memory budget, a silent log, bytes as a file. */
#ifndef FUZZ_SUPPORT_H
#define FUZZ_SUPPORT_H

#define _GNU_SOURCE /* include this first */
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/mman.h>
#include <unistd.h>

#include "facet/facet.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

/* A budget of limit_bytes for one input; fuzz_end() aborts if some of it is still in use. */
static inline facet_budget *fuzz_begin(uint64_t limit_bytes)
{
    facet_budget *budget = NULL;
    if (facet_budget_create(limit_bytes, &budget, NULL) != FACET_OK)
        abort();
    return budget;
}

static inline void fuzz_end(facet_budget *budget)
{
    if (facet_budget_used_bytes(budget) != 0)
        abort();
    facet_budget_destroy(budget);
}

static inline void fuzz_ignore(void *user, facet_log_level level, const char *message)
{
    (void)user;
    (void)level;
    if (message[0] == 0)
        abort();
}

/* A failure must have a message. */
static inline void fuzz_check_error(facet_result result, const facet_error *error)
{
    if (result != FACET_OK && error->message[0] == 0)
        abort();
}

/* The path of a file in memory, shared by all inputs, with data from offset 0 on. */
static inline const char *fuzz_file(const uint8_t *data, size_t size)
{
    static int fd = -1;
    static char path[32];
    if (fd < 0)
        fd = memfd_create("fuzz", 0);
    if (fd < 0 || ftruncate(fd, 0) != 0 || ftruncate(fd, (off_t)size) != 0 ||
        (size && pwrite(fd, data, size, 0) != (ssize_t)size))
        abort();
    snprintf(path, sizeof path, "/proc/self/fd/%d", fd);
    return path;
}

/* Takes up to count bytes from the front of the input; the rest of out is 0. */
static inline void fuzz_take(const uint8_t **data, size_t *size, void *out, size_t count)
{
    unsigned char *to = out;
    for (size_t i = 0; i < count; i++) {
        to[i] = *size ? **data : 0;
        *data += *size > 0;
        *size -= *size > 0;
    }
}

#endif
