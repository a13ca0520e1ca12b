/* view_camera.h - an orbit that is turned, moved and brought nearer by hand. All of it is arithmetic on facet_orbit, whose
 * radius and target are given. */
#ifndef VIEW_VIEW_CAMERA_H
#define VIEW_VIEW_CAMERA_H

#include "view/view_input.h"

#include "facet/facet.h"

/* By pixels of the pointer, x to the right and y down, in a picture of that height. A drag over the height is a whole turn, as in
 * <model-viewer>; it stops straight above and below. */
void view_camera_turn(facet_orbit *orbit, double dx, double dy, uint32_t height);
/* What is at the target's depth stays under the pointer. */
void view_camera_pan(facet_orbit *orbit, double dx, double dy, uint32_t height);
/* Towards the target; positive: nearer. A step of a wheel is a tenth of the way. size: of the model, m, which tells how near and
 * far is sensible. */
void view_camera_dolly(facet_orbit *orbit, double steps, double size);
void view_camera_look(facet_orbit *orbit, view_direction direction);

/* low, high: bounds of what is shown; an orthographic eye stands outside of them. */
facet_camera view_camera_of(const facet_orbit *orbit, float aspect, const float low[3], const float high[3]);
/* The same in numbers that are short in decimal, by less than anybody sees: thousandths of a degree, metres to a hundred
 * thousandth of the distance. What is drawn is this one, so that a command line with few digits draws it, too. */
facet_orbit view_camera_round(const facet_orbit *orbit);
/* An orbit that looks as a camera does, apart from its roll: about the point of its axis that is nearest to middle. */
facet_orbit view_camera_orbit(const facet_camera *camera, const facet_orbit *like, const float middle[3]);

#endif
