/* limits.h - limits of a command: threads, memory, time, sizes. */
#ifndef CLI_LIMITS_H
#define CLI_LIMITS_H

#include "cli/shared/command_line.h"

typedef struct limits {
    uint32_t thread_count, max_texture_size; /* 0: the library's default */
    uint64_t max_memory_bytes;               /* 0: no limit */
    double time_limit_s;                     /* 0: none */
} limits;

/* Reads --threads, --max-memory, --max-texture, --time-limit. Fails with FACET_ERROR_ARGUMENT. */
facet_result limits_read(const command_line *c, limits *out, facet_error *error);
/* Starts --time-limit, if given, before the other options are read: configurations and lists of models may
 * be pipes without a writer. Fails with FACET_ERROR_ARGUMENT. */
facet_result limits_start_clock(const command_line *c, facet_error *error);

/* Peak resident memory of the process, bytes. */
uint64_t memory_peak(void);

#endif
