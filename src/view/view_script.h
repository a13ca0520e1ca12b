/* view_script.h - input from a file instead of a user, for tests and screen recordings. docs/view.md lists
 * the words. */
#ifndef VIEW_VIEW_SCRIPT_H
#define VIEW_VIEW_SCRIPT_H

#include "view/view_input.h"

#include "facet/facet.h"

typedef enum view_step_kind {
    VIEW_STEP_KEY,
    VIEW_STEP_DRAG,   /* numbers: from x, y to x, y, pixels */
    VIEW_STEP_SCROLL, /* numbers: steps to the right, away */
    VIEW_STEP_DROP,   /* path */
    VIEW_STEP_SIZE,   /* numbers: width, height, pixels */
    VIEW_STEP_WAIT,   /* numbers: s of the script's clock */
    VIEW_STEP_LOAD,   /* until nothing is being read */
    VIEW_STEP_RELOAD, /* until the model was reloaded after its files changed */
    /* until path tracing has numbers[0] samples per pixel (0: all), for at most numbers[1] s (0: the usual
     * timeout) */
    VIEW_STEP_TRACE,
    VIEW_STEP_IMAGE,  /* path: what F12 saves */
    VIEW_STEP_WINDOW, /* path: the same with the overlay */
    VIEW_STEP_PRINT,  /* the facet render command */
    VIEW_STEP_MINIMISE,
    VIEW_STEP_RESTORE,
    VIEW_STEP_CLOSE
} view_step_kind;

typedef struct view_step {
    view_step_kind kind;
    uint32_t line; /* of the script, from 1 */
    uint32_t key;
    unsigned modifiers;
    view_button button;
    double numbers[4];
    char *path; /* in the script's text */
} view_step;

typedef struct view_script {
    char *text; /* a block of mem_alloc() */
    view_step *steps;
    size_t count, capacity;
} view_script;

/* Fails with FACET_ERROR_READ; FACET_ERROR_ARGUMENT names the line and what was expected. */
facet_result view_script_load(const char *path, const facet_allocator *allocator, view_script *out,
                              facet_error *error);
/* The same from text; name is the file's name in messages. */
facet_result view_script_parse(const char *text, size_t size, const char *name,
                               const facet_allocator *allocator, view_script *out, facet_error *error);
void view_script_destroy(view_script *s); /* {0} is allowed */

#endif
