/* embree_scene.c - see embree_scene.h. */
#include "cpu/embree_scene.h"

#include <stdio.h>
#include <sys/resource.h>

#include "base/parallel.h"
#include "base/result.h"

/* Embree frees more than it told of when an allocation was refused: what is given back is bounded. */
static bool count_memory(void *user, ssize_t bytes, bool post)
{
    (void)post;
    embree_memory *memory = user;
    if (bytes > 0) {
        if (!mem_account(&memory->allocator, bytes))
            return false;
        atomic_fetch_add(&memory->used, bytes);
        return true;
    }
    ptrdiff_t used = atomic_load(&memory->used);
    ptrdiff_t given;
    do {
        given = -bytes < used ? -bytes : used;
    } while (!atomic_compare_exchange_weak(&memory->used, &used, used - given));
    if (given > 0)
        mem_account(&memory->allocator, -given);
    return true;
}

static facet_result fail_embree(enum RTCError code, facet_error *error)
{
    if (code == RTC_ERROR_OUT_OF_MEMORY)
        return fail(error, FACET_ERROR_MEMORY, "out of memory: bounding volume hierarchy");
    if (code == RTC_ERROR_UNSUPPORTED_CPU)
        return fail(error, FACET_ERROR_ENVIRONMENT, "Embree does not run on this CPU");
    return fail(error, FACET_ERROR_BUG, "Embree: error %d while building the hierarchy", (int)code);
}

/* The number of the first vertex of each line; the vertices of a line are neighbours. */
static void set_lines(RTCGeometry geometry, const render_geometry *g)
{
    uint32_t count = g->primitive->index_count / 2;
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT4, g->vertices, 0,
                               4 * sizeof(float), 2 * (size_t)count);
    uint32_t *starts =
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT, sizeof(uint32_t), count);
    for (uint32_t i = 0; starts && i < count; i++)
        starts[i] = 2 * i;
}

/* How well to build for ray_count rays. A hierarchy by the surface area heuristic takes 250 to 400 ns more for each
 * triangle than one by Morton codes, whose rays take up to 30 ns longer (heavy.glb of bench/make_models: 5 ns). What
 * they hit is the same. Of several geometries the latter is a tree of trees that grows in any order, so that what is
 * hit first of surfaces in one place would depend on the threads. */
static enum RTCBuildQuality choose_quality(const render_geometry_set *set, uint64_t ray_count)
{
    enum { RAYS_PER_TRIANGLE = 8 };
    if (set->count != 1 || set->items[0].primitive->mode != SCENE_TRIANGLES)
        return RTC_BUILD_QUALITY_MEDIUM;
    uint64_t triangle_count = set->items[0].primitive->index_count / 3;
    return triangle_count * RAYS_PER_TRIANGLE > ray_count ? RTC_BUILD_QUALITY_LOW : RTC_BUILD_QUALITY_MEDIUM;
}

static RTCGeometry new_geometry(RTCDevice device, const render_geometry *g, enum RTCBuildQuality quality)
{
    const scene_primitive *primitive = g->primitive;
    RTCGeometry geometry = NULL;
    switch (primitive->mode) {
    case SCENE_TRIANGLES:
        geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
        rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, g->vertices, 0,
                                   3 * sizeof(float), primitive->vertex_count);
        rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, primitive->indices,
                                   0, 3 * sizeof(uint32_t), primitive->index_count / 3);
        break;
    case SCENE_LINES:
        geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_FLAT_LINEAR_CURVE);
        set_lines(geometry, g);
        break;
    case SCENE_POINTS:
        geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_DISC_POINT);
        rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT4, g->vertices, 0,
                                   4 * sizeof(float), primitive->index_count);
        break;
    }
    rtcSetGeometryBuildQuality(geometry, quality);
    rtcCommitGeometry(geometry);
    return geometry;
}

static uint32_t native_packet_width(RTCDevice device)
{
    if (rtcGetDeviceProperty(device, RTC_DEVICE_PROPERTY_NATIVE_RAY16_SUPPORTED))
        return 16;
    return rtcGetDeviceProperty(device, RTC_DEVICE_PROPERTY_NATIVE_RAY8_SUPPORTED) ? 8 : 4;
}

/* The number of threads that Embree may use; 0: it cannot be used. TBB, which it builds with, ends the process where
 * it is refused a thread: where few processes are allowed it is found out before whether that could happen, with
 * room for the threads that decode textures meanwhile. */
static uint32_t choose_threads(uint32_t thread_count)
{
    enum { PLENTY = 4096, LEAST = 4 };
    struct rlimit limit;
    if (getrlimit(RLIMIT_NPROC, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY || limit.rlim_cur >= PLENTY)
        return thread_count;
    uint32_t wanted = 3 * thread_count + LEAST;
    uint32_t startable = parallel_startable(wanted);
    return startable >= wanted ? thread_count : startable >= LEAST ? 1 : 0;
}

facet_result embree_scene_create(const render_geometry_set *set, const facet_allocator *allocator,
                                 uint64_t ray_count, uint32_t thread_count, embree_scene *out,
                                 facet_error *error)
{
    out->device = NULL;
    out->scene = NULL;
    out->memory.allocator = *allocator;
    atomic_init(&out->memory.used, 0);
    thread_count = choose_threads(thread_count);
    if (thread_count == 0)
        return fail(error, FACET_ERROR_ENVIRONMENT,
                    "threads: the system allows too few; Embree needs some (ulimit -u)");
    char config[64];
    snprintf(config, sizeof config, "threads=%u", thread_count);
    out->device = rtcNewDevice(config);
    if (!out->device)
        return fail_embree(rtcGetDeviceError(NULL), error);
    rtcSetDeviceMemoryMonitorFunction(out->device, count_memory, &out->memory);
    out->packet_width = native_packet_width(out->device);

    out->scene = rtcNewScene(out->device);
    /* Robust: no ray slips through between two triangles that share an edge. */
    rtcSetSceneFlags(out->scene, RTC_SCENE_FLAG_ROBUST | EMBREE_SCENE_FLAG_FILTER);
    enum RTCBuildQuality quality = choose_quality(set, ray_count);
    rtcSetSceneBuildQuality(out->scene, quality);
    for (uint32_t i = 0; i < set->count; i++) {
        if (set->items[i].primitive->index_count == 0)
            continue;
        RTCGeometry geometry = new_geometry(out->device, &set->items[i], quality);
        rtcAttachGeometryByID(out->scene, geometry, i);
        rtcReleaseGeometry(geometry);
    }
    rtcCommitScene(out->scene);

    enum RTCError code = rtcGetDeviceError(out->device);
    if (code != RTC_ERROR_NONE) {
        embree_scene_destroy(out);
        return fail_embree(code, error);
    }
    return FACET_OK;
}

void embree_scene_destroy(embree_scene *scene)
{
    if (scene->scene)
        rtcReleaseScene(scene->scene);
    if (scene->device)
        rtcReleaseDevice(scene->device);
    ptrdiff_t left = atomic_exchange(&scene->memory.used, 0);
    if (left > 0)
        mem_account(&scene->memory.allocator, -left);
    scene->scene = NULL;
    scene->device = NULL;
}
