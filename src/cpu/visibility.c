/* visibility.c - see visibility.h. Rays go to Embree in packets as wide as the machine's vectors. Consecutive rays
 * are the samples of a pixel, then the pixels of a 2 x 2 square, then the squares of the block: with four samples a
 * packet of 16 is one square, as narrow a bundle as can be. */
#include "cpu/visibility.h"

#include <stddef.h>

/* Pixels of a block in the order in which they are traced: 2 x 2 squares. */
static const uint8_t TRACE_ORDER[VISIBILITY_BLOCK_PIXELS] = {0, 1, 4,  5,  2,  3,  6,  7,
                                                             8, 9, 12, 13, 10, 11, 14, 15};

/* What an RTCRayHitN is made of: arrays of N values of 4 bytes each, in this order. */
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
    FIELD_COUNT = INSTANCE + RTC_MAX_INSTANCE_LEVEL_COUNT
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

/* Rays through the picture positions x, y; n is a constant where this is inlined, so the loop is vectorised. */
static inline __attribute__((always_inline)) void fill_packet(packet *p, int n, const camera_rays *camera,
                                                              const float *x, const float *y)
{
    for (int i = 0; i < n; i++) {
        float X = x[i] - camera->middle[0];
        float Y = y[i] - camera->middle[1];
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
    }
}

static inline __attribute__((always_inline)) void read_packet(const packet *p, int n, const uint32_t *slots,
                                                              visibility_hit *hits)
{
    for (int i = 0; i < n; i++)
        hits[slots[i]] = (visibility_hit){
            .t = p->f[T_FAR * n + i],
            .u = p->f[HIT_U * n + i],
            .v = p->f[HIT_V * n + i],
            .geometry = p->u[GEOMETRY * n + i],
            .primitive = p->u[PRIMITIVE * n + i],
            .normal = {p->f[NORMAL_X * n + i], p->f[NORMAL_Y * n + i], p->f[NORMAL_Z * n + i]}};
}

static void trace_packet(const embree_scene *scene, const camera_rays *camera, const float *x, const float *y,
                         const uint32_t *slots, visibility_hit *hits)
{
    static const _Alignas(64)
        int32_t all[16] = {-1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1};
    packet p;
    switch (scene->packet_width) {
    case 16:
        fill_packet(&p, 16, camera, x, y);
        embree_intersect16(all, scene->scene, &p.rays16);
        read_packet(&p, 16, slots, hits);
        break;
    case 8:
        fill_packet(&p, 8, camera, x, y);
        embree_intersect8(all, scene->scene, &p.rays8);
        read_packet(&p, 8, slots, hits);
        break;
    default:
        fill_packet(&p, 4, camera, x, y);
        embree_intersect4(all, scene->scene, &p.rays4);
        read_packet(&p, 4, slots, hits);
        break;
    }
}

void visibility_trace_block(const embree_scene *scene, const camera_rays *camera, uint32_t x, uint32_t y,
                            const visibility_pattern *pattern, visibility_hit *hits)
{
    uint32_t n = pattern->sample_count;
    uint32_t ray_count = VISIBILITY_BLOCK_PIXELS * n; /* a multiple of every packet's width */
    uint32_t place = 0;
    uint32_t sample = 0;
    for (uint32_t first = 0; first < ray_count; first += scene->packet_width) {
        float px[16];
        float py[16];
        uint32_t slots[16];
        for (uint32_t i = 0; i < scene->packet_width; i++) {
            uint32_t pixel = TRACE_ORDER[place];
            px[i] = (float)(x + pixel % VISIBILITY_BLOCK) + pattern->points[2 * sample];
            py[i] = (float)(y + pixel / VISIBILITY_BLOCK) + pattern->points[2 * sample + 1];
            slots[i] = pixel * n + sample;
            if (++sample == n) {
                sample = 0;
                place++;
            }
        }
        trace_packet(scene, camera, px, py, slots, hits);
    }
}
