/* path_rays.h - records the rays of an image while they are traced, and replays them: by facet's functions
 * and by bare Embree. facet itself is unchanged: the linker inserts the recorder between path_trace() and
 * src/cpu/ray_trace.h (--wrap in bench/CMakeLists.txt). */
#ifndef BENCH_PATH_RAYS_H
#define BENCH_PATH_RAYS_H

#include "cpu/ray_trace.h"

typedef enum rays_kind { RAYS_CAMERA, RAYS_BOUNCE, RAYS_SHADOW, RAYS_KINDS } rays_kind;

/* Results of a replay. */
typedef struct rays_result {
    double seconds;
    uint64_t hits; /* of shadow rays: the occluded ones */
} rays_result;

/* Seconds, for differences: wall time, or with is_cpu_time CPU time of the process over thread_count, which
 * hardly depends on other load. */
double rays_now(bool is_cpu_time, uint32_t thread_count);

/* Records up to capacity rays of each kind from now on, of one thread; 0: stops. Earlier recordings are
 * dropped. */
void rays_record(size_t capacity);
size_t rays_count(rays_kind kind);

/* Whether the following seconds are CPU time. */
void rays_use_cpu_time(bool is_cpu_time);

/* Replays all rays of a kind by the function of ray_trace.h called by path_trace(), results kept. */
rays_result rays_trace_facet(const shading_scene *scene, rays_kind kind, uint32_t thread_count);
/* The same by rtcIntersect1() or rtcOccluded1() alone, on rays ready in memory. */
rays_result rays_trace_embree(const shading_scene *scene, rays_kind kind, uint32_t thread_count);
/* The same in packets of 16 (or 8, 4 by the machine's width) in recorded order. */
rays_result rays_trace_packets(const shading_scene *scene, rays_kind kind, uint32_t thread_count);

#endif
