/* view_input.c - see view_input.h. The keys follow f3d, the views Blender's number pad. */
#include "view/view_input.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

/* ---- events ---- */

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

/* ---- keys ---- */

#define SHIFT VIEW_SHIFT
#define CONTROL VIEW_CONTROL

const view_binding view_bindings[] = {
    {VIEW_KEY_LEFT, 0, VIEW_ACTION_MODEL, -1, "Model", "previous, next model of the folder"},
    {VIEW_KEY_RIGHT, 0, VIEW_ACTION_MODEL, 1, NULL, NULL},
    {VIEW_KEY_UP, 0, VIEW_ACTION_RELOAD, 0, NULL, "read the model again (it is when its files change)"},
    {'V', 0, VIEW_ACTION_VARIANT, 1, NULL, "next, previous variant of the materials"},
    {'V', SHIFT, VIEW_ACTION_VARIANT, -1, NULL, NULL},

    {VIEW_KEY_ENTER, 0, VIEW_ACTION_FRAME, 0, "Camera", "show the whole model"},
    {VIEW_KEY_HOME, 0, VIEW_ACTION_FRAME, 0, NULL, NULL},
    {'.', 0, VIEW_ACTION_FRAME, 0, NULL, NULL},
    {'1', 0, VIEW_ACTION_LOOK, VIEW_FRONT, NULL, "from the front, from behind"},
    {'1', CONTROL, VIEW_ACTION_LOOK, VIEW_BACK, NULL, NULL},
    {'3', 0, VIEW_ACTION_LOOK, VIEW_RIGHT_SIDE, NULL, "from the right, from the left"},
    {'3', CONTROL, VIEW_ACTION_LOOK, VIEW_LEFT_SIDE, NULL, NULL},
    {'7', 0, VIEW_ACTION_LOOK, VIEW_TOP, NULL, "from above, from below"},
    {'7', CONTROL, VIEW_ACTION_LOOK, VIEW_BOTTOM, NULL, NULL},
    {'9', 0, VIEW_ACTION_LOOK, VIEW_OBLIQUE, NULL, "at an angle"},
    {'5', 0, VIEW_ACTION_PROJECTION, 0, NULL, "perspective or parallel"},
    {'C', 0, VIEW_ACTION_CAMERA, 1, NULL, "next camera of the file, or none"},

    {' ', 0, VIEW_ACTION_PLAY, 0, "Animation", "play, pause"},
    {'W', 0, VIEW_ACTION_ANIMATION, 1, NULL, "next, previous animation, or none"},
    {'W', SHIFT, VIEW_ACTION_ANIMATION, -1, NULL, NULL},
    {VIEW_KEY_LEFT, SHIFT, VIEW_ACTION_SCRUB, -1, NULL, "back, forward by 1/24 s"},
    {VIEW_KEY_RIGHT, SHIFT, VIEW_ACTION_SCRUB, 1, NULL, NULL},
    {VIEW_KEY_DOWN, SHIFT, VIEW_ACTION_SPEED, -1, NULL, "half, double speed"},
    {VIEW_KEY_UP, SHIFT, VIEW_ACTION_SPEED, 1, NULL, NULL},

    {'E', 0, VIEW_ACTION_ENVIRONMENT, 1, "Light", "next, previous environment"},
    {'E', SHIFT, VIEW_ACTION_ENVIRONMENT, -1, NULL, NULL},
    {VIEW_KEY_LEFT, CONTROL, VIEW_ACTION_ENVIRONMENT_ROTATION, -1, NULL, "turn it by 15 degrees"},
    {VIEW_KEY_RIGHT, CONTROL, VIEW_ACTION_ENVIRONMENT_ROTATION, 1, NULL, NULL},
    {'L', 0, VIEW_ACTION_ENVIRONMENT_INTENSITY, 1, NULL, "more, less of its light"},
    {'L', SHIFT, VIEW_ACTION_ENVIRONMENT_INTENSITY, -1, NULL, NULL},
    {'K', 0, VIEW_ACTION_LIGHTS, 0, NULL, "the file's own lights"},
    {'S', 0, VIEW_ACTION_SHADOWS, 0, NULL, "their shadows"},
    {'G', 0, VIEW_ACTION_GROUND, 0, NULL, "shadow on the ground"},

    {'J', 0, VIEW_ACTION_BACKGROUND, 0, "Image", "background: color, environment, transparent"},
    {'U', 0, VIEW_ACTION_BLUR, 0, NULL, "blur of the environment behind"},
    {'+', 0, VIEW_ACTION_EXPOSURE, 1, NULL, "exposure up, down"},
    {'-', 0, VIEW_ACTION_EXPOSURE, -1, NULL, NULL},
    {'T', 0, VIEW_ACTION_TONEMAP, 1, NULL, "next, previous tone mapping"},
    {'T', SHIFT, VIEW_ACTION_TONEMAP, -1, NULL, NULL},
    {'B', 0, VIEW_ACTION_BLOOM, 0, NULL, "bloom"},

    {'R', 0, VIEW_ACTION_RENDERER, 0, "Rendering", "OpenGL or path tracing"},
    {'D', 0, VIEW_ACTION_DENOISE, 0, NULL, "denoise what is path traced"},
    {'N', 0, VIEW_ACTION_CHANNEL, 1, NULL, "next, previous channel alone"},
    {'N', SHIFT, VIEW_ACTION_CHANNEL, -1, NULL, NULL},
    {'0', 0, VIEW_ACTION_WHOLE, 0, NULL, "all channels, no divider"},
    {'F', 0, VIEW_ACTION_BRDF, 0, NULL, "formula of the specular lobe"},
    {'F', SHIFT, VIEW_ACTION_ENERGY, 0, NULL, "energy: glTF's or conserving"},
    {VIEW_KEY_TAB, 0, VIEW_ACTION_DIVIDER, 1, NULL, "compare two, with a divider to drag"},
    {VIEW_KEY_TAB, SHIFT, VIEW_ACTION_DIVIDER, -1, NULL, NULL},
    {'P', 0, VIEW_ACTION_TRANSPARENCY, 0, NULL, "transparency: how it is sorted"},

    {'H', 0, VIEW_ACTION_HELP, 0, "Window", "this help"},
    {'Z', 0, VIEW_ACTION_VALUES, 0, NULL, "frame time and settings"},
    {VIEW_KEY_F11, 0, VIEW_ACTION_FULL_SCREEN, 0, NULL, "full screen"},
    {VIEW_KEY_F12, 0, VIEW_ACTION_SCREENSHOT, 0, NULL, "save the image as a PNG"},
    {'C', CONTROL, VIEW_ACTION_COPY, 0, NULL, "copy it as a facet render command"},
    {'?', 0, VIEW_ACTION_PRINT, 0, NULL, "print that command"},
    {'Q', 0, VIEW_ACTION_QUIT, 0, NULL, "quit"},
    {VIEW_KEY_ESCAPE, 0, VIEW_ACTION_QUIT, 0, NULL, NULL},
};
const uint32_t view_binding_count = sizeof view_bindings / sizeof *view_bindings;

const view_pointer_help view_pointer_lines[] = {
    {"Drag", "orbit; also the middle button"},
    {"Right drag, Shift+drag", "move sideways"},
    {"Wheel, Ctrl+drag", "nearer, farther"},
    {"Shift+scroll, Alt+scroll", "touchpad: move, orbit"},
    {"Drop a file", "show a model, or light it with an environment"},
};
const uint32_t view_pointer_line_count = sizeof view_pointer_lines / sizeof *view_pointer_lines;

const view_binding *view_binding_find(uint32_t key, unsigned modifiers)
{
    for (uint32_t i = 0; i < view_binding_count; i++)
        if (view_bindings[i].key == key && view_bindings[i].modifiers == modifiers)
            return &view_bindings[i];
    return NULL;
}

/* ---- names ---- */

static const struct {
    uint32_t key;
    const char *name;
} names[] = {
    {VIEW_KEY_LEFT, "Left"},   {VIEW_KEY_RIGHT, "Right"}, {VIEW_KEY_UP, "Up"},   {VIEW_KEY_DOWN, "Down"},
    {VIEW_KEY_ENTER, "Enter"}, {VIEW_KEY_ESCAPE, "Esc"},  {VIEW_KEY_TAB, "Tab"}, {VIEW_KEY_HOME, "Home"},
    {VIEW_KEY_F11, "F11"},     {VIEW_KEY_F12, "F12"},     {' ', "Space"},        {VIEW_KEY_ESCAPE, "Escape"}};

static const struct {
    unsigned bit;
    const char *prefix;
} modifier_names[] = {{VIEW_CONTROL, "Ctrl+"}, {VIEW_SHIFT, "Shift+"}, {VIEW_ALT, "Alt+"}};

bool view_key_parse(const char *text, uint32_t *key, unsigned *modifiers)
{
    *modifiers = 0;
    for (size_t i = 0; i < sizeof modifier_names / sizeof *modifier_names; i++) {
        size_t length = strlen(modifier_names[i].prefix);
        if (strncasecmp(text, modifier_names[i].prefix, length) == 0 && text[length]) {
            *modifiers |= modifier_names[i].bit;
            text += length;
        }
    }
    for (size_t i = 0; i < sizeof names / sizeof *names; i++)
        if (strcasecmp(text, names[i].name) == 0) {
            *key = names[i].key;
            return true;
        }
    if (text[0] <= ' ' || text[0] > '~' || text[1])
        return false;
    *key = text[0] >= 'a' && text[0] <= 'z' ? (uint32_t)(text[0] - 'a' + 'A') : (uint32_t)text[0];
    return true;
}

void view_key_write(uint32_t key, unsigned modifiers, char *out, uint32_t size)
{
    char character[2] = {(char)key, 0};
    const char *name = character;
    for (size_t i = 0; i < sizeof names / sizeof *names; i++)
        if (names[i].key == key) {
            name = names[i].name;
            break;
        }
    snprintf(out, size, "%s%s%s%s", modifiers & VIEW_CONTROL ? "Ctrl+" : "",
             modifiers & VIEW_SHIFT ? "Shift+" : "", modifiers & VIEW_ALT ? "Alt+" : "", name);
}
