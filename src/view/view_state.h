/* view_state.h - all that decides what the window shows, and how keys and the pointer change it. No window, no OpenGL. */
#ifndef VIEW_VIEW_STATE_H
#define VIEW_VIEW_STATE_H

#include "view/view_divider.h"
#include "view/view_event.h"
#include "view/view_keys.h"

#include "facet/facet.h"

enum { VIEW_MAX_ANIMATIONS = 256, VIEW_NO_CAMERA = -1, VIEW_NO_ANIMATION = -1 };

typedef struct view_state {
    /* the model; NULL: none yet */
    const facet_scene *scene;
    facet_scene_counts counts;
    float low[3], high[3]; /* bounds */
    facet_pose_desc pose;  /* its animations are those here */
    uint32_t animations[VIEW_MAX_ANIMATIONS];
    double begin_s, end_s, speed;
    bool is_playing;

    facet_orbit orbit; /* with radius and target, unless needs_framing */
    facet_orbit home;  /* as the model was first shown; they may be left to the model's size */
    facet_camera file_camera;
    int camera;          /* of the file */
    bool needs_framing;  /* orbit's radius and target are to be found */
    facet_orbit framing; /* what they were found for, as long as is_framed: the orbit was not moved since */
    bool is_framed;

    facet_render_desc render; /* renderer: GL or PATH; without what belongs to the model and the window */
    uint32_t path_samples;
    view_divider divider;
    uint32_t help_page, help_pages; /* which is shown, from 1, of how many; 0: none */
    bool shows_values;

    /* the pointer */
    bool is_held;
    view_button button;
    unsigned held_modifiers; /* when it was pressed */
    double x, y;
    uint32_t width, height; /* of the picture */
    float scale;            /* of text and handles */

    char message[256]; /* what was just changed; "": nothing */
} view_state;

void view_state_create(view_state *s, const facet_view_desc *desc);
/* Begins to show a model; keeps_view: the same one, read again. */
void view_state_set_model(view_state *s, const facet_view_model *model, const float low[3],
                          const float high[3], bool keeps_view);

/* Does what a key asks for and says so in message. False: it is not the state's to do (files, the window). */
bool view_state_apply(view_state *s, view_action action, int amount);
/* What the pointer does. True: something is to be drawn anew. */
bool view_state_point(view_state *s, const view_event *event);
/* Lets time pass. True: something moved. */
bool view_state_advance(view_state *s, double seconds);

/* Whether there is a light that could cast shadows. */
bool view_state_has_casters(const view_state *s);
/* For what changes it: which animations of the scene run; the model's longest edge in m, 1 where it has none; and what makes an orbit of a camera of the file, before
 * it is moved by hand. */
void view_state_set_animations(view_state *s, const uint32_t *animations, uint32_t count);
float view_state_size(const view_state *s);
void view_state_leave_file_camera(view_state *s);

/* view_frame.c: finds the radius and the target of an orbit that needs_framing, as facet render does: at all times, where there
 * is motion. Fails as scene_fit_orbit(). */
facet_result view_state_frame(view_state *s, float aspect, facet_error *error);
/* From now on the whole model is to be seen, from the direction that the orbit has. */
void view_state_show_whole(view_state *s);
/* For whoever changes which animations run: an orbit that was found for the others, and that nobody moved, is found anew. */
void view_state_follow_motion(view_state *s);

/* The whole desc of a picture of that size, but for the environment. camera: where it is kept. */
facet_render_desc view_state_desc(const view_state *s, uint32_t width, uint32_t height, facet_camera *camera);

#endif
