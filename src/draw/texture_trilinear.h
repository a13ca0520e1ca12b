/* texture_trilinear.h - anisotropic trilinear lookups, in several textures at once. */
#ifndef DRAW_TEXTURE_TRILINEAR_H
#define DRAW_TEXTURE_TRILINEAR_H

#include "draw/texture_set.h"

#include "draw/texture_footprint.h"

/* Whether two textures are read at the same texels with the same weights. */
static inline bool texture_is_alike(const texture_binding *a, const texture_pyramid *p,
                                    const texture_binding *b, const texture_pyramid *q)
{
    return a->wrap_u == b->wrap_u && a->wrap_v == b->wrap_v && a->min_filter == b->min_filter &&
           a->mip_filter == b->mip_filter && p->width == q->width && p->height == q->height &&
           p->first_level == q->first_level;
}

/* The mean of the probes of place_probes() in count textures, 1 to TEXTURE_GROUP, that are all alike. */
void texture_trilinear(const texture_binding *binding, const texture_pyramid *const *pyramids, uint32_t count,
                       const float uv[2], const Footprint *f, float (*out)[4]);

#endif
