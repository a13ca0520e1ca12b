/* view_event.c - see view_event.h. */
#include "view/view_event.h"

#include <stdlib.h>

bool view_queue_put(view_queue *q, view_event event)
{
    if (q->count > 0 && event.kind == VIEW_MOVE) {
        view_event *last = &q->events[(q->first + q->count - 1) % VIEW_QUEUE_SIZE];
        if (last->kind == VIEW_MOVE) {
            *last = event;
            return true;
        }
    }
    if (q->count == VIEW_QUEUE_SIZE) {
        free(event.path);
        return false;
    }
    q->events[(q->first + q->count++) % VIEW_QUEUE_SIZE] = event;
    return true;
}

bool view_queue_take(view_queue *q, view_event *event)
{
    if (q->count == 0)
        return false;
    *event = q->events[q->first];
    q->first = (q->first + 1) % VIEW_QUEUE_SIZE;
    q->count--;
    return true;
}

void view_queue_clear(view_queue *q)
{
    view_event event;
    while (view_queue_take(q, &event))
        free(event.path);
}
