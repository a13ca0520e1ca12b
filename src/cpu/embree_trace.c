/* embree_trace.c - rays through an embree_scene. Camera rays go to Embree in packets as wide as the machine's vectors.
 * Consecutive rays are the samples of a pixel, then the pixels of a 2 x 2 square, then the squares of the
 * block: with four samples a packet of 16 is one square, the most coherent bundle. */
#include <stddef.h>

#include "base/memory.h"
#include "base/result.h"
#include "cpu/embree_scene.h"
#include "cpu/visibility.h"
#include "draw/camera_rays.h"

_Static_assert(VISIBILITY_NONE == RTC_INVALID_GEOMETRY_ID, "no hit has one number");

/* ---- hits ---- */

/* instance: as Embree has it. What is in RENDER_STILL's instance has indices of the set, and normals of the world. */
static inline void leave_instance(const render_geometry_set *geometries, uint32_t instance,
                                  visibility_hit *hit)
{
    if (instance != RTC_INVALID_GEOMETRY_ID && instance != embree_still_number(geometries))
        ray_leave_instance(geometries, instance, hit);
}

static inline visibility_hit read_hit(const render_geometry_set *geometries, float t, const struct RTCHit *h)
{
    visibility_hit hit = {.t = t,
                          .u = h->u,
                          .v = h->v,
                          .geometry = h->geomID,
                          .primitive = h->primID,
                          .normal = {h->Ng_x, h->Ng_y, h->Ng_z}};
    leave_instance(geometries, h->instID[0], &hit);
    return hit;
}

/* ---- single rays ---- */

static inline struct RTCRay make_ray(const ray_segment *ray)
{
    return (struct RTCRay){.org_x = ray->origin[0],
                           .org_y = ray->origin[1],
                           .org_z = ray->origin[2],
                           .tnear = ray->near_t,
                           .dir_x = ray->direction[0],
                           .dir_y = ray->direction[1],
                           .dir_z = ray->direction[2],
                           .tfar = ray->far_t,
                           .mask = UINT32_MAX};
}

static inline bool read_ray(const embree_scene *e, const struct RTCRayHit *ray, visibility_hit *hit)
{
    if (ray->hit.geomID == RTC_INVALID_GEOMETRY_ID)
        return false;
    *hit = read_hit(e->geometries, ray->ray.tfar, &ray->hit);
    return true;
}

static bool trace_nearest(const void *bvh, const ray_segment *ray, visibility_hit *hit)
{
    const embree_scene *e = bvh;
    struct RTCRayHit r = {.ray = make_ray(ray), .hit = embree_no_hit()};
    embree_intersect1(e->scene, &r);
    return read_ray(e, &r, hit);
}

static bool trace_occluded(const void *bvh, const ray_segment *ray)
{
    const embree_scene *e = bvh;
    struct RTCRay r = make_ray(ray);
    return embree_occluded1(e->scene, &r);
}

/* ---- with a filter ---- */

typedef struct filtered {
    embree_context context; /* first: what Embree hands to the filter */
    const render_geometry_set *geometries;
    ray_filter filter;
    void *user;
} filtered;

static void call_filter(const struct RTCFilterFunctionNArguments *arguments)
{
    if (arguments->valid[0] != -1)
        return;
    const filtered *f = (const filtered *)(const void *)arguments->context;
    const struct RTCRay *ray = (const struct RTCRay *)(const void *)arguments->ray;
    const struct RTCHit *h = (const struct RTCHit *)(const void *)arguments->hit;
    const visibility_hit hit = read_hit(f->geometries, ray->tfar, h);
    if (!f->filter(f->user, &hit))
        arguments->valid[0] = 0;
}

static bool trace_nearest_filtered(const void *bvh, const ray_segment *ray, ray_filter filter, void *context,
                                   visibility_hit *hit)
{
    const embree_scene *e = bvh;
    filtered f = {.geometries = e->geometries, .filter = filter, .user = context};
    struct RTCRayHit r = {.ray = make_ray(ray), .hit = embree_no_hit()};
    embree_intersect1_filtered(e->scene, &r, &f.context, call_filter);
    return read_ray(e, &r, hit);
}

static bool trace_occluded_filtered(const void *bvh, const ray_segment *ray, ray_filter filter, void *context)
{
    const embree_scene *e = bvh;
    filtered f = {.geometries = e->geometries, .filter = filter, .user = context};
    struct RTCRay r = make_ray(ray);
    return embree_occluded1_filtered(e->scene, &r, &f.context, call_filter);
}

static void get_bounds(const void *bvh, float minimum[3], float maximum[3])
{
    const embree_scene *e = bvh;
    struct RTCBounds b;
    embree.GetSceneBounds(e->scene, &b);
    const float low[3] = {b.lower_x, b.lower_y, b.lower_z};
    const float high[3] = {b.upper_x, b.upper_y, b.upper_z};
    for (int i = 0; i < 3; i++) {
        minimum[i] = low[i];
        maximum[i] = high[i];
    }
}

/* ---- packets ---- */

/* The layout of RTCRayHitN: arrays of N values of 4 bytes each, in this order. */
enum ray_field {
    ORG_X,
    ORG_Y,
    ORG_Z,
    T_NEAR,
    DIR_X,
    DIR_Y,
    DIR_Z,
    TIME,
    T_FAR,
    MASK,
    ID,
    FLAGS,
    NORMAL_X,
    NORMAL_Y,
    NORMAL_Z,
    HIT_U,
    HIT_V,
    PRIMITIVE,
    GEOMETRY,
    INSTANCE,
#if defined(RTC_GEOMETRY_INSTANCE_ARRAY)
    INSTANCE_PRIMITIVE = INSTANCE + RTC_MAX_INSTANCE_LEVEL_COUNT,
    FIELD_COUNT = INSTANCE_PRIMITIVE + RTC_MAX_INSTANCE_LEVEL_COUNT
#else
    FIELD_COUNT = INSTANCE + RTC_MAX_INSTANCE_LEVEL_COUNT
#endif
};
_Static_assert(offsetof(struct RTCRayHit16, ray.tfar) == T_FAR * 64, "order of fields");
_Static_assert(offsetof(struct RTCRayHit16, hit.geomID) == GEOMETRY * 64, "order of fields");
_Static_assert(offsetof(struct RTCRayHit8, hit.geomID) == GEOMETRY * 32, "order of fields");
_Static_assert(offsetof(struct RTCRayHit4, hit.geomID) == GEOMETRY * 16, "order of fields");

typedef union packet {
    struct RTCRayHit4 rays4;
    struct RTCRayHit8 rays8;
    struct RTCRayHit16 rays16;
    float f[FIELD_COUNT * 16];
    uint32_t u[FIELD_COUNT * 16];
} packet;

/* Rays through (x, y) plus offsets; n is a constant where this is inlined, so the loop is vectorised. */
static inline __attribute__((always_inline)) void fill_packet(packet *p, int n, const camera_rays *camera,
                                                              float x, float y, const float *offset_x,
                                                              const float *offset_y)
{
    for (int i = 0; i < n; i++) {
        float X = x + offset_x[i] - camera->middle[0];
        float Y = y + offset_y[i] - camera->middle[1];
        for (int axis = 0; axis < 3; axis++) {
            p->f[(ORG_X + axis) * n + i] =
                camera->origin[axis] + X * camera->origin_dx[axis] + Y * camera->origin_dy[axis];
            p->f[(DIR_X + axis) * n + i] =
                camera->direction[axis] + X * camera->direction_dx[axis] + Y * camera->direction_dy[axis];
        }
        p->f[T_NEAR * n + i] = camera->near_m;
        p->f[T_FAR * n + i] = camera->far_m;
        p->f[TIME * n + i] = 0.0f;
        p->u[MASK * n + i] = UINT32_MAX;
        p->u[ID * n + i] = 0;
        p->u[FLAGS * n + i] = 0;
        p->u[GEOMETRY * n + i] = RTC_INVALID_GEOMETRY_ID;
        p->u[INSTANCE * n + i] = RTC_INVALID_GEOMETRY_ID;
#if defined(RTC_GEOMETRY_INSTANCE_ARRAY)
        p->u[INSTANCE_PRIMITIVE * n + i] = RTC_INVALID_GEOMETRY_ID;
#endif
    }
}

static inline __attribute__((always_inline)) void read_packet(const packet *p, int n, visibility_hit *hits)
{
    for (int i = 0; i < n; i++) {
        hits[i].geometry = p->u[GEOMETRY * n + i];
        if (hits[i].geometry == VISIBILITY_NONE)
            continue;
        hits[i].primitive = p->u[PRIMITIVE * n + i];
        hits[i].t = p->f[T_FAR * n + i];
        hits[i].u = p->f[HIT_U * n + i];
        hits[i].v = p->f[HIT_V * n + i];
        hits[i].normal[0] = p->f[NORMAL_X * n + i];
        hits[i].normal[1] = p->f[NORMAL_Y * n + i];
        hits[i].normal[2] = p->f[NORMAL_Z * n + i];
    }
}

static void leave_instances(const render_geometry_set *geometries, const packet *p, uint32_t n,
                            visibility_hit *hits)
{
    for (uint32_t i = 0; i < n; i++)
        if (hits[i].geometry != VISIBILITY_NONE)
            leave_instance(geometries, p->u[INSTANCE * n + i], &hits[i]);
}

static void trace_block(const void *bvh, const camera_rays *camera, uint32_t x, uint32_t y,
                        const visibility_pattern *pattern, visibility_hit *hits)
{
    const embree_scene *scene = bvh;
    static const _Alignas(64)
        int32_t all[16] = {-1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1};
    float left = (float)x;
    float top = (float)y;
    uint32_t width = scene->packet_width;
    uint32_t ray_count = VISIBILITY_BLOCK_PIXELS * pattern->sample_count; /* a multiple of every width */
    packet p;
    for (uint32_t first = 0; first < ray_count; first += width) {
        const float *offset_x = pattern->offset_x + first;
        const float *offset_y = pattern->offset_y + first;
        switch (width) {
        case 16:
            fill_packet(&p, 16, camera, left, top, offset_x, offset_y);
            embree_intersect16(all, scene->scene, &p.rays16);
            read_packet(&p, 16, hits + first);
            break;
        case 8:
            fill_packet(&p, 8, camera, left, top, offset_x, offset_y);
            embree_intersect8(all, scene->scene, &p.rays8);
            read_packet(&p, 8, hits + first);
            break;
        default:
            fill_packet(&p, 4, camera, left, top, offset_x, offset_y);
            embree_intersect4(all, scene->scene, &p.rays4);
            read_packet(&p, 4, hits + first);
            break;
        }
        if (scene->has_instances)
            leave_instances(scene->geometries, &p, width, hits + first);
    }
}

/* ---- the functions of a scene ---- */

static facet_result create(const render_geometry_set *set, const ray_scene_desc *desc,
                           const facet_allocator *allocator, void **bvh, facet_error *error)
{
    embree_scene *e = mem_zalloc(allocator, 1, sizeof *e);
    *bvh = NULL;
    if (!e)
        return fail_memory(error, "bounding volume hierarchy", sizeof *e);
    const facet_result result =
        embree_scene_create(set, allocator, desc->ray_count, desc->thread_count, desc->isa, e, error);
    if (result != FACET_OK) {
        mem_free(e);
        return result;
    }
    *bvh = e;
    return FACET_OK;
}

static facet_result update(void *bvh, const ray_scene_desc *desc, render_likeness likeness,
                           bool has_moved_sprites, facet_error *error)
{
    return embree_scene_update(bvh, likeness, has_moved_sprites, desc->ray_count, error);
}

static void destroy(void *bvh)
{
    embree_scene_destroy(bvh);
    mem_free(bvh);
}

static const ray_tracer embree_tracer = {.create = create,
                                         .update = update,
                                         .destroy = destroy,
                                         .bounds = get_bounds,
                                         .nearest = trace_nearest,
                                         .nearest_filtered = trace_nearest_filtered,
                                         .occluded = trace_occluded,
                                         .occluded_filtered = trace_occluded_filtered,
                                         .block = trace_block};

facet_result embree_find_tracer(const ray_tracer **out, facet_error *error)
{
    *out = &embree_tracer;
    return embree_open(error);
}
