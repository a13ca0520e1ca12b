/* poll_set.h - the descriptors that one turn of the loop waits for. */
#ifndef CLI_SERVE_POLL_SET_H
#define CLI_SERVE_POLL_SET_H

#include <poll.h>
#include <stddef.h>

typedef struct poll_set {
    struct pollfd *entries;
    size_t count, capacity;
    double moment; /* interrupt_clock() at which the turn ends at the latest */
} poll_set;

enum { POLL_SET_NONE = -1 };

/* Empties the set; the turn lasts until moment, unless poll_set_until() says earlier. */
void poll_set_clear(poll_set *set, double moment);
/* Adds a descriptor. Returns its index, or POLL_SET_NONE without memory. */
long poll_set_add(poll_set *set, int fd, short events);
void poll_set_until(poll_set *set, double moment);
/* The events of an entry after the wait; 0 for POLL_SET_NONE. */
short poll_set_events(const poll_set *set, long index);
void poll_set_destroy(poll_set *set);

#endif
