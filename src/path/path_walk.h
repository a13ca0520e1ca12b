/* path_walk.h - the walk of a path: from where it is to the next surface or scattering event and on from there, until it ends.
 * Holds shared shading text: include it last. */
#ifndef PATH_WALK_H
#define PATH_WALK_H

#include "path/path_state.h"

/* Goes on from p->P into p->D; all that it brings is added to p->radiance. */
void path_walk(path *p);
/* The same where it is known what is met first: hit, by ray. */
void path_walk_from(path *p, const visibility_hit *hit, const shading_ray *ray);

#endif
