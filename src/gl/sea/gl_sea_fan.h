/* gl_sea_fan.h - where nodes of a sea's mesh rest: on circles around the eye, a few pixels from each other.
 *
 * Circle i has the radius first sinh(step i): near the eye they are as far from each other as the surface is seen, farther away
 * in proportion to distance, as crests are seen that stand up. From level_m on, where waves are lower than a cell is wide, they are as far
 * from each other in depression: 1 / radius falls by as much from one to the next. Where waves are seen no more the last circles lead
 * over the horizon. */
#ifndef GL_GL_SEA_FAN_H
#define GL_GL_SEA_FAN_H

#include "draw/camera_rays.h"
#include "water/water_frame.h"

typedef struct gl_sea_fan {
    float azimuth, half_azimuth; /* rad, from +X towards +Z */
    float first_m, step;
    uint32_t columns, level_row, wave_rows, rows;
    float level_m;    /* of circle level_row */
    float ratio;      /* of radii beyond wave_rows */
    float shift[2];   /* of the water below the eye, at rest, from the eye; m */
    float farthest_m; /* that water is from where it rests */
    float width_rad;  /* with which waves are read for nodes */
    float near_m;     /* nothing of the surface is nearer */
} gl_sea_fan;

/* most_nodes along an edge: OpenGL's largest texture. */
gl_sea_fan gl_sea_fan_of(const water_frame *picture, const camera_rays *camera, uint32_t most_nodes);

/* One triangle strip: bands of columns, in each of them the rows from near to far, joined by degenerate triangles. The indices are
 * a block of mem_alloc(). FACET_ERROR_MEMORY. */
size_t gl_sea_fan_index_count(const gl_sea_fan *fan);
facet_result gl_sea_fan_make_indices(const gl_sea_fan *fan, const facet_allocator *allocator, uint32_t **out,
                                     facet_error *error);

#endif
