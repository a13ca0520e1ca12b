/* view_event.h - what a person, or a script, does to a window. */
#ifndef VIEW_VIEW_EVENT_H
#define VIEW_VIEW_EVENT_H

#include <stdbool.h>
#include <stdint.h>

typedef enum view_event_kind {
    VIEW_KEY, /* pressed, or repeated while held */
    VIEW_PRESS,
    VIEW_RELEASE,
    VIEW_MOVE,
    VIEW_SCROLL,
    VIEW_DROP,
    VIEW_CLOSE
} view_event_kind;

enum { VIEW_SHIFT = 1 << 0, VIEW_CONTROL = 1 << 1, VIEW_ALT = 1 << 2 };

typedef enum view_button { VIEW_LEFT_BUTTON, VIEW_RIGHT_BUTTON, VIEW_MIDDLE_BUTTON } view_button;

/* Keys that write a character are that character, letters in upper case. */
enum {
    VIEW_KEY_LEFT = 256,
    VIEW_KEY_RIGHT,
    VIEW_KEY_UP,
    VIEW_KEY_DOWN,
    VIEW_KEY_ENTER,
    VIEW_KEY_ESCAPE,
    VIEW_KEY_TAB,
    VIEW_KEY_HOME,
    VIEW_KEY_F11,
    VIEW_KEY_F12
};

typedef struct view_event {
    view_event_kind kind;
    uint32_t key;
    unsigned modifiers;
    view_button button;
    double x,
        y; /* pointer, pixels of the framebuffer from its top left; SCROLL: steps, positive: right, away */
    char *path; /* DROP: a block of malloc(), whose owner is who takes the event from its queue */
} view_event;

/* Events wait here between the window, or a script, and the loop. */
enum { VIEW_QUEUE_SIZE = 256 };
typedef struct view_queue {
    view_event events[VIEW_QUEUE_SIZE];
    uint32_t first, count;
} view_queue;

/* Movements that follow each other become one. False: it is full, and the event, with its path, is lost. */
bool view_queue_put(view_queue *q, view_event event);
bool view_queue_take(view_queue *q, view_event *event); /* false: empty */
void view_queue_clear(view_queue *q);

#endif
