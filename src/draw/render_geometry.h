/* render_geometry.h - what the preview draws: every instance of a pose, with its material. */
#ifndef DRAW_RENDER_GEOMETRY_H
#define DRAW_RENDER_GEOMETRY_H

#include <string.h>

#include "draw/camera_rays.h"
#include "scene/legacy.h"

/* How a geometry enters the bounding volume hierarchy. instancing.h chooses; flat is fastest to trace. */
typedef enum render_role {
    RENDER_FLAT,  /* its triangles in world space, together with all others */
    RENDER_STILL, /* the same, without what an animation moves: built once for all frames */
    RENDER_INSTANCED /* an instance of a shape: its triangles in object space, built once for all that share them */
} render_role;

/* One instance. Its index in the set is that of hits, its triangles are primID. */
typedef struct render_geometry {
    const scene_primitive *primitive;
    const scene_material *material;
    const legacy_material *legacy; /* drawn instead of material; NULL: material */
    /* m. Triangles: 3 per vertex, in world space, or in object space where world is not NULL. Points,
     * lines: in world space, 4 per index, x y z radius, such that they are a pixel wide at their depth. */
    float *vertices;
    const mat4 *world; /* RENDER_INSTANCED: of the pose. NULL: vertices are in world space */
    /* object space (of the pose), 3 per vertex; not the primitive's where it is deformed */
    const float *positions;
    const float *normals;    /* the same; NULL: none */
    const float *tangents;   /* the same, 4 per vertex, or per index where has_corner_tangents; NULL: none */
    float normal_matrix[9];  /* object to world, rows; keeps normals outward; scaled to about 1 */
    float tangent_matrix[9]; /* the same for vectors in the surface */
    float scale;             /* of lengths, object to world: cube root of the determinant */
    float bitangent_sign;    /* -1 where the instance is mirrored, which cross(N, T) does not include */
    uint32_t material_id;    /* index plus 1; 0: the default material */
    uint32_t shape;          /* RENDER_INSTANCED: of the set */
    uint8_t role;            /* render_role */
    bool has_corner_tangents;
    bool is_mirrored; /* counter-clockwise triangles show their back */
    bool is_double_sided;
    bool is_lit;
    bool is_see_through; /* a hit may be transparent: alpha mask or blend */
    /* RENDER_INSTANCED: other instances need its textures at the same resolution; nearest_copies_choose() */
    bool is_far_copy;
} render_geometry;

/* Triangles that instances share. */
typedef struct render_shape {
    const scene_primitive *primitive;
    const float *positions; /* as above */
    float *vertices;        /* a copy of them, with Embree's padding */
    uint32_t use_count;
} render_shape;

/* Blocks of vertices that the set owns. */
typedef struct render_blocks {
    void **items;
    uint32_t count;
} render_blocks;

typedef struct render_geometry_set {
    uint32_t count, shape_count;
    render_geometry *items;
    render_shape *shapes;
    render_blocks blocks, still_blocks; /* still: of RENDER_STILL */
    bool has_sprites;                   /* points or lines */
    bool is_animated; /* an animation moves some, and building the rest once for all frames is worthwhile */
} render_geometry_set;

/* The instances of pose, all RENDER_FLAT, without vertices. They point into pose. Fails with
 * FACET_ERROR_MEMORY. */
facet_result render_geometry_create(const facet_scene *scene, const scene_pose *pose,
                                    const facet_allocator *allocator, render_geometry_set *set,
                                    facet_error *error);
/* Creates missing vertices, as the roles need them. Fails with FACET_ERROR_MEMORY. */
facet_result render_geometry_transform(render_geometry_set *set, const scene_pose *pose,
                                       const camera_rays *camera, const facet_allocator *allocator,
                                       uint32_t thread_count, facet_error *error);
/* Half the width of lines, the radius of points in pixels. */
float render_geometry_sprite_radius(scene_mode mode);
/* Moves the vertices of points and lines, which must exist, for another camera. */
void render_geometry_place_sprites(render_geometry_set *set, const scene_pose *pose,
                                   const camera_rays *camera, uint32_t thread_count);
void render_geometry_destroy(render_geometry_set *set); /* {0} is allowed */

/* Makes the set draw with the scene's legacy materials, which it must have (fallback: where a primitive
 * has no material), or, where fallback is NULL, with those of glTF, as after render_geometry_create().
 * Tangents are those of the pose again. */
void render_geometry_choose_materials(render_geometry_set *set, const facet_scene *scene,
                                      const scene_pose *pose, const legacy_material *fallback);

/* How much two sets have in common. */
typedef enum render_likeness {
    RENDER_OTHER,
    /* the same primitives in the same roles; RENDER_STILL geometries are at the same place */
    RENDER_SAME_STILL,
    RENDER_SAME /* all triangles are at the same place */
} render_likeness;
render_likeness render_geometry_compare(const render_geometry_set *set, const scene_pose *pose,
                                        const render_geometry_set *old, const scene_pose *old_pose);
/* Takes over the vertices of old that are the same; set must have roles, and no vertices. */
void render_geometry_adopt(render_geometry_set *set, render_geometry_set *old, render_likeness likeness);

/* The vertex indices of a triangle. */
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

/* ---- pose keys ---- */

/* A facet_pose_desc that owns its list, of a scene with its parts in their places. {0}: of no pose. */
typedef struct pose_key {
    bool is_set;
    uint64_t place_revision; /* of the scene */
    facet_pose_desc desc;
    uint32_t *animations; /* storage of desc's pointer */
} pose_key;

/* Whether desc has the pose of the key, of the same scene. The time is ignored where no animation runs. */
bool pose_key_matches(const pose_key *key, const facet_scene *scene, const facet_pose_desc *desc);
/* Makes key that of desc. False: out of memory, key is unchanged. */
bool pose_key_set(pose_key *key, const facet_scene *scene, const facet_pose_desc *desc,
                  const facet_allocator *allocator);
void pose_key_clear(pose_key *key); /* leaves {0} */

#endif
