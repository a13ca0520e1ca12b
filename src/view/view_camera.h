/* view_camera.h - an orbit that is turned, panned and zoomed by hand: arithmetic on facet_orbit, whose
 * radius and target are given. */
#ifndef VIEW_VIEW_CAMERA_H
#define VIEW_VIEW_CAMERA_H

#include "view/view_input.h"

#include "facet/facet.h"

/* By pixels of the pointer, x to the right and y down, in an image of that height. A drag over the whole
 * height is a full turn, as in <model-viewer>; it stops straight above and below. */
void view_camera_turn(facet_orbit *orbit, double dx, double dy, uint32_t height);
/* Points at the target's depth stay under the pointer. */
void view_camera_pan(facet_orbit *orbit, double dx, double dy, uint32_t height);
/* Towards the target; positive: nearer. A step of a wheel is a tenth of the distance. size: of the model,
 * m, which limits near and far. */
void view_camera_dolly(facet_orbit *orbit, double steps, double size);
void view_camera_look(facet_orbit *orbit, view_direction direction);

/* low, high: bounds of the scene; an orthographic eye is outside of them. */
facet_camera view_camera_of(const facet_orbit *orbit, float aspect, const float low[3], const float high[3]);
/* The same rounded to short decimals, by invisible amounts: thousandths of a degree, metres to a hundred
 * thousandth of the distance. The rounded orbit is the one drawn, so that a short command line reproduces it. */
facet_orbit view_camera_round(const facet_orbit *orbit);
/* An orbit that looks as a camera does, except for its roll: about the point of its axis that is nearest to
 * middle. */
facet_orbit view_camera_orbit(const facet_camera *camera, const facet_orbit *like, const float middle[3]);

#endif
