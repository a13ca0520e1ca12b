/* water_mesh.h - the sea around an eye as triangles, for the path tracer. Vertices lie on rays from the
 * point below the eye, half a pixel apart in view or more, and farther apart beside and behind it, out to beyond
 * the horizon, following the Earth's curvature. A vertex resolves the waves longer than twice the vertex
 * spacing, and stores the slope covariance of all others (scene_primitive.water). */
#ifndef WATER_WATER_MESH_H
#define WATER_WATER_MESH_H

#include "draw/render_watch.h"
#include "water/water_setup.h"

/* Vertices at column azimuths and row radii around a center. */
typedef struct water_mesh_lattice {
    double center[2]; /* X, Z, m */
    uint32_t column_count, row_count;
    double *azimuths, *radii; /* rad from +X towards +Z, the last 2 pi after the first; m, the first 0 */
    double *column_steps, *row_steps; /* distance to the next or the previous one, whichever is larger */
} water_mesh_lattice;

/* For the eye of s, with at most `most` vertices, in blocks of the arena. False: out of memory. */
bool water_mesh_lattice_create(const water_setup *s, uint32_t most, arena *memory, water_mesh_lattice *out);

/* The surface, with holes inside of hulls that keep the sea out (s->model). Empty where the watch (NULL:
 * none) stops it. False: out of memory. */
bool water_mesh_surface(const water_setup *s, const water_mesh_lattice *l, render_watch *watch, arena *memory,
                        scene_primitive *out);
/* The bed, of the same extent. */
bool water_mesh_bed(const water_setup *s, const water_mesh_lattice *l, arena *memory, scene_primitive *out);

/* A scene of the surface and its bed beside everything in `with` (NULL: nothing), which outlives it.
 * deadline_s: of clock_seconds(), 0: none. FACET_ERROR_MEMORY, FACET_ERROR_CANCELLED, FACET_ERROR_LIMIT. */
facet_result water_mesh_scene(const water_setup *s, const facet_scene *with, double deadline_s,
                              facet_scene **out, facet_error *error);

#endif
