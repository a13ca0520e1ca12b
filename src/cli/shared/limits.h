/* limits.h - what a command may use: threads, memory, time, sizes. */
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
/* Starts the clock of --time-limit, where it is given, for what is read before the other options: configurations and
 * lists of models may be pipes that nothing is written to. Fails with FACET_ERROR_ARGUMENT. */
facet_result limits_start_clock(const command_line *c, facet_error *error);

/* The most that the process had resident so far, bytes. */
uint64_t memory_peak(void);

#endif
