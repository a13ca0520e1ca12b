/* progress.h - how far the work is, on standard error: a bar, lines, or JSON. */
#ifndef CLI_PROGRESS_H
#define CLI_PROGRESS_H

#include "facet/facet.h"

typedef enum progress_mode { PROGRESS_NONE, PROGRESS_BAR, PROGRESS_PLAIN, PROGRESS_JSON } progress_mode;

/* mode_index is the position in the table's list: auto, plain, json, none. A bar is shown on a terminal, after
 * 0.3 s: what is done sooner needs none. */
progress_mode progress_choose(int mode_index, bool is_quiet);

/* One operation, perhaps one of several pictures. */
typedef struct progress {
    progress_mode mode;
    const char *subject;       /* the file that it is about */
    double start;              /* interrupt_clock() */
    double done_before, share; /* what this operation is of the whole: fraction = done_before + share * f */
    double last_shown;         /* interrupt_clock() */
    int last_percent;
    const char *last_stage;
} progress;

/* A callback that shows p and cancels when a signal has come. */
facet_progress progress_callback(progress *p);

/* Takes the bar off the terminal, if one is shown; for whoever writes to it. */
void progress_clear(void);

#endif
