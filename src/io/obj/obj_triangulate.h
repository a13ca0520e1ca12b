/* obj_triangulate.h - polygons as triangles. */
#ifndef IO_OBJ_TRIANGULATE_H
#define IO_OBJ_TRIANGULATE_H

#include "base/memory.h"

/* Corner numbers of the two triangles of a quadrilateral: cut along the diagonal that lies inside, that from the first
 * corner where both do or none does. */
const uint32_t *obj_split_quad(const float *a, const float *b, const float *c, const float *d);

/* What triangulations share: arrays that grow, the polygon to come. {.allocator} starts it. */
typedef struct obj_polygon {
    facet_allocator allocator;
    float *points; /* 3 per corner; the caller fills it after obj_polygon_reserve() */
    double *plane; /* 2 per corner */
    uint32_t *previous, *next;
    uint8_t *states;
    uint32_t *cell_begins, *cell_ends, *cell_corners; /* corners that are not convex, by cells of a grid */
    uint32_t capacity;
    bool is_rough; /* the last one was too much work: what was left became a fan */
} obj_polygon;

/* Room for a polygon of count corners. False: no memory. */
bool obj_polygon_reserve(obj_polygon *p, uint32_t count);
void obj_polygon_release(obj_polygon *p); /* {0} is allowed */

/* Cuts the polygon of the first count >= 3 points into count - 2 triangles, 3 corner numbers each, wound as the polygon.
 * It may be concave, not quite flat (seen along its Newell normal then), repeat points and edges, as the bridge to a hole
 * does; one that crosses itself becomes triangles whose signed areas sum up to its own. Ears are cut (Meisters 1975; Held
 * 2001, "FIST", for what to do where there is none), a bounded number of corners is looked at for each. */
void obj_triangulate(obj_polygon *p, uint32_t count, uint32_t *triangles);

#endif
