/* shading_frame.h - normals and tangents at a hit. Holds shared shading text: include it last. */
#ifndef CPU_SHADING_FRAME_H
#define CPU_SHADING_FRAME_H

#include "cpu/shading_hit.h"

/* Tangent, bitangent and normal in world space on the side that is seen, as they are interpolated: not unit, not
 * quite at right angles, which is what MikkTSpace (2008) and the tools that bake for it use. */
typedef struct shading_frame {
    vec3 T, B, N;
} shading_frame;

/* The unit vector, or otherwise where v has no direction. */
static inline vec3 normalize_or(vec3 v, vec3 otherwise)
{
    float length2 = dot(v, v);
    return length2 > 1e-30f ? v * inversesqrt(length2) : otherwise;
}

/* With the tangents of the geometry, which has some. */
shading_frame shading_frame_of_tangents(const shading_hit *h, bool is_front);
/* With the directions in which TEXCOORD_set grows on the triangle; false: it does not grow. */
bool shading_frame_of_texcoord(const shading_hit *h, bool is_front, uint32_t set, shading_frame *frame);
/* The interpolated normal, not unit; the geometry has some. */
static inline vec3 shading_frame_normal(const shading_hit *h, bool is_front)
{
    const float *m = h->geometry->normal_matrix;
    vec3 n = shading_hit_vec3(h, h->geometry->normals);
    return vec3(dot(load3(m), n), dot(load3(m + 3), n), dot(load3(m + 6), n)) * (is_front ? 1.0f : -1.0f);
}
/* The vector that a texel of a normal texture holds, with its scale; false: nothing that is a normal (it could not be
 * decoded and reads as white). glTF 2.0, 3.9.3. */
bool shading_frame_decode(const float texel[4], float scale, vec3 *n);

#endif
