/* view_motion.h - a camera on an orbit that glides: where it is going (the goal), where it is now, how input moves the
 * goal, and its limits. Keys, limits and defaults are those of <model-viewer>. No window, no OpenGL. */
#ifndef VIEW_VIEW_MOTION_H
#define VIEW_VIEW_MOTION_H

#include <math.h>
#include <stdbool.h>
#include <stdint.h>

#include "facet/facet.h"

/* What moves; the field of view in the logarithm, so that zooming is even. */
typedef enum view_axis {
    VIEW_AXIS_AZIMUTH, /* rad */
    VIEW_AXIS_POLAR,   /* rad from straight above */
    VIEW_AXIS_RADIUS,  /* m */
    VIEW_AXIS_LOG_FOV, /* ln of the vertical field of view in rad */
    VIEW_AXIS_TARGET,  /* m; three of them */
    VIEW_AXIS_COUNT = VIEW_AXIS_TARGET + 3
} view_axis;

typedef struct view_motion {
    double goal[VIEW_AXIS_COUNT], now[VIEW_AXIS_COUNT], velocity[VIEW_AXIS_COUNT]; /* per s */
    double low[VIEW_AXIS_COUNT], high[VIEW_AXIS_COUNT];                            /* of goal */
    double center[3], reach; /* panning keeps the target in this sphere; m */
    double decay_s;          /* time constant of the glide; 0: jumps */
    double orbit_sensitivity, zoom_sensitivity, pan_sensitivity, input_sensitivity;
    /* the turntable: the model turns under its light; in the renderer camera and light turn around it */
    bool rotates;
    double rotation_rad_s, rotation_delay_s; /* after the last input */
    double turntable_rad, idle_s;
    bool is_reduced; /* users who ask for less motion: no glide, no turntable */
} view_motion;

/* An orbit of radius 1 around the origin, azimuth 0, polar angle 75 degrees, field of view 30 degrees. */
void view_motion_create(view_motion *m);

/* A number by its name: "decay" (s), "orbit-sensitivity", "zoom-sensitivity", "pan-sensitivity", "input-sensitivity",
 * "auto-rotate" (0, 1), "auto-rotate-delay" (s), "rotation-per-second" (rad/s), "turntable" (rad), "reduced" (0, 1).
 * False: no such name, or no finite number. */
bool view_motion_set(view_motion *m, const char *name, double value);

/* ---- the goal ---- */

/* A value that is kept. */
#define VIEW_UNSET ((double)NAN)

/* VIEW_UNSET keeps a value. Within the limits; the shorter way around where the azimuth has none. */
void view_motion_aim(view_motion *m, const double goal[VIEW_AXIS_COUNT]);
/* Limits of azimuth, polar angle, radius and field of view; infinite: none. VIEW_UNSET keeps one. The goal follows. */
void view_motion_limit(view_motion *m, const double low[VIEW_AXIS_TARGET],
                       const double high[VIEW_AXIS_TARGET]);
/* The camera is at its goal, at once. */
void view_motion_jump(view_motion *m);

/* ---- input: pixels, x to the right and y down, of an image of that height ---- */

void view_motion_turn(view_motion *m, double dx, double dy, double height); /* the height is a full turn */
void view_motion_pan(view_motion *m, double dx, double dy, double height);  /* the target's plane follows */
/* Field of view and radius together, from limit to limit. Positive: away; a step is a key press. */
void view_motion_zoom(view_motion *m, double steps);
/* The target comes to rest on a point that the camera shows at its center; the eye stays where it is. */
void view_motion_set_pivot(view_motion *m, const double point[3]);

typedef enum view_step {
    VIEW_STEP_LEFT,
    VIEW_STEP_RIGHT,
    VIEW_STEP_UP,
    VIEW_STEP_DOWN,
    VIEW_STEP_IN,
    VIEW_STEP_OUT,
    VIEW_STEP_COUNT
} view_step;
/* A key: an eighth of half a turn, or with pans 10 pixels. */
void view_motion_step(view_motion *m, view_step step, bool pans, double height);

/* ---- time ---- */

/* True: the camera or the turntable moved. */
bool view_motion_advance(view_motion *m, double seconds);
/* Whether the camera has not arrived yet, or the turntable turns or will. */
bool view_motion_is_gliding(const view_motion *m);
bool view_motion_is_moving(const view_motion *m);

/* Where the camera is now, and how the light lies for it: the turntable turns both. */
void view_motion_place(const view_motion *m, facet_orbit *orbit);
double view_motion_fov(const view_motion *m); /* rad */
/* Where it looks from: "front", "upper-left", .., as <model-viewer> calls it. */
const char *view_motion_side(const view_motion *m);

#endif
