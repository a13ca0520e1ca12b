/* gl_sea_mesh.h - the mesh of a sea: a fan of nodes, at rest on circles around the eye, a few pixels apart.
 * sea_grid.frag moves them to the waves.
 *
 * Circle i has the radius first sinh(step i): near the eye the nodes are spaced by their projection on the
 * level surface; farther away in proportion to distance, as there crests are seen upright. From level_m
 * on, where waves are lower than a cell is wide, they are spaced evenly in depression: 1 / radius falls by
 * the same amount from one to the next. Beyond the distance at which waves are visible the last circles
 * reach over the horizon. */
#ifndef GL_GL_SEA_MESH_H
#define GL_GL_SEA_MESH_H

#include "draw/camera_rays.h"
#include "gl/core/gl_context.h"
#include "water/water_frame.h"

typedef struct gl_sea_fan {
    float azimuth, half_azimuth; /* rad, from +X towards +Z */
    float first_m, step;
    uint32_t columns, level_row, wave_rows, rows;
    float level_m;    /* of circle level_row */
    float ratio;      /* of radii beyond wave_rows */
    float shift[2];   /* from the eye to the resting position of the water below it; m */
    float farthest_m; /* largest horizontal displacement of the water */
    float width_rad;  /* filter width for the waves at nodes */
    float near_m;     /* no part of the surface is nearer */
} gl_sea_fan;

/* max_nodes per axis: OpenGL's largest texture. */
gl_sea_fan gl_sea_fan_of(const water_frame *frame, const camera_rays *camera, uint32_t max_nodes);

/* The indices of a fan in GPU memory, kept while it has as many nodes: one triangle strip of bands of columns,
 * in each of them the rows from near to far, joined by degenerate triangles. Names of OpenGL; 0: none yet. */
typedef struct gl_sea_mesh {
    uint32_t array, indices;
    uint32_t columns, rows, index_count;
} gl_sea_mesh;

/* FACET_ERROR_MEMORY. */
facet_result gl_sea_mesh_update(gl_sea_mesh *mesh, gl_context *context, const gl_sea_fan *fan,
                                const facet_allocator *allocator, facet_error *error);
void gl_sea_mesh_draw(const gl_sea_mesh *mesh);
void gl_sea_mesh_destroy(gl_sea_mesh *mesh); /* {0} is allowed; leaves {0} */

#endif
