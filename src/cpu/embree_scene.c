/* embree_scene.c - see embree_scene.h. */
#include "cpu/embree_scene.h"

#include <stdio.h>
#include <sys/resource.h>

#include "base/parallel.h"
#include "base/result.h"

/* Embree may report more freed than allocated bytes after a refused allocation: the sum is kept from
 * underflow. */
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
        return fail(
            error, FACET_ERROR_SYSTEM,
            "Embree does not run on this processor, or not with the instruction set that was asked for");
    return fail(error, FACET_ERROR_BUG, "Embree: error %d while building the hierarchy", (int)code);
}

/* The first vertex of each line; the vertices of a line are consecutive. */
static void set_lines(RTCGeometry geometry, const render_geometry *g)
{
    uint32_t count = g->primitive->index_count / 2;
    embree.SetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT4, g->vertices, 0,
                                   4 * sizeof(float), 2 * (size_t)count);
    uint32_t *starts = embree.SetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT,
                                                   sizeof(uint32_t), count);
    for (uint32_t i = 0; starts && i < count; i++)
        starts[i] = 2 * i;
}

/* The build quality of a BVH of triangles for ray_count rays. The surface area heuristic takes 250 to 400
 * ns more per triangle than Morton codes, whose rays take up to 30 ns longer (heavy.glb of
 * bench/make_models: 5 ns). Hits are the same, except which of two triangles is hit at their common edge.
 * With several geometries Morton codes build a tree of trees in any order, so that the first hit of
 * coincident surfaces would depend on the threads. */
static enum RTCBuildQuality choose_quality(const scene_primitive *only, uint64_t ray_count)
{
    enum { RAYS_PER_TRIANGLE = 8 };
    if (only->mode != SCENE_TRIANGLES)
        return RTC_BUILD_QUALITY_MEDIUM;
    uint64_t triangle_count = only->index_count / 3;
    return triangle_count * RAYS_PER_TRIANGLE > ray_count ? RTC_BUILD_QUALITY_LOW : RTC_BUILD_QUALITY_MEDIUM;
}

/* A BVH that is kept for the frames of an animation gets the high quality: it traces many rays. */
static enum RTCBuildQuality choose_scene_quality(const render_geometry_set *set, uint64_t ray_count)
{
    if (set->count != 1 || set->items[0].role != RENDER_FLAT)
        return RTC_BUILD_QUALITY_MEDIUM;
    return choose_quality(set->items[0].primitive, ray_count);
}

static enum RTCBuildQuality choose_shape_quality(const render_geometry_set *set, uint32_t shape,
                                                 uint64_t ray_count)
{
    return set->is_animated ? RTC_BUILD_QUALITY_MEDIUM
                            : choose_quality(set->shapes[shape].primitive, ray_count);
}

static RTCGeometry new_triangles(RTCDevice device, const scene_primitive *primitive, const float *vertices)
{
    RTCGeometry geometry = embree.NewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    embree.SetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, vertices, 0,
                                   3 * sizeof(float), primitive->vertex_count);
    embree.SetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, primitive->indices,
                                   0, 3 * sizeof(uint32_t), primitive->index_count / 3);
    return geometry;
}

static RTCGeometry new_geometry(RTCDevice device, const render_geometry *g)
{
    const scene_primitive *primitive = g->primitive;
    RTCGeometry geometry = NULL;
    switch (primitive->mode) {
    case SCENE_TRIANGLES:
        geometry = new_triangles(device, primitive, g->vertices);
        break;
    case SCENE_LINES:
        geometry = embree.NewGeometry(device, RTC_GEOMETRY_TYPE_FLAT_LINEAR_CURVE);
        set_lines(geometry, g);
        break;
    case SCENE_POINTS:
        geometry = embree.NewGeometry(device, RTC_GEOMETRY_TYPE_DISC_POINT);
        embree.SetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT4, g->vertices, 0,
                                       4 * sizeof(float), primitive->index_count);
        break;
    }
    return geometry;
}

static RTCScene new_scene(RTCDevice device, enum RTCBuildQuality quality)
{
    RTCScene scene = embree.NewScene(device);
    /* Robust: no ray passes between two triangles that share an edge. */
    embree.SetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST | EMBREE_SCENE_FLAG_FILTER);
    embree.SetSceneBuildQuality(scene, quality);
    return scene;
}

static void attach(RTCScene scene, RTCGeometry geometry, uint32_t number, enum RTCBuildQuality quality)
{
    embree.SetGeometryBuildQuality(geometry, quality);
    embree.CommitGeometry(geometry);
    embree.AttachGeometryByID(scene, geometry, number);
    embree.ReleaseGeometry(geometry);
}

static void attach_instance(const embree_scene *e, RTCScene shape, const float world[16], uint32_t number)
{
    RTCGeometry geometry = embree.NewGeometry(e->device, RTC_GEOMETRY_TYPE_INSTANCE);
    embree.SetGeometryInstancedScene(geometry, shape);
    embree.SetGeometryTransform(geometry, 0, RTC_FORMAT_FLOAT4X4_COLUMN_MAJOR, world);
    attach(e->scene, geometry, number, RTC_BUILD_QUALITY_MEDIUM);
}

/* Attaches all geometries of a role under their indices. */
static void attach_role(const embree_scene *e, RTCScene scene, render_role role, enum RTCBuildQuality quality)
{
    const render_geometry_set *set = e->geometries;
    for (uint32_t i = 0; i < set->count; i++)
        if (set->items[i].role == role && set->items[i].primitive->index_count)
            attach(scene, new_geometry(e->device, &set->items[i]), i, quality);
}

static void release(RTCScene *scene)
{
    if (*scene)
        embree.ReleaseScene(*scene);
    *scene = NULL;
}

/* ---- parts ---- */

static void build_still(embree_scene *e)
{
    if (e->still.scene || !e->geometries->is_animated)
        return;
    e->still.quality = RTC_BUILD_QUALITY_MEDIUM;
    e->still.scene = new_scene(e->device, e->still.quality);
    attach_role(e, e->still.scene, RENDER_STILL, e->still.quality);
    embree.CommitScene(e->still.scene);
}

static void build_shapes(embree_scene *e, uint64_t ray_count)
{
    const render_geometry_set *set = e->geometries;
    for (uint32_t i = 0; i < e->shape_count; i++) {
        embree_part *part = &e->shapes[i];
        if (part->scene)
            continue;
        part->quality = choose_shape_quality(set, i, ray_count);
        part->scene = new_scene(e->device, part->quality);
        attach(part->scene, new_triangles(e->device, set->shapes[i].primitive, set->shapes[i].vertices), 0,
               part->quality);
        embree.CommitScene(part->scene);
    }
}

static void build_top(embree_scene *e, uint64_t ray_count)
{
    static const float identity[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    const render_geometry_set *set = e->geometries;
    e->quality = choose_scene_quality(set, ray_count);
    e->scene = new_scene(e->device, e->quality);
    attach_role(e, e->scene, RENDER_FLAT, e->quality);
    if (e->still.scene)
        attach_instance(e, e->still.scene, identity, embree_still_number(set));
    for (uint32_t i = 0; i < set->count && e->shape_count; i++)
        if (set->items[i].role == RENDER_INSTANCED)
            attach_instance(e, e->shapes[set->items[i].shape].scene, set->items[i].world->m, i);
    e->has_instances = e->still.scene || e->shape_count;
    embree.CommitScene(e->scene);
}

static uint32_t native_packet_width(RTCDevice device)
{
    if (embree.GetDeviceProperty(device, RTC_DEVICE_PROPERTY_NATIVE_RAY16_SUPPORTED))
        return 16;
    return embree.GetDeviceProperty(device, RTC_DEVICE_PROPERTY_NATIVE_RAY8_SUPPORTED) ? 8 : 4;
}

/* Fails where Embree was built without something that facet draws with. Curves and points are lines and points of glTF. */
static facet_result check_features(RTCDevice device, facet_error *error)
{
    static const struct {
        enum RTCDeviceProperty property;
        const char *name;
    } needed[] = {{RTC_DEVICE_PROPERTY_TRIANGLE_GEOMETRY_SUPPORTED, "triangles"},
                  {RTC_DEVICE_PROPERTY_CURVE_GEOMETRY_SUPPORTED, "curves"},
                  {RTC_DEVICE_PROPERTY_POINT_GEOMETRY_SUPPORTED, "points"},
                  {RTC_DEVICE_PROPERTY_FILTER_FUNCTION_SUPPORTED, "filter functions"}};
    for (size_t i = 0; i < sizeof needed / sizeof *needed; i++)
        if (!embree.GetDeviceProperty(device, needed[i].property))
            return fail(error, FACET_ERROR_SYSTEM, "Embree: this build of %s has no %s; facet needs them",
                        embree_scene_version(), needed[i].name);
    return FACET_OK;
}

/* The number of threads that Embree may use; 0: it cannot be used. TBB, with which it builds, aborts the
 * process where it is refused a thread: where the process limit is low, this is checked first, with room
 * for the threads that decode textures meanwhile. */
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

/* Embree's device configuration: "max_isa" is an upper limit, "isa" is exactly that one. */
static void write_config(uint32_t thread_count, facet_isa isa, char *config, size_t size)
{
#if defined(__x86_64__)
    static const char *const settings[] = {
        [FACET_ISA_PORTABLE] = ",max_isa=avx", [FACET_ISA_NATIVE] = "",      [FACET_ISA_SSE2] = ",isa=sse2",
        [FACET_ISA_SSE4_2] = ",isa=sse4.2",    [FACET_ISA_AVX] = ",isa=avx", [FACET_ISA_AVX2] = ",isa=avx2",
        [FACET_ISA_AVX512] = ",isa=avx512"};
#else
    static const char *const settings[FACET_ISA_AVX512 + 1] = {"", "", "", "", "", "", ""};
#endif
    snprintf(config, size, "threads=%u%s", thread_count, settings[isa]);
}

static void release_shapes(embree_scene *e)
{
    for (uint32_t i = 0; i < e->shape_count; i++)
        release(&e->shapes[i].scene);
    mem_free(e->shapes);
    e->shapes = NULL;
    e->shape_count = 0;
}

/* Releases the parts that have to be rebuilt. */
static void drop(embree_scene *e, render_likeness likeness, uint64_t ray_count)
{
    const render_geometry_set *set = e->geometries;
    release(&e->scene);
    if (likeness == RENDER_OTHER) {
        release(&e->still.scene);
        release_shapes(e);
        return;
    }
    for (uint32_t i = 0; i < e->shape_count; i++) {
        const render_shape *shape = &set->shapes[i];
        if (shape->positions != shape->primitive->positions ||
            e->shapes[i].quality != choose_shape_quality(set, i, ray_count))
            release(&e->shapes[i].scene);
    }
}

static bool is_up_to_date(const embree_scene *e, uint64_t ray_count)
{
    const render_geometry_set *set = e->geometries;
    if (!e->scene || e->quality != choose_scene_quality(set, ray_count))
        return false;
    for (uint32_t i = 0; i < e->shape_count; i++)
        if (e->shapes[i].quality != choose_shape_quality(set, i, ray_count))
            return false;
    return true;
}

/* Counts Embree's own objects of geometries and instances against the budget: Embree does not report them.
 * Measured with 3.13.5: 290 bytes for an instance, 465 for triangles, 450 for points, 740 for lines. */
static bool account_objects(embree_scene *e)
{
    enum { INSTANCE_SIZE = 320, GEOMETRY_SIZE = 512, LINES_SIZE = 768 };
    const render_geometry_set *set = e->geometries;
    ptrdiff_t bytes = (ptrdiff_t)set->shape_count * GEOMETRY_SIZE;
    for (uint32_t i = 0; i < set->count; i++)
        bytes += set->items[i].role == RENDER_INSTANCED         ? INSTANCE_SIZE
                 : set->items[i].primitive->mode == SCENE_LINES ? LINES_SIZE
                                                                : GEOMETRY_SIZE;
    ptrdiff_t change = bytes - e->object_bytes;
    if (!mem_account(&e->memory.allocator, change))
        return false;
    e->object_bytes = bytes;
    return true;
}

static facet_result build(embree_scene *e, uint64_t ray_count, facet_error *error)
{
    const render_geometry_set *set = e->geometries;
    bool has_memory = account_objects(e);
    if (has_memory && set->shape_count && !e->shapes) {
        e->shapes = mem_zalloc(&e->memory.allocator, set->shape_count, sizeof *e->shapes);
        e->shape_count = e->shapes ? set->shape_count : 0;
        has_memory = e->shapes != NULL;
    }
    enum RTCError code = RTC_ERROR_OUT_OF_MEMORY;
    if (has_memory) {
        build_still(e);
        build_shapes(e, ray_count);
        build_top(e, ray_count);
        code = embree.GetDeviceError(e->device);
    }
    if (code == RTC_ERROR_NONE)
        return FACET_OK;
    embree_scene_destroy(e);
    return fail_embree(code, error);
}

facet_result embree_scene_create(const render_geometry_set *set, const facet_allocator *allocator,
                                 uint64_t ray_count, uint32_t thread_count, facet_isa isa, embree_scene *out,
                                 facet_error *error)
{
    *out = (embree_scene){.geometries = set};
    out->memory.allocator = *allocator;
    atomic_init(&out->memory.used, 0);
    thread_count = choose_threads(thread_count);
    if (thread_count == 0)
        return fail(error, FACET_ERROR_SYSTEM,
                    "threads: the system allows too few; Embree needs some (ulimit -u)");
    TRY(embree_open(error));
    char config[64];
    write_config(thread_count, isa, config, sizeof config);
    out->device = embree.NewDevice(config);
    if (!out->device)
        return fail_embree(embree.GetDeviceError(NULL), error);
    facet_result result = check_features(out->device, error);
    if (result != FACET_OK) {
        embree_scene_destroy(out);
        return result;
    }
    embree.SetDeviceMemoryMonitorFunction(out->device, count_memory, &out->memory);
    out->packet_width = native_packet_width(out->device);
    return build(out, ray_count, error);
}

facet_result embree_scene_update(embree_scene *scene, render_likeness likeness, bool has_moved_sprites,
                                 uint64_t ray_count, facet_error *error)
{
    if (likeness == RENDER_SAME && !has_moved_sprites && is_up_to_date(scene, ray_count))
        return FACET_OK;
    drop(scene, likeness, ray_count);
    return build(scene, ray_count, error);
}

void embree_scene_destroy(embree_scene *scene)
{
    release(&scene->scene);
    release(&scene->still.scene);
    release_shapes(scene);
    if (scene->device)
        embree.ReleaseDevice(scene->device);
    scene->device = NULL;
    ptrdiff_t left = atomic_exchange(&scene->memory.used, 0) + scene->object_bytes;
    if (left > 0)
        mem_account(&scene->memory.allocator, -left);
    scene->object_bytes = 0;
}

void embree_find_version(char *version, size_t size)
{
    *version = 0;
    RTCDevice device = embree_open(NULL) == FACET_OK ? embree.NewDevice("threads=1") : NULL;
    if (!device)
        return;
    snprintf(version, size, "%d.%d.%d",
             (int)embree.GetDeviceProperty(device, RTC_DEVICE_PROPERTY_VERSION_MAJOR),
             (int)embree.GetDeviceProperty(device, RTC_DEVICE_PROPERTY_VERSION_MINOR),
             (int)embree.GetDeviceProperty(device, RTC_DEVICE_PROPERTY_VERSION_PATCH));
    embree.ReleaseDevice(device);
}

const char *embree_scene_version(void)
{
    return RTC_VERSION_STRING;
}
