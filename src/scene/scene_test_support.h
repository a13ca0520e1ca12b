/* scene_test_support.h - scenes of a few arrays, and comparisons. */
#ifndef SCENE_SCENE_TEST_SUPPORT_H
#define SCENE_SCENE_TEST_SUPPORT_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "tests/support/support.h"
#include "scene/scene.h"

/* count nodes that are roots of the one scene, each with a mesh of one primitive, which is empty. */
static inline facet_scene *test_scene(uint32_t count)
{
    facet_scene *scene = NULL;
    assert_int_equal(scene_create(NULL, "test", &scene, NULL), FACET_OK);
    uint32_t *roots = arena_zalloc(scene->arena, count, sizeof *roots);
    scene->nodes = arena_zalloc(scene->arena, count, sizeof *scene->nodes);
    scene->meshes = arena_zalloc(scene->arena, count, sizeof *scene->meshes);
    scene->scenes = arena_zalloc(scene->arena, 1, sizeof *scene->scenes);
    scene_primitive *primitives = arena_zalloc(scene->arena, count, sizeof *primitives);
    assert_true(roots && scene->nodes && scene->meshes && scene->scenes && primitives);
    for (uint32_t i = 0; i < count; i++) {
        roots[i] = i;
        scene->meshes[i] = (scene_mesh){.name = "", .primitive_count = 1, .primitives = &primitives[i]};
        scene->nodes[i] = scene_node_default("");
        scene->nodes[i].mesh = i;
    }
    scene->scenes[0] = (scene_root){.name = "", .node_count = count, .nodes = roots};
    scene->node_count = scene->mesh_count = count;
    scene->scene_count = 1;
    scene->default_scene = 0;
    return scene;
}

#endif
