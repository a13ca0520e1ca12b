/* shading_hit.h - where on its triangle, line or point a ray hit; the vertex attributes, frames and texels
 * there. */
#ifndef CPU_SHADING_HIT_H
#define CPU_SHADING_HIT_H

#include "cpu/shading_scene.h"
#include "shade/lang/lang_c_load.h"
#include "shade/shade.h"

/* Corners of the triangle, weights at the hit, and their derivatives over the footprint. */
typedef struct shading_hit {
    const render_geometry *geometry;
    size_t first_index;
    size_t corner[3]; /* vertex indices */
    float weight[3];
    float dx[2], dy[2]; /* of weight[1], weight[2] over the ray's footprint */
    vec3 direction;     /* of the ray */
    vec3 position;      /* world, m */
    vec3 farthest;      /* m: the largest of each coordinate at the corners of a triangle, absolute */
} shading_hit;

/* TEXCOORD_n, and its change over the footprint along the image's x and y. */
typedef struct shading_texcoord {
    float uv[2], dx[2], dy[2];
} shading_texcoord;

shading_hit shading_hit_make(const shading_scene *scene, const shading_point *point);
/* An attribute of 3 floats per vertex. */
vec3 shading_hit_vec3(const shading_hit *h, const float *attribute);
/* COLOR_0, linear; white where there is none. */
void shading_hit_color(const shading_hit *h, float out[4]);
/* 0 where the primitive has no such set. */
shading_texcoord shading_hit_texcoord(const shading_hit *h, uint32_t set);

/* ---- normals and tangents ---- */

/* With the geometry's tangents, which exist. */
ShadingFrame shading_frame_of_tangents(const shading_hit *h, bool is_front);
/* With the gradients of TEXCOORD_set on the triangle as tangents; none where it is constant. */
ShadingFrame shading_frame_of_texcoord(const shading_hit *h, bool is_front, uint32_t set);
/* The interpolated normal, not unit; the geometry has normals. */
static inline vec3 shading_frame_normal(const shading_hit *h, bool is_front)
{
    const float *m = h->geometry->normal_matrix;
    vec3 n = shading_hit_vec3(h, h->geometry->normals);
    return vec3(dot(load3(m), n), dot(load3(m + 3), n), dot(load3(m + 6), n)) * (is_front ? 1.0f : -1.0f);
}

/* ---- textures ---- */

/* RGBA by scene_texture_slot, white where there is no texture. */
typedef float material_texels[SCENE_TEXTURE_SLOT_COUNT][4];

/* Texture coordinates at a hit. */
shading_texcoord material_texture_coordinates(const shading_hit *h, const scene_texture_ref *ref);
/* The frame of vectors in a texture, from that of its untransformed coordinates. */
ShadingFrame material_texture_frame(ShadingFrame f, const scene_texture_ref *ref);
/* Reads the textures whose bits are set in wanted, all of which the hit's material has; the
 * others of the first slot_count are white. */
void material_texels_read(const shading_scene *scene, const shading_hit *h, uint32_t wanted, int slot_count,
                          material_texels texels);
/* Reads one texture `step` footprints along their x (axis 0) or y (axis 1) away from the hit. */
void material_texel_beside(const shading_scene *scene, const shading_hit *h, scene_texture_slot slot,
                           int axis, float step, float texel[4]);

#endif
