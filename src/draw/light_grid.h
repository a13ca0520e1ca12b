/* light_grid.h - which of many lights with a range reach a point. */
#ifndef DRAW_LIGHT_GRID_H
#define DRAW_LIGHT_GRID_H

#include "facet/facet.h"

struct Light; /* shade/light.h */

/* Cells over the bounds of all lights with a range, each with the indices of the lights that reach into it,
 * ascending. Lights without range reach everywhere and have a list of their own. */
typedef struct light_grid {
    float origin[3];        /* m */
    float cells_per_m[3];   /* per axis */
    uint32_t cell_count[3]; /* per axis; 0: no light has a range */
    uint32_t *first;        /* per cell, and one more at the end: index of its first entry */
    uint32_t *lights;
    uint32_t everywhere_count;
    uint32_t *everywhere; /* ascending */
} light_grid;

/* Fails with FACET_ERROR_MEMORY. */
facet_result light_grid_create(const struct Light *lights, uint32_t count, const facet_allocator *allocator,
                               light_grid *out, facet_error *error);
void light_grid_destroy(light_grid *grid); /* {0} is allowed */

/* Iterates over the indices of the lights that may reach a point, ascending: all that do are among them,
 * so that a sum over them has the nonzero terms of the sum over all, in the same order. */
typedef struct light_cursor {
    const uint32_t *near, *near_end, *everywhere, *everywhere_end;
} light_cursor;

light_cursor light_grid_at(const light_grid *grid, const float P[3]);

/* False: there are no more. */
static inline bool light_cursor_next(light_cursor *c, uint32_t *light)
{
    bool has_near = c->near < c->near_end;
    if (c->everywhere < c->everywhere_end && !(has_near && *c->near < *c->everywhere)) {
        *light = *c->everywhere++;
        return true;
    }
    if (has_near)
        *light = *c->near++;
    return has_near;
}

#endif
