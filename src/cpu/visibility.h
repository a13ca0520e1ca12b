/* visibility.h - camera visibility: the surfaces that the rays of an image hit. */
#ifndef CPU_VISIBILITY_H
#define CPU_VISIBILITY_H

#include "cpu/embree_scene.h"
#include "cpu/visibility_hit.h"

/* Side of the squares of pixels whose rays are traced together, aligned to multiples of itself in the whole
 * image: a crop traces the same packets. */
enum { VISIBILITY_BLOCK = 4, VISIBILITY_BLOCK_PIXELS = VISIBILITY_BLOCK * VISIBILITY_BLOCK };

_Static_assert(VISIBILITY_NONE == RTC_INVALID_GEOMETRY_ID, "no hit has one number");

/* Converts index and normal of a hit inside of an instance to those of its geometry: Embree's normal is in
 * the instance's space. The normal matrix keeps it outward; a mirrored instance's is negated to follow the
 * winding. */
static inline void visibility_leave_instance(const render_geometry_set *geometries, uint32_t instance,
                                             visibility_hit *hit)
{
    if (instance == embree_still_number(geometries))
        return;
    hit->geometry = instance;
    const render_geometry *g = &geometries->items[instance];
    const float *m = g->normal_matrix;
    const float sign = g->is_mirrored ? -1.0f : 1.0f;
    const float n[3] = {hit->normal[0] * sign, hit->normal[1] * sign, hit->normal[2] * sign};
    for (int i = 0; i < 3; i++)
        hit->normal[i] = m[3 * i] * n[0] + m[3 * i + 1] * n[1] + m[3 * i + 2] * n[2];
}

/* Reads a hit of a single ray at distance t from a filter or rtcIntersect1(); not RTC_INVALID_GEOMETRY_ID. */
static inline visibility_hit visibility_hit_read(const render_geometry_set *geometries, float t,
                                                 const struct RTCHit *h)
{
    visibility_hit hit = {.t = t,
                          .u = h->u,
                          .v = h->v,
                          .geometry = h->geomID,
                          .primitive = h->primID,
                          .normal = {h->Ng_x, h->Ng_y, h->Ng_z}};
    if (h->instID[0] != RTC_INVALID_GEOMETRY_ID)
        visibility_leave_instance(geometries, h->instID[0], &hit);
    return hit;
}

/* Sample positions of a block. */
typedef struct visibility_pattern {
    uint32_t sample_count;
    float *points;              /* 2 per sample, in pixels from the pixel's top left; block of mem_alloc() */
    float middle[2];            /* mean of points */
    float *offset_x, *offset_y; /* per ray of a block, in pixels from the block's top left */
} visibility_pattern;

/* The pattern of sample_pattern(). False: no memory. */
bool visibility_pattern_create(const facet_allocator *allocator, uint32_t sample_count,
                               visibility_pattern *out);
void visibility_pattern_destroy(visibility_pattern *pattern); /* {0} is allowed */

/* Traces the rays of the block whose top left pixel is (x, y) of the whole image, VISIBILITY_BLOCK_PIXELS *
 * sample_count hits. The other members of a hit of VISIBILITY_NONE are undefined. */
void visibility_trace_block(const embree_scene *scene, const camera_rays *camera, uint32_t x, uint32_t y,
                            const visibility_pattern *pattern, visibility_hit *hits);
/* Index of the first of the sample_count hits of a pixel of the block, pixels counted in rows. They are
 * traced in squares of 2 x 2: bits 1 and 2 of the index are swapped. */
static inline size_t visibility_first_hit(const visibility_pattern *pattern, uint32_t pixel)
{
    return (size_t)((pixel & 9) | (pixel & 2) << 1 | (pixel & 4) >> 1) * pattern->sample_count;
}

#endif
