/* path_rays.c - see path_rays.h. */
#include <stdlib.h>
#include <string.h>

#include "base/clock.h"
#include "base/memory.h"
#include "base/parallel.h"
#include "median.h"
#include "path_rays.h"

#include "cpu/embree_scene.h"

enum { GRAIN = 1024 /* rays that a thread takes at once: 80 kB of them */ };

/* A ray with the other arguments of its function; spread is not recorded. */
typedef struct record {
    shading_ray ray;
    float u;
    uint32_t random;
    bool has_crossings, takes_all;
} record;

typedef struct recorder {
    record *items[RAYS_KINDS];
    size_t counts[RAYS_KINDS], capacity;
} recorder;

static recorder recording;
static bool uses_cpu_time;
static const ray_spread NO_SPREAD = {.moves = false, .turns = false};

double rays_now(bool is_cpu_time, uint32_t thread_count)
{
    return is_cpu_time ? cpu_seconds() / thread_count : clock_seconds();
}

void rays_use_cpu_time(bool is_cpu_time)
{
    uses_cpu_time = is_cpu_time;
}

void rays_record(size_t capacity)
{
    recording.capacity = capacity;
    if (capacity == 0)
        return;
    for (int kind = 0; kind < RAYS_KINDS; kind++) {
        mem_free(recording.items[kind]);
        recording.items[kind] = mem_alloc(NULL, capacity, sizeof(record));
        recording.counts[kind] = 0;
        if (!recording.items[kind])
            abort();
    }
}

size_t rays_count(rays_kind kind)
{
    return recording.counts[kind];
}

/* ---- between path_trace() and ray_trace.h ---- */

static void keep(rays_kind kind, const record *r)
{
    if (recording.counts[kind] >= recording.capacity)
        return;
    record *kept = &recording.items[kind][recording.counts[kind]++];
    *kept = *r;
    kept->ray.spread = &NO_SPREAD;
}

ray_first __real_ray_trace_first(const shading_scene *scene, const shading_ray *ray, float u);
bool __real_ray_trace_nearest(const shading_scene *scene, const shading_ray *ray, uint32_t random,
                              visibility_hit *hit);
float __real_ray_trace_transmittance(const shading_scene *scene, const shading_ray *ray,
                                     ray_crossings *crossings);
ray_first __wrap_ray_trace_first(const shading_scene *scene, const shading_ray *ray, float u);
bool __wrap_ray_trace_nearest(const shading_scene *scene, const shading_ray *ray, uint32_t random,
                              visibility_hit *hit);
float __wrap_ray_trace_transmittance(const shading_scene *scene, const shading_ray *ray,
                                     ray_crossings *crossings);

ray_first __wrap_ray_trace_first(const shading_scene *scene, const shading_ray *ray, float u)
{
    if (recording.capacity)
        keep(RAYS_CAMERA, &(record){.ray = *ray, .u = u});
    return __real_ray_trace_first(scene, ray, u);
}

bool __wrap_ray_trace_nearest(const shading_scene *scene, const shading_ray *ray, uint32_t random,
                              visibility_hit *hit)
{
    if (recording.capacity)
        keep(RAYS_BOUNCE, &(record){.ray = *ray, .random = random});
    return __real_ray_trace_nearest(scene, ray, random, hit);
}

float __wrap_ray_trace_transmittance(const shading_scene *scene, const shading_ray *ray,
                                     ray_crossings *crossings)
{
    if (recording.capacity)
        keep(RAYS_SHADOW, &(record){.ray = *ray,
                                    .has_crossings = crossings,
                                    .takes_all = crossings && crossings->takes_all});
    return __real_ray_trace_transmittance(scene, ray, crossings);
}

/* ---- replay ---- */

/* One pass over the rays of a kind. */
typedef struct pass {
    const shading_scene *scene;
    rays_kind kind;
    const record *records;
    size_t count;
    visibility_hit *hits;       /* facet's; for shadow rays: geometry is 0 or VISIBILITY_NONE */
    struct RTCRayHit *embree;   /* of bare Embree */
    struct RTCRayHit16 *packet; /* of packets */
} pass;

static void trace_facet(void *context, size_t begin, size_t end)
{
    const pass *p = context;
    ray_crossings crossings;
    for (size_t i = begin; i < end; i++) {
        const record *r = &p->records[i];
        visibility_hit *hit = &p->hits[i];
        if (p->kind == RAYS_SHADOW) {
            crossings.takes_all = r->takes_all;
            float transmittance =
                __real_ray_trace_transmittance(p->scene, &r->ray, r->has_crossings ? &crossings : NULL);
            hit->geometry = transmittance > 0.0f ? VISIBILITY_NONE : 0;
        } else if (p->kind == RAYS_BOUNCE) {
            if (!__real_ray_trace_nearest(p->scene, &r->ray, r->random, hit))
                hit->geometry = VISIBILITY_NONE;
        } else {
            ray_first first = __real_ray_trace_first(p->scene, &r->ray, r->u);
            *hit = first.hit;
            if (!(first.opacity > 0.0f))
                hit->geometry = VISIBILITY_NONE;
        }
    }
}

rays_result rays_trace_facet(const shading_scene *scene, rays_kind kind, uint32_t thread_count)
{
    pass p = {.scene = scene,
              .kind = kind,
              .records = recording.items[kind],
              .count = recording.counts[kind],
              .hits = mem_zalloc(NULL, recording.counts[kind] + 1, sizeof(visibility_hit))};
    if (!p.hits)
        abort();
    memset(p.hits, 1, p.count * sizeof *p.hits); /* faults its pages in */
    double start = rays_now(uses_cpu_time, thread_count);
    parallel_for(thread_count, p.count, GRAIN, trace_facet, &p);
    rays_result result = {.seconds = rays_now(uses_cpu_time, thread_count) - start};
    for (size_t i = 0; i < p.count; i++)
        result.hits += p.hits[i].geometry != VISIBILITY_NONE;
    mem_free(p.hits);
    return result;
}

static void trace_embree(void *context, size_t begin, size_t end)
{
    const pass *p = context;
    RTCScene scene = ((const embree_scene *)p->scene->rays->bvh)->scene;
    if (p->kind == RAYS_SHADOW)
        for (size_t i = begin; i < end; i++)
            embree_occluded1(scene, &p->embree[i].ray);
    else
        for (size_t i = begin; i < end; i++)
            embree_intersect1(scene, &p->embree[i]);
}

rays_result rays_trace_embree(const shading_scene *scene, rays_kind kind, uint32_t thread_count)
{
    pass p = {.scene = scene,
              .kind = kind,
              .count = recording.counts[kind],
              .embree = mem_zalloc(NULL, recording.counts[kind] + 1, sizeof(struct RTCRayHit))};
    if (!p.embree)
        abort();
    for (size_t i = 0; i < p.count; i++) {
        const shading_ray *ray = &recording.items[kind][i].ray;
        p.embree[i].ray = (struct RTCRay){.org_x = ray->origin[0],
                                          .org_y = ray->origin[1],
                                          .org_z = ray->origin[2],
                                          .tnear = ray->near_t,
                                          .dir_x = ray->direction[0],
                                          .dir_y = ray->direction[1],
                                          .dir_z = ray->direction[2],
                                          .tfar = ray->far_t,
                                          .mask = UINT32_MAX};
        p.embree[i].hit.geomID = RTC_INVALID_GEOMETRY_ID;
        p.embree[i].hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    }
    double start = rays_now(uses_cpu_time, thread_count);
    parallel_for(thread_count, p.count, GRAIN, trace_embree, &p);
    rays_result result = {.seconds = rays_now(uses_cpu_time, thread_count) - start};
    for (size_t i = 0; i < p.count; i++)
        result.hits += kind == RAYS_SHADOW ? p.embree[i].ray.tfar < 0.0f
                                           : p.embree[i].hit.geomID != RTC_INVALID_GEOMETRY_ID;
    mem_free(p.embree);
    return result;
}

static void trace_packets(void *context, size_t begin, size_t end)
{
    static const _Alignas(64) int all[16] = {-1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1};
    const pass *p = context;
    RTCScene scene = ((const embree_scene *)p->scene->rays->bvh)->scene;
    for (size_t i = begin; i < end; i++)
        embree_intersect16(all, scene, &p->packet[i]);
}

rays_result rays_trace_packets(const shading_scene *scene, rays_kind kind, uint32_t thread_count)
{
    size_t count = recording.counts[kind] / 16;
    struct RTCRayHit16 *packets = aligned_alloc(64, (count + 1) * sizeof *packets);
    if (!packets)
        abort();
    memset(packets, 0, (count + 1) * sizeof *packets);
    for (size_t i = 0; i < count; i++)
        for (size_t lane = 0; lane < 16; lane++) {
            const shading_ray *ray = &recording.items[kind][16 * i + lane].ray;
            struct RTCRayHit16 *q = &packets[i];
            q->ray.org_x[lane] = ray->origin[0];
            q->ray.org_y[lane] = ray->origin[1];
            q->ray.org_z[lane] = ray->origin[2];
            q->ray.tnear[lane] = ray->near_t;
            q->ray.dir_x[lane] = ray->direction[0];
            q->ray.dir_y[lane] = ray->direction[1];
            q->ray.dir_z[lane] = ray->direction[2];
            q->ray.tfar[lane] = ray->far_t;
            q->ray.mask[lane] = UINT32_MAX;
            q->hit.geomID[lane] = RTC_INVALID_GEOMETRY_ID;
            q->hit.instID[0][lane] = RTC_INVALID_GEOMETRY_ID;
        }
    pass p = {.scene = scene, .kind = kind, .count = count, .packet = packets};
    double start = rays_now(uses_cpu_time, thread_count);
    parallel_for(thread_count, count, GRAIN / 16, trace_packets, &p);
    rays_result result = {.seconds = rays_now(uses_cpu_time, thread_count) - start};
    for (size_t i = 0; i < 16 * count; i++)
        result.hits += packets[i / 16].hit.geomID[i % 16] != RTC_INVALID_GEOMETRY_ID;
    free(packets);
    return result;
}
