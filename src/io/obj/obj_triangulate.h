/* obj_triangulate.h - triangulation of polygons. */
#ifndef IO_OBJ_TRIANGULATE_H
#define IO_OBJ_TRIANGULATE_H

#include "base/memory.h"

/* Corner indices of the two triangles of a quadrilateral, cut along the diagonal inside it: that from the
 * first corner if both or none are. */
const uint32_t *obj_split_quad(const float *a, const float *b, const float *c, const float *d);

/* Buffers that triangulations share, and the next polygon. {.allocator} starts it. */
typedef struct obj_polygon {
    facet_allocator allocator;
    float *points; /* 3 per corner; the caller fills it after obj_polygon_reserve() */
    double *plane; /* 2 per corner */
    uint32_t *previous, *next;
    uint8_t *states;
    uint32_t *cell_begins, *cell_ends, *cell_corners; /* reflex corners, by cells of a grid */
    uint32_t capacity;
    bool is_rough; /* the last polygon exceeded the work limit, and its rest became a fan */
} obj_polygon;

/* Reserves memory for a polygon of count corners. False: no memory. */
bool obj_polygon_reserve(obj_polygon *p, uint32_t count);
void obj_polygon_release(obj_polygon *p); /* {0} is allowed */

/* Cuts the polygon of the first count >= 3 points into count - 2 triangles, 3 corner indices each, with
 * the winding of the polygon. It may be concave, not quite planar (it is projected along its Newell
 * normal), and repeat points and edges, as the bridge to a hole does; a self-intersecting one becomes
 * triangles whose signed areas sum up to its own. Ear clipping (Meisters 1975; Held 2001, "FIST", for
 * polygons without ears) with a bounded number of corners examined per ear. */
void obj_triangulate(obj_polygon *p, uint32_t count, uint32_t *triangles);

#endif
