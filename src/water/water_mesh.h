/* water_mesh.h - the sea around an eye as triangles, for a path tracer. Vertices lie on rays from the point below the eye, about a pixel
 * apart where they are seen and farther to the sides and behind; out to beyond the horizon, falling away as the Earth does. Each
 * has the waves that are twice as wide as vertices are apart, and says what slopes are left (scene_primitive.water). */
#ifndef WATER_WATER_MESH_H
#define WATER_WATER_MESH_H

#include "draw/render_watch.h"
#include "water/water_setup.h"

/* The lattice: vertices at column azimuths and row radii around a center. */
typedef struct water_mesh_lattice {
    double center[2]; /* X, Z, m */
    uint32_t column_count, row_count;
    double *azimuths, *radii; /* rad from +X towards +Z, the last 2 pi after the first; m, the first 0 */
    double *column_steps, *row_steps; /* to the next or from the last, the larger */
} water_mesh_lattice;

/* For the eye of s, at most `most` vertices; blocks are of the arena. False: no memory. */
bool water_mesh_lattice_create(const water_setup *s, uint32_t most, arena *memory, water_mesh_lattice *out);

/* The surface; places inside of a hull that keeps the sea out (s->model) have none. Where the watch (NULL: none) stops it there is
 * nothing. False: no memory. */
bool water_mesh_surface(const water_setup *s, const water_mesh_lattice *l, render_watch *watch, arena *memory,
                        scene_primitive *out);
/* The bed, as wide. */
bool water_mesh_bed(const water_setup *s, const water_mesh_lattice *l, arena *memory, scene_primitive *out);

/* A scene of the surface and its bed beside all of `with` (NULL: nothing), which is to outlive it. deadline_s: of clock_seconds(), 0: none.
 * FACET_ERROR_MEMORY, FACET_ERROR_CANCELLED, FACET_ERROR_LIMIT. */
facet_result water_mesh_scene(const water_setup *s, const facet_scene *with, double deadline_s,
                              facet_scene **out, facet_error *error);

#endif
