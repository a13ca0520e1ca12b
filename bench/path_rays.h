/* path_rays.h - the rays of a picture, kept as they are traced, and traced again: by facet's functions and by bare
 * Embree. Nothing of it is in facet: the linker puts the recorder between path_trace() and src/cpu/ray_trace.h
 * (--wrap in bench/CMakeLists.txt). Holds shared shading text: include it last. */
#ifndef BENCH_PATH_RAYS_H
#define BENCH_PATH_RAYS_H

#include "cpu/ray_trace.h"

typedef enum rays_kind { RAYS_CAMERA, RAYS_BOUNCE, RAYS_SHADOW, RAYS_KINDS } rays_kind;

/* What came out of tracing rays again. */
typedef struct rays_result {
    double seconds;
    uint64_t hits; /* of shadow rays: those that something stops */
} rays_result;

/* Seconds since something, for differences: of the clock, or with by_processors of all processors that the process had,
 * over thread_count. The latter hardly depends on what else the machine does. */
double rays_now(bool by_processors, uint32_t thread_count);

/* Keeps up to capacity rays of each kind from now on, of one thread; 0: no more. What was kept before is gone. */
void rays_record(size_t capacity);
size_t rays_count(rays_kind kind);

/* Whether the seconds of what follows are those of processors. */
void rays_count_processors(bool by_processors);

/* All rays of a kind by the function of ray_trace.h that path_trace() called, results kept. */
rays_result rays_trace_facet(const shading_scene *scene, rays_kind kind, uint32_t thread_count);
/* The same by rtcIntersect1() or rtcOccluded1() alone, on rays ready in memory. */
rays_result rays_trace_embree(const shading_scene *scene, rays_kind kind, uint32_t thread_count);
/* The same in packets of 16 (8, 4 where that is the machine's width) in the order in which they were traced. */
rays_result rays_trace_packets(const shading_scene *scene, rays_kind kind, uint32_t thread_count);

#endif
