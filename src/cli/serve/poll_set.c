/* poll_set.c - see poll_set.h. */
#include "cli/serve/poll_set.h"

#include <stdlib.h>

void poll_set_clear(poll_set *set, double moment)
{
    set->count = 0;
    set->moment = moment;
}

long poll_set_add(poll_set *set, int fd, short events)
{
    if (set->count == set->capacity) {
        size_t capacity = set->capacity ? 2 * set->capacity : 16;
        struct pollfd *grown = realloc(set->entries, capacity * sizeof *grown);
        if (!grown)
            return POLL_SET_NONE;
        set->entries = grown;
        set->capacity = capacity;
    }
    set->entries[set->count] = (struct pollfd){.fd = fd, .events = events};
    return (long)set->count++;
}

void poll_set_until(poll_set *set, double moment)
{
    if (moment < set->moment)
        set->moment = moment;
}

short poll_set_events(const poll_set *set, long index)
{
    return index < 0 ? 0 : set->entries[index].revents;
}

void poll_set_destroy(poll_set *set)
{
    free(set->entries);
    *set = (poll_set){0};
}
