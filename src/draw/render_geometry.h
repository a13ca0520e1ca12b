/* render_geometry.h - what the preview draws: every instance of a pose, with its material. */
#ifndef DRAW_RENDER_GEOMETRY_H
#define DRAW_RENDER_GEOMETRY_H

#include <string.h>

#include "draw/camera_rays.h"
#include "scene/legacy.h"

/* How a geometry gets into the bounding volume hierarchy. instancing.h chooses; flat is the quickest for rays. */
typedef enum render_role {
    RENDER_FLAT,     /* its triangles in world space, beside all others */
    RENDER_STILL,    /* the same, apart from what an animation moves: built once for all frames */
    RENDER_INSTANCED /* an instance of a shape: its triangles before world, built once for all that share them */
} render_role;

/* One instance. Its number in the set is that in hits, its triangles are primID. */
typedef struct render_geometry {
    const scene_primitive *primitive;
    const scene_material *material;
    const legacy_material *legacy; /* what it is drawn with in place of material; NULL: material */
    /* m. Triangles: 3 per vertex, in world space, or before world where that is not NULL. Points, lines: in world
     * space, 4 per index, x y z radius, such that they are a pixel wide where they are. */
    float *vertices;
    const mat4 *world; /* RENDER_INSTANCED: of the pose. NULL: vertices are in world space */
    /* object space (of the pose), 3 per vertex; not the primitive's where it is deformed */
    const float *positions;
    const float *normals;    /* the same; NULL: none */
    const float *tangents;   /* the same, 4 per vertex, or per index where has_corner_tangents; NULL: none */
    float normal_matrix[9];  /* object to world, rows; keeps normals outward; scaled to about 1 */
    float tangent_matrix[9]; /* the same for vectors in the surface */
    float scale;             /* of lengths, object to world: cube root of the volumes' ratio */
    float bitangent_sign;    /* -1 where the instance is mirrored: what cross(N, T) does not know */
    uint32_t material_id;    /* index plus 1; 0: the default material */
    uint32_t shape;          /* RENDER_INSTANCED: of the set */
    uint8_t role;            /* render_role */
    bool has_corner_tangents;
    bool is_mirrored; /* counter-clockwise triangles show their back */
    bool is_double_sided;
    bool is_lit;
    bool is_see_through; /* a hit may be no hit: alpha mask or blend */
    bool is_far_copy;    /* RENDER_INSTANCED: others need its textures as finely; nearest_copies_choose() */
} render_geometry;

/* Triangles that instances share. */
typedef struct render_shape {
    const scene_primitive *primitive;
    const float *positions; /* as above */
    float *vertices;        /* a copy of them, as Embree wants to read them */
    uint32_t use_count;
} render_shape;

/* Blocks of vertices that belong to the set. */
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
    bool is_animated; /* an animation moves some, and it pays to build what it does not move for all frames */
} render_geometry_set;

/* The instances of pose, all RENDER_FLAT, without vertices. They point into pose. Fails with FACET_ERROR_MEMORY. */
facet_result render_geometry_create(const facet_scene *scene, const scene_pose *pose,
                                    const facet_allocator *allocator, render_geometry_set *set,
                                    facet_error *error);
/* Vertices where there are none yet, as the roles want them. Fails with FACET_ERROR_MEMORY. */
facet_result render_geometry_transform(render_geometry_set *set, const scene_pose *pose,
                                       const camera_rays *camera, const facet_allocator *allocator,
                                       uint32_t thread_count, facet_error *error);
/* Half the width of lines, the radius of points in pixels. */
float render_geometry_sprite_radius(scene_mode mode);
/* Points and lines, which have vertices, again for another camera. */
void render_geometry_place_sprites(render_geometry_set *set, const scene_pose *pose,
                                   const camera_rays *camera, uint32_t thread_count);
void render_geometry_destroy(render_geometry_set *set); /* {0} is allowed */

/* Makes set one that is drawn with the scene's legacy materials, which it has (fallback: where a primitive has no
 * material), or, where fallback is NULL, with those of glTF, which is how render_geometry_create() leaves it. Tangents
 * are those of the pose again. */
void render_geometry_choose_materials(render_geometry_set *set, const facet_scene *scene,
                                      const scene_pose *pose, const legacy_material *fallback);

/* What of a set is that of another one. */
typedef enum render_likeness {
    RENDER_OTHER,
    RENDER_SAME_STILL, /* the same primitives in the same roles; what is RENDER_STILL stands where it stood */
    RENDER_SAME        /* all triangles are where they were */
} render_likeness;
render_likeness render_geometry_compare(const render_geometry_set *set, const scene_pose *pose,
                                        const render_geometry_set *old, const scene_pose *old_pose);
/* Takes over the vertices of old that are the same; set has none yet, and has the roles. */
void render_geometry_adopt(render_geometry_set *set, render_geometry_set *old, render_likeness likeness);

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

/* ---- pose keys ---- */

/* A facet_pose_desc with its own list. {0}: of no pose. */
typedef struct pose_key {
    bool is_set;
    facet_pose_desc desc;
    uint32_t *animations; /* what desc points to */
} pose_key;

/* Whether desc asks for the pose of the key. The time is that of no animation where there is none. */
bool pose_key_matches(const pose_key *key, const facet_pose_desc *desc);
/* Makes key that of desc. False: no memory, key is as it was. */
bool pose_key_set(pose_key *key, const facet_pose_desc *desc, const facet_allocator *allocator);
void pose_key_clear(pose_key *key); /* leaves {0} */

#endif
