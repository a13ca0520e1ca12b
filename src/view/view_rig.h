/* view_rig.h - the camera of a viewer as <model-viewer>'s attributes describe it: texts, which are evaluated when the model
 * and the image are known, and the motion between them. */
#ifndef VIEW_VIEW_RIG_H
#define VIEW_VIEW_RIG_H

#include "view/view_framing.h"
#include "view/view_motion.h"

typedef enum view_rig_text {
    VIEW_RIG_FOV,     /* field-of-view */
    VIEW_RIG_TARGET,  /* camera-target */
    VIEW_RIG_MIN_FOV, /* min-field-of-view */
    VIEW_RIG_MAX_FOV,
    VIEW_RIG_MIN_ORBIT, /* min-camera-orbit */
    VIEW_RIG_MAX_ORBIT,
    VIEW_RIG_ORBIT, /* camera-orbit */
    VIEW_RIG_RATE,  /* rotation-per-second */
    VIEW_RIG_TEXT_COUNT
} view_rig_text;

enum { VIEW_RIG_TEXT_SIZE = 256 };

typedef struct view_rig {
    view_motion motion;
    view_framing framing;
    char texts[VIEW_RIG_TEXT_COUNT][VIEW_RIG_TEXT_SIZE];
    double fov_rad; /* that is framed, of a wide image */
    double aspect;  /* of the image */
    double scroll;  /* env(window-scroll-y) */
    double
        origin[3]; /* of the scene: texts are in the world of the file, the motion is relative to this; m */
    double home[VIEW_AXIS_COUNT]; /* where the texts aim */
    bool is_framed;               /* the framing is that of the present model */
    bool was_aimed;               /* an earlier model was shown */
} view_rig;

/* All texts are "auto"; camera-orbit is "0deg 75deg 105%". */
void view_rig_create(view_rig *rig);
/* Stores the text and aims at it, gliding. Where it fails, or name is none of view_rig_text, nothing has changed. */
facet_result view_rig_set(view_rig *rig, const char *name, const char *text, facet_error *error);
/* Also "scroll"; else view_motion_set(). */
bool view_rig_set_number(view_rig *rig, const char *name, double value);

/* For a model, or after its pose or transformation changed: measures it and goes to what the texts say, at once.
 * keeps_direction: azimuth and polar angle stay, as they do for a second model. */
facet_result view_rig_frame(view_rig *rig, const facet_scene *scene, const facet_pose_desc *pose,
                            bool keeps_direction, facet_error *error);
/* The image has another shape: the field of view changes, so that the model stays in view. */
void view_rig_set_aspect(view_rig *rig, double aspect);
/* Where the camera is before it is moved; the flags of out stay. False: not as for every viewer of the model, since a text is
 * not the usual one, or the turntable turned. */
bool view_rig_home(const view_rig *rig, facet_orbit *out);
/* From another source: where the camera is, is where it shall be. */
void view_rig_follow(view_rig *rig, const facet_orbit *orbit);
/* A point of the file's world that was touched, or NULL: camera-target again, from afar. */
void view_rig_look_at(view_rig *rig, const double *point);
/* view_motion_set_pivot() for a point of the file's world. */
void view_rig_set_pivot(view_rig *rig, const double point[3]);

#endif
