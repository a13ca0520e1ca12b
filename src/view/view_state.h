/* view_state.h - everything that determines what the window shows, and how keys and the pointer change it. No
 * window, no OpenGL. */
#ifndef VIEW_VIEW_STATE_H
#define VIEW_VIEW_STATE_H

#include "view/view_input.h"

#include "facet/facet.h"

/* ---- the renderers of a window ---- */

/* Whether a renderer accumulates samples in the background, while nothing moves (view_trace.h). OpenGL does not: it
 * draws every frame, and those in between for the others. A new renderer is a row of the table in view_state.c. */
bool view_renderer_accumulates(facet_renderer_kind kind);
facet_renderer_kind view_renderer_next(facet_renderer_kind kind); /* after the last one the first */
const char *view_renderer_title(facet_renderer_kind kind);        /* "OpenGL" */

/* ---- the divider: two variants side by side, with a draggable border ---- */

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

/* The settings of the left and right side, in that order; base is what is drawn without a divider, and its
 * renderer is kept, unless the comparison is of the renderers or needs OpenGL (VIEW_COMPARE_MASKING). */
void view_divider_sides(const view_divider *d, const facet_render_desc *base, facet_render_desc sides[2],
                        const char *labels[2]);
/* The next comparison, in either direction; variants only where there are some, masking only with OpenGL: other
 * renderers have no separable one. */
void view_divider_step(view_divider *d, int steps, bool has_variants, facet_renderer_kind renderer);
/* Where labels of those widths begin (x): next to the border where they fit there, else as near as the window
 * allows. True: one of them does not fit on its own side, and they need separate lines. */
bool view_divider_labels(int border, int width, int margin, const int widths[2], int x[2]);

/* ---- the state ---- */

enum { VIEW_MAX_ANIMATIONS = 256, VIEW_NO_CAMERA = -1, VIEW_NO_ANIMATION = -1 };

typedef struct view_state {
    /* the model; NULL: none yet */
    const facet_scene *scene;
    facet_scene_counts counts;
    float low[3], high[3]; /* bounds */
    facet_pose_desc pose;  /* its animations point to the array here */
    uint32_t animations[VIEW_MAX_ANIMATIONS];
    double begin_s, end_s, speed;
    bool is_playing;

    facet_orbit orbit; /* with radius and target, unless needs_framing */
    facet_orbit home;  /* as the model was first shown; radius and target may be left to framing */
    facet_camera file_camera;
    int camera;          /* of the file */
    bool needs_framing;  /* orbit's radius and target are to be found */
    facet_orbit framing; /* the orbit they were found for, while is_framed: the orbit was not moved since */
    bool is_framed;

    facet_render_desc render; /* without the settings of the model and the window */
    uint32_t path_samples;
    view_divider divider;
    uint32_t help_page, help_pages; /* the visible page, from 1, and how many; 0: none */
    bool shows_values;

    /* the pointer */
    bool is_held;
    view_button button;
    unsigned held_modifiers; /* when it was pressed */
    double x, y;
    uint32_t width, height; /* of the image */
    float scale;            /* of text and handles */

    char message[256]; /* about the last change; "": nothing */
} view_state;

void view_state_create(view_state *s, const facet_view_desc *desc);
/* Begins to show a model; keeps_view: the same one, read again. */
void view_state_set_model(view_state *s, const facet_view_model *model, const float low[3],
                          const float high[3], bool keeps_view);

/* Applies the action of a key and describes it in message. False: the action is not the state's (files, the
 * window). */
bool view_state_apply(view_state *s, view_action action, int amount);
/* Applies the pointer. True: a redraw is needed. */
bool view_state_point(view_state *s, const view_event *event);
/* Advances time. True: something moved. */
bool view_state_advance(view_state *s, double seconds);

/* The first variant that looks different from the file without one: often the first is its default. */
uint32_t view_state_find_variant(const view_state *s);
/* Whether there is a light that could cast shadows. */
bool view_state_has_casters(const view_state *s);
/* For other files: which animations of the scene run; the model's longest side in m, 1 where it has none;
 * and an orbit equal to the file's camera, before it is moved by hand. */
void view_state_set_animations(view_state *s, const uint32_t *animations, uint32_t count);
float view_state_size(const view_state *s);
void view_state_leave_file_camera(view_state *s);

/* Finds the radius and the target of an orbit that needs_framing, as facet render does: for all times,
 * where there is motion. Fails as scene_fit_orbit(). */
facet_result view_state_frame(view_state *s, float aspect, facet_error *error);
/* From now on the whole model is in view, from the direction that the orbit has. */
void view_state_show_whole(view_state *s);
/* After a change of the running animations: an orbit that was found for others, and that was not moved by
 * hand, is found again. */
void view_state_follow_motion(view_state *s);

/* The sides whose renderers accumulate samples: bit 0 left, bit 1 right. Without a divider the image is the right
 * one. */
enum { VIEW_SIDE_LEFT = 1 << 0, VIEW_SIDE_RIGHT = 1 << 1 };
unsigned view_state_accumulating_sides(const view_state *s);

/* The whole desc of an image of that size, except for the environment. camera: where it is stored. */
facet_render_desc view_state_desc(const view_state *s, uint32_t width, uint32_t height, facet_camera *camera);

/* ---- quality while something moves: a coarse image that keeps up says more than a sharp one that lags ---- */

typedef struct view_pace {
    double full_s; /* upper bound of the time of a frame in full resolution; 0: unknown */
    bool is_draft; /* of the present motion */
} view_pace;

/* Whether the next frame is one of FACET_QUALITY_DRAFT: from the first frame of a motion that took more than 20 ms
 * until it rests. */
bool view_pace_drafts(view_pace *pace, bool is_moving);

/* The divisor of width and height: 1; 2 where frames take more than 50 ms, 4 where a half would, too. */
uint32_t view_pace_divisor(const view_pace *pace, bool is_moving);
/* Records the time of a frame. */
void view_pace_measure(view_pace *pace, uint32_t divisor, double seconds);

/* ---- names of settings, for users ---- */

const char *view_tonemap_name(facet_tonemap tonemap);
const char *view_channel_name(facet_channel channel);
const char *view_brdf_name(facet_brdf brdf);
const char *view_energy_name(facet_energy energy);
const char *view_transparency_name(facet_transparency transparency);

#endif
