/* view_input.h - the events of a window, from a user or a script, and the table of key bindings, which the
 * overlay, the documentation and tests read. */
#ifndef VIEW_VIEW_INPUT_H
#define VIEW_VIEW_INPUT_H

#include <stdbool.h>
#include <stdint.h>

/* ---- events ---- */

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

/* Keys that type a character are that character, letters in upper case. */
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
    char *path; /* DROP: a block of malloc(), owned by the receiver of the event */
} view_event;

/* Events wait here between the window, or a script, and the loop. */
enum { VIEW_QUEUE_SIZE = 256 };
typedef struct view_queue {
    view_event events[VIEW_QUEUE_SIZE];
    uint32_t first, count;
} view_queue;

/* Consecutive movements are merged. False: the queue is full, and the event, with its path, is dropped. */
bool view_queue_put(view_queue *q, view_event event);
bool view_queue_take(view_queue *q, view_event *event); /* false: empty */
void view_queue_clear(view_queue *q);

/* ---- keys ---- */

typedef enum view_action {
    VIEW_ACTION_NONE,
    VIEW_ACTION_MODEL, /* amount: steps in the list */
    VIEW_ACTION_RELOAD,
    VIEW_ACTION_VARIANT,
    VIEW_ACTION_FRAME,
    VIEW_ACTION_LOOK, /* amount: a view_direction */
    VIEW_ACTION_PROJECTION,
    VIEW_ACTION_CAMERA,
    VIEW_ACTION_PLAY,
    VIEW_ACTION_ANIMATION,
    VIEW_ACTION_SCRUB, /* amount: frames of 1/24 s */
    VIEW_ACTION_SPEED, /* amount: doublings */
    VIEW_ACTION_ENVIRONMENT,
    VIEW_ACTION_ENVIRONMENT_ROTATION,  /* amount: steps of 15 degrees */
    VIEW_ACTION_ENVIRONMENT_INTENSITY, /* amount: thirds of a stop */
    VIEW_ACTION_LIGHTS,
    VIEW_ACTION_SHADOWS,
    VIEW_ACTION_GROUND,
    VIEW_ACTION_BACKGROUND,
    VIEW_ACTION_BLUR,
    VIEW_ACTION_EXPOSURE, /* amount: thirds of a stop */
    VIEW_ACTION_TONEMAP,
    VIEW_ACTION_BLOOM,
    VIEW_ACTION_RENDERER,
    VIEW_ACTION_DENOISE,
    VIEW_ACTION_CHANNEL,
    VIEW_ACTION_WHOLE,
    VIEW_ACTION_BRDF,
    VIEW_ACTION_ENERGY,
    VIEW_ACTION_DIVIDER,
    VIEW_ACTION_TRANSPARENCY,
    VIEW_ACTION_HELP,
    VIEW_ACTION_VALUES,
    VIEW_ACTION_FULL_SCREEN,
    VIEW_ACTION_SCREENSHOT,
    VIEW_ACTION_COPY,
    VIEW_ACTION_PRINT,
    VIEW_ACTION_QUIT
} view_action;

typedef enum view_direction {
    VIEW_FRONT,
    VIEW_BACK,
    VIEW_RIGHT_SIDE,
    VIEW_LEFT_SIDE,
    VIEW_TOP,
    VIEW_BOTTOM,
    VIEW_OBLIQUE
} view_direction;

typedef struct view_binding {
    uint32_t key;
    unsigned modifiers;
    view_action action;
    int amount;
    const char *group; /* NULL: the same as in the previous line */
    const char *help;  /* NULL: the previous line describes it too */
} view_binding;

extern const view_binding view_bindings[];
extern const uint32_t view_binding_count;

/* NULL: the key is not bound. */
const view_binding *view_binding_find(uint32_t key, unsigned modifiers);

/* "Shift+L", "Left", "?", letters in any case. False: no such key. */
bool view_key_parse(const char *text, uint32_t *key, unsigned *modifiers);
/* The inverse; size of 32 is enough. */
void view_key_write(uint32_t key, unsigned modifiers, char *out, uint32_t size);

/* Help for the pointer, which belongs to no key. */
typedef struct view_pointer_help {
    const char *input, *help;
} view_pointer_help;
extern const view_pointer_help view_pointer_lines[];
extern const uint32_t view_pointer_line_count;

#endif
