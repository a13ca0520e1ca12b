/* shading_hit.h - where on its triangle, line or point a ray hit, and the vertex attributes there. Holds shared shading
 * text: include it last. */
#ifndef CPU_SHADING_HIT_H
#define CPU_SHADING_HIT_H

#include "cpu/shading.h"
#include "shade/shade.h"

/* Corners of the triangle, weights at the hit, and how the weights change from pixel to pixel. */
typedef struct shading_hit {
    const render_geometry *geometry;
    size_t first_index;
    size_t corner[3]; /* vertex numbers */
    float weight[3];
    float dx[2], dy[2]; /* of weight[1], weight[2] over the ray's footprint */
    vec3 direction;     /* of the ray */
    vec3 position;      /* world, m */
} shading_hit;

/* TEXCOORD_n, and its change over the footprint along the picture's x and y. */
typedef struct shading_texcoord {
    float uv[2], dx[2], dy[2];
} shading_texcoord;

static inline vec3 load3(const float *v)
{
    return vec3(v[0], v[1], v[2]);
}

static inline void store3(vec3 v, float out[3])
{
    for (int i = 0; i < 3; i++)
        out[i] = v[i];
}

shading_hit shading_hit_make(const shading_scene *scene, const shading_point *point);
/* An attribute of 3 floats per vertex. */
vec3 shading_hit_vec3(const shading_hit *h, const float *attribute);
/* COLOR_0, linear; white where there is none. */
void shading_hit_color(const shading_hit *h, float out[4]);
/* 0 where the primitive has no such set. */
shading_texcoord shading_hit_texcoord(const shading_hit *h, uint32_t set);

#endif
