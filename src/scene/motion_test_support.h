/* motion_test_support.h - for tests: node trees, animations and primitives that move, by hand. */
#ifndef SCENE_MOTION_TEST_SUPPORT_H
#define SCENE_MOTION_TEST_SUPPORT_H

#include <string.h>

#include "scene/scene_test_support.h"
#include "tests/support/support.h"

/* [-1, 1), after a fixed recipe. */
static inline float test_random(uint32_t *state)
{
    lcg_next(state);
    return (float)(*state >> 8) / 8388608.0f - 1.0f;
}

/* A unit quaternion. */
static inline void test_random_rotation(uint32_t *state, float out[4])
{
    double length = 0.0;
    for (int i = 0; i < 4; i++) {
        out[i] = test_random(state);
        length += (double)out[i] * (double)out[i];
    }
    for (int i = 0; i < 4; i++)
        out[i] = (float)((double)out[i] / sqrt(length));
}

/* Parents of all nodes (SCENE_NONE: a root of scene 0); meshes come off. */
static inline void test_tree(facet_scene *scene, const uint32_t *parents)
{
    uint32_t count = scene->node_count;
    uint32_t *lists = arena_zalloc(scene->arena, 2 * (size_t)count, sizeof *lists);
    assert_non_null(lists);
    uint32_t *roots = lists + count;
    uint32_t root_count = 0;
    for (uint32_t i = 0; i < count; i++) {
        scene->nodes[i].parent = parents[i];
        scene->nodes[i].mesh = SCENE_NONE;
        scene->nodes[i].children = lists;
        scene->nodes[i].child_count = 0;
        if (parents[i] == SCENE_NONE)
            roots[root_count++] = i;
        for (uint32_t k = 0; k < count; k++)
            if (parents[k] == i)
                lists[scene->nodes[i].child_count++] = k;
        lists += scene->nodes[i].child_count;
    }
    scene->scenes[0].nodes = roots;
    scene->scenes[0].node_count = root_count;
}

/* One channel with its keys, to be copied into an animation. */
typedef struct test_channel {
    scene_channel channel; /* scale 0: 1 */
    scene_sampler sampler;
} test_channel;

/* Appends an animation of these channels. */
static inline void test_animation(facet_scene *scene, const test_channel *channels, uint32_t count)
{
    enum { MAX = 8 };
    if (!scene->animations)
        scene->animations = arena_zalloc(scene->arena, MAX, sizeof *scene->animations);
    scene_channel *c = arena_zalloc(scene->arena, count, sizeof *c);
    scene_sampler *s = arena_zalloc(scene->arena, count, sizeof *s);
    assert_true(scene->animations && c && s && scene->animation_count < MAX);
    scene_animation *animation = &scene->animations[scene->animation_count++];
    *animation = (scene_animation){.name = "",
                                   .channel_count = count,
                                   .sampler_count = count,
                                   .channels = c,
                                   .samplers = s,
                                   .begin_s = 1e30f,
                                   .end_s = -1e30f};
    for (uint32_t i = 0; i < count; i++) {
        c[i] = channels[i].channel;
        s[i] = channels[i].sampler;
        c[i].sampler = i;
        c[i].scale = c[i].scale == 0.0f ? 1.0f : c[i].scale;
        animation->begin_s = fminf(animation->begin_s, s[i].times[0]);
        animation->end_s = fmaxf(animation->end_s, s[i].times[s[i].key_count - 1]);
    }
}

/* count vertices with normals and tangents in [-1, 1]^3, triangles of three in a row. */
static inline void test_fill_primitive(facet_scene *scene, scene_primitive *p, uint32_t count)
{
    uint32_t random = 7;
    float *positions = arena_alloc(scene->arena, count, 3 * sizeof(float));
    float *normals = arena_alloc(scene->arena, count, 3 * sizeof(float));
    float *tangents = arena_alloc(scene->arena, count, 4 * sizeof(float));
    uint32_t *indices = arena_alloc(scene->arena, count, sizeof *indices);
    assert_true(positions && normals && tangents && indices);
    *p = (scene_primitive){.mode = SCENE_TRIANGLES,
                           .vertex_count = count,
                           .index_count = count,
                           .indices = indices,
                           .positions = positions,
                           .normals = normals,
                           .tangents = tangents,
                           .material = SCENE_NONE,
                           .bounds_min = {1, 1, 1},
                           .bounds_max = {-1, -1, -1}};
    for (uint32_t i = 0; i < count; i++) {
        float q[4];
        indices[i] = i;
        test_random_rotation(&random, q);
        mat4 turn = mat4_from_trs((float[3]){0, 0, 0}, q, (float[3]){1, 1, 1});
        memcpy(normals + 3 * i, turn.m + 8, 3 * sizeof(float));
        memcpy(tangents + 4 * i, turn.m, 3 * sizeof(float));
        tangents[4 * i + 3] = i % 2 ? 1.0f : -1.0f;
        for (uint32_t k = 0; k < 3; k++) {
            float x = test_random(&random);
            positions[3 * i + k] = x;
            p->bounds_min[k] = fminf(p->bounds_min[k], x);
            p->bounds_max[k] = fmaxf(p->bounds_max[k], x);
        }
    }
}

/* The pose of {0} with one animation (count 1) or all of them, at a time. */
static inline scene_pose test_pose_at(const facet_scene *scene, uint32_t count, double time_s,
                                      uint32_t thread_count)
{
    static const uint32_t all[8] = {0, 1, 2, 3, 4, 5, 6, 7};
    facet_error error = {.message = ""};
    scene_pose pose;
    facet_result result = scene_pose_create(
        scene, &(facet_pose_desc){.animation_count = count, .animations = all, .time_s = time_s}, NULL,
        thread_count, &pose, &error);
    assert_string_equal(error.message, "");
    assert_int_equal(result, FACET_OK);
    return pose;
}

#endif
