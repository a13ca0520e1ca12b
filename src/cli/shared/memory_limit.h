/* memory_limit.h - how much memory this process may take. */
#ifndef CLI_MEMORY_LIMIT_H
#define CLI_MEMORY_LIMIT_H

#include <stdint.h>

/* 80 % of the smaller of the machine's memory and the limit of the control group, bytes; 0: unknown. */
uint64_t memory_limit_default(void);
/* The most that the process had resident so far, bytes. */
uint64_t memory_peak(void);

#endif
