/* shading_frame.h - normals and tangents at a hit. Holds shared shading text: include it last. */
#ifndef CPU_SHADING_FRAME_H
#define CPU_SHADING_FRAME_H

#include "cpu/shading_hit.h"

/* With the tangents of the geometry, which has some. */
ShadingFrame shading_frame_of_tangents(const shading_hit *h, bool is_front);
/* With the directions in which TEXCOORD_set grows on the triangle; no tangent where it does not grow. */
ShadingFrame shading_frame_of_texcoord(const shading_hit *h, bool is_front, uint32_t set);
/* The interpolated normal, not unit; the geometry has some. */
static inline vec3 shading_frame_normal(const shading_hit *h, bool is_front)
{
    const float *m = h->geometry->normal_matrix;
    vec3 n = shading_hit_vec3(h, h->geometry->normals);
    return vec3(dot(load3(m), n), dot(load3(m + 3), n), dot(load3(m + 6), n)) * (is_front ? 1.0f : -1.0f);
}

#endif
