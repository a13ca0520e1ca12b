/* view_state.h - all that decides what the window shows, and how keys and the pointer change it. No window, no OpenGL. */
#ifndef VIEW_VIEW_STATE_H
#define VIEW_VIEW_STATE_H

#include "view/view_input.h"

#include "facet/facet.h"

/* ---- the divider: two variants side by side, with a border that can be dragged ---- */

typedef enum view_comparison {
    VIEW_COMPARE_NOTHING,
    VIEW_COMPARE_MASKING,    /* separable Schlick-GGX | height-correlated Smith */
    VIEW_COMPARE_SCATTERING, /* single | multiple scattering on rough surfaces */
    VIEW_COMPARE_RENDERER,   /* OpenGL | path tracing */
    VIEW_COMPARE_TONEMAP,    /* none | the one chosen */
    VIEW_COMPARE_VARIANT,    /* the file's materials | a variant */
    VIEW_COMPARISON_COUNT
} view_comparison;

typedef struct view_divider {
    view_comparison comparison;
    double position;  /* [0, 1] of the width */
    uint32_t variant; /* that is compared where none is chosen */
    bool is_dragged;
} view_divider;

/* What the left and the right side draw, by name; base is what is drawn without a divider, and keeps its renderer: paths are
 * traced on both sides, where what is compared is not OpenGL's alone (VIEW_COMPARE_MASKING) or the renderer. */
void view_divider_sides(const view_divider *d, const facet_render_desc *base, facet_render_desc sides[2],
                        const char *labels[2]);
/* Whether the pointer at x can take hold of it. reach: px to either side. */
bool view_divider_is_at(const view_divider *d, double x, uint32_t width, double reach);
void view_divider_drag(view_divider *d, double x, uint32_t width);
/* The next comparison, in either direction; those of variants only where there are some, that of masking only without path
 * tracing, which has no separable one. */
void view_divider_step(view_divider *d, int steps, bool has_variants, bool traces_paths);
/* Where labels of those widths begin (x), beside the border where they fit there, else as near as the window allows. True: one of
 * them does not fit on its own side, and they are not to stand in one line. */
bool view_divider_labels(int border, int width, int margin, const int widths[2], int x[2]);

/* ---- the state ---- */

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

/* ---- resolution while the camera moves: a coarse image that keeps up says more than a sharp one that lags ---- */

typedef struct view_pace {
    double full_s; /* that a frame in full resolution takes, or more; 0: unknown */
} view_pace;

/* By what width and height are divided: 1; 2 where frames take more than 50 ms, 4 where a half would, too. */
uint32_t view_pace_divisor(const view_pace *pace, bool is_moving);
/* A frame took this long. */
void view_pace_measure(view_pace *pace, uint32_t divisor, double seconds);

/* ---- names of settings, for users ---- */

const char *view_tonemap_name(facet_tonemap tonemap);
const char *view_channel_name(facet_channel channel);
const char *view_brdf_name(facet_brdf brdf);
const char *view_energy_name(facet_energy energy);
const char *view_transparency_name(facet_transparency transparency);
const char *view_background_name(facet_background background);

#endif
