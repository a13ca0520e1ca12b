/* visibility.c - see visibility.h. Rays go to Embree in packets as wide as the machine's vectors.
 * Consecutive rays are the samples of a pixel, then the pixels of a 2 x 2 square, then the squares of the
 * block: with four samples a packet of 16 is one square, the most coherent bundle. */
#include "cpu/visibility.h"

#include <stddef.h>

#include "draw/camera_rays.h"

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
        if (hits[i].geometry != VISIBILITY_NONE && p->u[INSTANCE * n + i] != RTC_INVALID_GEOMETRY_ID)
            visibility_leave_instance(geometries, p->u[INSTANCE * n + i], &hits[i]);
}

void visibility_trace_block(const embree_scene *scene, const camera_rays *camera, uint32_t x, uint32_t y,
                            const visibility_pattern *pattern, visibility_hit *hits)
{
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

/* ---- patterns ---- */

bool visibility_pattern_create(const facet_allocator *allocator, uint32_t sample_count,
                               visibility_pattern *out)
{
    size_t ray_count = (size_t)VISIBILITY_BLOCK_PIXELS * sample_count;
    *out =
        (visibility_pattern){.sample_count = sample_count,
                             .points = mem_alloc(allocator, 2 * (sample_count + ray_count), sizeof(float))};
    if (!out->points)
        return false;
    out->offset_x = out->points + 2 * (size_t)sample_count;
    out->offset_y = out->offset_x + ray_count;
    sample_pattern(sample_count, out->points);
    for (uint32_t i = 0; i < 2 * sample_count; i++)
        out->middle[i % 2] += out->points[i];
    out->middle[0] /= (float)sample_count;
    out->middle[1] /= (float)sample_count;
    for (uint32_t pixel = 0; pixel < VISIBILITY_BLOCK_PIXELS; pixel++) {
        size_t first = visibility_first_hit(out, pixel);
        for (uint32_t i = 0; i < sample_count; i++) {
            out->offset_x[first + i] = (float)(pixel % VISIBILITY_BLOCK) + out->points[2 * i];
            out->offset_y[first + i] = (float)(pixel / VISIBILITY_BLOCK) + out->points[2 * i + 1];
        }
    }
    return true;
}

void visibility_pattern_destroy(visibility_pattern *pattern)
{
    mem_free(pattern->points);
    *pattern = (visibility_pattern){0};
}
