/* stray.h - few parts that lie so far from the dense rest that a frame around all would make a dot of it.
 *
 * Elements are triangles, lines and points, and count alike. The core are those of which the middle is within r of the median
 * of all middles, where r (a maximum norm) is the 75th percentile of the distances: up to a quarter of all elements, wherever
 * they are, move neither far. The kept box starts as the box around the core and takes in whatever is not farther from it than
 * 30 of its diagonals, until nothing is. What is left over is stray, if at least three quarters of all elements were
 * kept: then the kept part is less than a thirtieth of the whole, some 25 pixels of an image of 768.
 * All is counted in a fixed order, so that threads do not matter. */
#ifndef SCENE_STRAY_H
#define SCENE_STRAY_H

#include "scene/bounds.h"

typedef struct stray_parts {
    box kept;              /* around all that is not stray; each vertex that is in it belongs to that */
    uint64_t count, whole; /* elements that are stray, of how many */
    double distance_m, diagonal_m; /* from the nearest of them to the kept box; of the kept box */
} stray_parts;

/* False: there are none. */
bool stray_find(const scene_pose *pose, stray_parts *out);

#endif
