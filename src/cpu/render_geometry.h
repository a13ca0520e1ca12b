/* render_geometry.h - what the preview draws: every instance of a pose in world space, with its material. */
#ifndef CPU_RENDER_GEOMETRY_H
#define CPU_RENDER_GEOMETRY_H

#include <string.h>

#include "cpu/camera_rays.h"
#include "scene/scene.h"

/* One instance. Its number in the set is Embree's geomID, its triangles are primID. */
typedef struct render_geometry {
    const scene_primitive *primitive;
    const scene_material *material;
    uint32_t material_id; /* index plus 1; 0: the default material */
    /* m. Triangles: 3 per vertex, in world space, or before world where that is not NULL. Points, lines: in world
     * space, 4 per index, x y z radius, such that they are a pixel wide where they are. */
    const float *vertices;
    const mat4 *world;    /* NULL: vertices are in world space; render_geometry_corner() knows */
    const float *normals; /* object space (of the pose), 3 per vertex; NULL: none */
    const float
        *tangents; /* object space, 4 per vertex, or per index where has_corner_tangents; NULL: none */
    bool has_corner_tangents;
    float normal_matrix[9];  /* object to world, rows; keeps normals outward; scaled to about 1 */
    float tangent_matrix[9]; /* the same for vectors in the surface */
    float bitangent_sign;    /* -1 where the instance is mirrored: what cross(N, T) does not know */
    bool is_mirrored;        /* counter-clockwise triangles show their back */
    bool is_double_sided;
    bool is_lit;
    bool is_see_through; /* a hit may be no hit: alpha mask or blend */
} render_geometry;

typedef struct render_geometry_set {
    uint32_t count;
    render_geometry *items;
    void **vertex_blocks, **tangent_blocks; /* what the items own */
    uint32_t vertex_block_count, tangent_block_count;
} render_geometry_set;

/* The instances of pose, without vertices that have to be made: those come with render_geometry_transform() and
 * render_geometry_make_tangents(), which touch different members and may run at the same time. Fails with
 * FACET_ERROR_MEMORY, as they do. */
facet_result render_geometry_create(const facet_scene *scene, const scene_pose *pose,
                                    const facet_allocator *allocator, render_geometry_set *set,
                                    facet_error *error);
/* Vertices in world space. */
facet_result render_geometry_transform(render_geometry_set *set, const scene_pose *pose,
                                       const camera_rays *camera, const facet_allocator *allocator,
                                       uint32_t thread_count, facet_error *error);
/* Tangents where the material has a normal texture and the primitive has none, once for each primitive. */
facet_result render_geometry_make_tangents(render_geometry_set *set, const facet_allocator *allocator,
                                           uint32_t thread_count, facet_error *error);
void render_geometry_destroy(render_geometry_set *set); /* {0} is allowed */

/* The vertices' numbers of a triangle. */
static inline const uint32_t *render_geometry_triangle(const render_geometry *g, uint32_t triangle)
{
    return g->primitive->indices + 3 * (size_t)triangle;
}
/* A vertex of triangles in world space, m. */
static inline void render_geometry_corner(const render_geometry *g, size_t vertex, float out[3])
{
    const float *p = g->vertices + 3 * vertex;
    if (g->world)
        mat4_transform_point(g->world, p, out);
    else
        memcpy(out, p, 3 * sizeof *out);
}

#endif
