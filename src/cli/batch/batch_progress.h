/* batch_progress.h - how far a batch is: a line that replaces itself on a terminal, lines, or JSON. */
#ifndef CLI_BATCH_PROGRESS_H
#define CLI_BATCH_PROGRESS_H

#include "cli/shared/messages.h"

typedef struct batch_progress {
    progress_mode mode;
    double start, last_shown;    /* interrupt_clock() */
    uint64_t total;              /* UINT64_MAX: unknown */
    uint64_t done, kept, failed; /* items so far; kept: done by an earlier run */
    unsigned running;
} batch_progress;

/* Shows it if it is time to; name is an item that has just ended (NULL: none). is_last: in any case. */
void batch_progress_show(batch_progress *p, const char *name, bool is_last);

/* Time as people write it: "12 s", "3 min 20 s", "2 h 5 min". */
enum { BATCH_TIME_SIZE = 32 };
void batch_time_text(double seconds, char text[BATCH_TIME_SIZE]);

#endif
