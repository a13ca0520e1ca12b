/* stray.h - few parts so far from the dense rest that a frame around everything would reduce that to a dot.
 *
 * Elements are triangles, lines and points, weighted equally. The core are those whose center is within r
 * of the median of all centers, where r (a maximum norm) is the 75th percentile of the distances: up to a
 * quarter of all elements, wherever they are, affect neither much. The kept box starts as the box around
 * the core and grows by everything within 30 of its diagonals, until nothing is. The remainder is stray if
 * at least three quarters of all elements were kept: then the kept part is less than a thirtieth of the
 * whole, some 25 pixels of an image of 768. Everything is counted in a fixed order, independent of
 * threads. */
#ifndef SCENE_STRAY_H
#define SCENE_STRAY_H

#include "scene/bounds.h"

typedef struct stray_parts {
    box kept;                      /* around everything that is not stray, and every vertex in it */
    uint64_t count, whole;         /* number of stray elements, and of all */
    double distance_m, diagonal_m; /* from the nearest of them to the kept box; of the kept box */
} stray_parts;

/* False: there are none. */
bool stray_find(const scene_pose *pose, stray_parts *out);

#endif
