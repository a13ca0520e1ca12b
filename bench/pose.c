/* pose.c - time of posing a scene: skinned and morphed vertices per second, many nodes, many instances.
 * Generated scenes: 100,000 vertices with normals and tangents, 64 joints, 4 influences, 8 targets.
 *     build/release/bench/pose [THREADS] */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/clock.h"
#include "median.h"
#include "scene/scene.h"

enum { VERTICES = 100000, JOINTS = 64, TARGETS = 8, RUNS = 31, NODES = 100000, COPIES = 100000 };

static float noise(void)
{
    static uint32_t state = 1;
    state = state * 1664525u + 1013904223u;
    return (float)(state >> 8) * 0x1p-23f - 1.0f;
}

static void *need(void *memory)
{
    if (!memory)
        exit(1);
    return memory;
}

static float *noise_array(arena *a, size_t count, float scale)
{
    float *out = need(arena_alloc(a, count, sizeof *out));
    for (size_t i = 0; i < count; i++)
        out[i] = scale * noise();
    return out;
}

static void fill_primitive(facet_scene *scene, scene_primitive *p, uint32_t count)
{
    uint32_t *indices = need(arena_alloc(scene->arena, count, sizeof *indices));
    for (uint32_t i = 0; i < count; i++)
        indices[i] = i;
    *p = (scene_primitive){.mode = SCENE_TRIANGLES,
                           .vertex_count = count,
                           .index_count = count,
                           .indices = indices,
                           .positions = noise_array(scene->arena, 3 * (size_t)count, 1.0f),
                           .normals = noise_array(scene->arena, 3 * (size_t)count, 0.6f),
                           .tangents = noise_array(scene->arena, 4 * (size_t)count, 0.6f),
                           .material = SCENE_NONE,
                           .bounds_min = {-1, -1, -1},
                           .bounds_max = {1, 1, 1}};
}

/* node_count rotated roots sharing one mesh of vertex_count vertices. */
static facet_scene *make_scene(uint32_t node_count, uint32_t vertex_count)
{
    facet_scene *scene = NULL;
    if (scene_create(NULL, "bench", &scene, NULL) != FACET_OK)
        exit(1);
    scene->nodes = need(arena_zalloc(scene->arena, node_count, sizeof *scene->nodes));
    scene->meshes = need(arena_zalloc(scene->arena, 1, sizeof *scene->meshes));
    scene->meshes[0].primitives = need(arena_zalloc(scene->arena, 1, sizeof(scene_primitive)));
    scene->meshes[0].primitive_count = scene->mesh_count = 1;
    scene->node_count = node_count;
    for (uint32_t i = 0; i < node_count; i++)
        scene->nodes[i] =
            (scene_node){.name = "",
                         .parent = SCENE_NONE,
                         .translation = {9 * (double)noise(), 9 * (double)noise(), 9 * (double)noise()},
                         .rotation = {0.48f, 0.6f, 0.64f, 0},
                         .scale = {1, 1, 1},
                         .mesh = 0,
                         .camera = SCENE_NONE,
                         .light = SCENE_NONE,
                         .skin = SCENE_NONE};
    fill_primitive(scene, &scene->meshes[0].primitives[0], vertex_count);
    return scene;
}

/* Node 0 keeps the mesh, the others become joints of a chain. */
static void add_skin(facet_scene *scene)
{
    scene_primitive *p = &scene->meshes[0].primitives[0];
    uint32_t *joints = need(arena_alloc(scene->arena, JOINTS, sizeof *joints));
    uint16_t *numbers = need(arena_alloc(scene->arena, p->vertex_count, 4 * sizeof *numbers));
    float *weights = need(arena_alloc(scene->arena, p->vertex_count, 4 * sizeof *weights));
    for (uint32_t i = 0; i < JOINTS; i++) {
        joints[i] = i + 1;
        scene->nodes[i + 1].mesh = SCENE_NONE;
    }
    for (size_t i = 0; i < 4 * (size_t)p->vertex_count; i++) {
        numbers[i] = (uint16_t)(i * 7 % JOINTS);
        weights[i] = 0.25f;
    }
    scene->skins = need(arena_zalloc(scene->arena, 1, sizeof *scene->skins));
    scene->skins[0] = (scene_skin){.name = "", .joint_count = JOINTS, .joints = joints};
    scene->skin_count = 1;
    scene->nodes[0].skin = 0;
    p->influence_count = 4;
    p->joints = numbers;
    p->weights = weights;
}

static void add_targets(facet_scene *scene)
{
    scene_primitive *p = &scene->meshes[0].primitives[0];
    size_t floats = 3 * (size_t)p->vertex_count;
    scene_morph_target *targets = need(arena_zalloc(scene->arena, TARGETS, sizeof *targets));
    for (int i = 0; i < TARGETS; i++)
        targets[i] = (scene_morph_target){.positions = noise_array(scene->arena, floats, 0.1f),
                                          .normals = noise_array(scene->arena, floats, 0.1f),
                                          .tangents = noise_array(scene->arena, floats, 0.1f)};
    p->targets = targets;
    p->target_count = scene->meshes[0].weight_count = TARGETS;
    scene->meshes[0].weights = noise_array(scene->arena, TARGETS, 1.0f);
}

/* Median seconds of a pose; prints it with the rate of count items per second. */
static void measure(const char *name, facet_scene *scene, uint32_t thread_count, double count,
                    const char *what)
{
    double seconds[RUNS];
    for (int i = 0; i < RUNS; i++) {
        scene_pose pose;
        double start = clock_seconds();
        if (scene_pose_create(scene, NULL, NULL, thread_count, &pose, NULL) != FACET_OK)
            exit(1);
        seconds[i] = clock_seconds() - start;
        scene_pose_destroy(&pose);
    }
    double typical = median(seconds, RUNS);
    printf("%-28s %8.3f ms %8.1f million %s/s\n", name, 1e3 * typical, 1e-6 * count / typical, what);
    scene_destroy(scene);
}

int main(int argc, char **argv)
{
    uint32_t threads = argc > 1 ? (uint32_t)strtoul(argv[1], NULL, 10) : facet_thread_count();
    printf("%u threads, median of %d\n", threads, RUNS);
    facet_scene *scene = make_scene(1 + JOINTS, VERTICES);
    add_skin(scene);
    measure("skin, 4 influences", scene, threads, VERTICES, "vertices");
    scene = make_scene(1, VERTICES);
    add_targets(scene);
    measure("8 morph targets", scene, threads, VERTICES, "vertices");
    scene = make_scene(1 + JOINTS, VERTICES);
    add_skin(scene);
    add_targets(scene);
    measure("both", scene, threads, VERTICES, "vertices");
    measure("still, one turned mesh", make_scene(1, VERTICES), threads, VERTICES, "vertices");
    measure("still, 100,000 nodes", make_scene(NODES, 3000), threads, NODES, "nodes");

    scene = make_scene(1, 3000);
    scene_instancing instancing = {.count = COPIES,
                                   .translations = noise_array(scene->arena, 3 * (size_t)COPIES, 9.0f)};
    scene->nodes[0].instancing = &instancing;
    measure("100,000 copies of a mesh", scene, threads, COPIES, "copies");
    return 0;
}
