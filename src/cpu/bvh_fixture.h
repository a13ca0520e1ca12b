/* bvh_fixture.h - generated geometry with both kinds of BVH, for tests of facet's own. */
#ifndef CPU_BVH_FIXTURE_H
#define CPU_BVH_FIXTURE_H

#include "cpu/ray_scene.h"

enum bvh_fixture_kind {
    BVH_SPHERE,    /* closed, its corners rounded anywhere */
    BVH_SOUP,      /* triangles of all sizes */
    BVH_SLIVERS,   /* a thousand times longer than wide */
    BVH_SPRITES,   /* lines and points between triangles */
    BVH_INSTANCES, /* turned, mirrored, stretched */
    BVH_FIXTURES
};

typedef struct bvh_fixture {
    facet_allocator allocator;
    scene_primitive primitives[3];
    scene_material material;
    render_geometry_set set;
    mat4 *worlds;
    void *blocks[12];
    int block_count;
    ray_scene own, embree; /* embree: where there is one */
} bvh_fixture;

const char *bvh_fixture_name(int kind);
void bvh_fixture_create(bvh_fixture *f, int kind, uint32_t thread_count);
void bvh_fixture_destroy(bvh_fixture *f);

#endif
