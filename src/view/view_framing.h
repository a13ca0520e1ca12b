/* view_framing.h - framing as <model-viewer> does it: the whole model stays in view from every direction, so that
 * turning it never changes its size. facet's own framing (scene_fit_orbit()) is tighter, for one direction. */
#ifndef VIEW_VIEW_FRAMING_H
#define VIEW_VIEW_FRAMING_H

#include "facet/facet.h"

typedef struct view_framing {
    double low[3], high[3]; /* bounds of the pose, m */
    double target[3];       /* of the measure */
    double radius;          /* m, of the sphere around the target that holds all vertices */
    double aspect;          /* width / height from which on the height limits the frame */
} view_framing;

/* target NULL: the center of the bounds. fov_y_rad: vertical, of a wide image. A model without vertices is a sphere of
 * radius 1 m. Fails as scene_pose_create(). */
facet_result view_framing_measure(const facet_scene *scene, const facet_pose_desc *pose, const double *target,
                                  double fov_y_rad, view_framing *framing, facet_error *error);
/* The distance at which the sphere fills the height. */
double view_framing_distance(const view_framing *framing, double fov_y_rad);
/* The vertical field of view that shows in an image of that aspect what fov_y_rad shows in a wide one. */
double view_framing_fov(const view_framing *framing, double fov_y_rad, double aspect);

#endif
