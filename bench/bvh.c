/* bvh.c - facet's own BVH beside Embree's: time to build, and single rays per second of one thread.
 *
 *     bvh [-n RUNS] [MODEL.glb] ...     default: 5 runs, a wavy sphere of 61 440 and one of 1 966 080 triangles
 *
 * Seconds are CPU time, so that a busy machine matters little; medians of RUNS runs that alternate. "build" is ns of one
 * thread for a triangle. Rays: those of a camera in rows; bounces from what they hit, cosine-distributed; the same rays
 * as shadow rays, which any hit ends. "ratio" is own over Embree: 1 is as fast. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "cpu/visibility.h"
#include "io/gltf/gltf.h"
#include "median.h"

enum { MAX_RUNS = 99, SIZE = 512, RAYS = SIZE * SIZE };

typedef struct setup {
    scene_primitive sphere;
    render_geometry geometry;
    scene_material material;
    facet_scene *scene;
    scene_pose pose;
    render_geometry_set set;
    camera_rays camera;
    ray_segment *rays[2]; /* of the camera, of bounces */
    size_t counts[2];
    int runs;
} setup;

static void die(const char *message)
{
    fprintf(stderr, "bvh: %s\n", message);
    exit(1);
}

/* ---- scenes ---- */

static void *allocate(size_t count, size_t size)
{
    void *block = mem_zalloc(NULL, count, size);
    if (!block)
        die("out of memory");
    return block;
}

static void make_sphere(setup *s, uint32_t columns, uint32_t rows)
{
    float *positions = allocate(((size_t)columns + 1) * (rows + 1) + 1, 3 * sizeof(float));
    uint32_t *indices = allocate((size_t)columns * rows, 6 * sizeof(uint32_t));
    uint32_t count = 0;
    for (uint32_t row = 0; row <= rows; row++)
        for (uint32_t column = 0; column <= columns; column++) {
            const double theta = 3.14159265358979 * row / rows;
            const double phi = 2.0 * 3.14159265358979 * column / columns;
            const double radius = 1.0 + 0.2 * sin(9.0 * phi) * sin(7.0 * theta);
            const uint32_t i = row * (columns + 1) + column;
            positions[3 * i] = (float)(radius * sin(theta) * sin(phi));
            positions[3 * i + 1] = (float)(radius * cos(theta));
            positions[3 * i + 2] = (float)(radius * sin(theta) * cos(phi));
            if (row == rows || column == columns)
                continue;
            const uint32_t corners[6] = {i, i + columns + 1, i + 1, i + 1, i + columns + 1, i + columns + 2};
            memcpy(indices + count, corners, sizeof corners);
            count += 6;
        }
    s->sphere = (scene_primitive){.mode = SCENE_TRIANGLES,
                                  .vertex_count = (columns + 1) * (rows + 1),
                                  .index_count = count,
                                  .indices = indices,
                                  .positions = positions};
    s->material = scene_material_default();
    s->geometry = (render_geometry){.primitive = &s->sphere, .material = &s->material, .vertices = positions};
    s->set = (render_geometry_set){.count = 1, .items = &s->geometry};
}

static void look_at(setup *s, const float minimum[3], const float maximum[3])
{
    facet_error error;
    facet_camera camera = {.fov_y_rad = 0.5236f};
    float radius = 0.0f;
    for (int i = 0; i < 3; i++) {
        camera.target[i] = 0.5f * (minimum[i] + maximum[i]);
        radius = fmaxf(radius, 0.5f * (maximum[i] - minimum[i]));
    }
    const float offset[3] = {2.0f, 1.5f, 4.0f};
    for (int i = 0; i < 3; i++)
        camera.eye[i] = camera.target[i] + offset[i] * radius;
    if (camera_rays_create(&camera, SIZE, SIZE, &s->camera, &error) != FACET_OK)
        die(error.message);
}

static void load_model(setup *s, const char *path)
{
    facet_error error;
    const facet_allocator allocator = {0};
    if (gltf_load(path, &(facet_scene_desc){0}, &s->scene, &error) != FACET_OK ||
        scene_pose_create(s->scene, NULL, &allocator, 1, &s->pose, &error) != FACET_OK)
        die(error.message);
    look_at(s, s->pose.bounds_min, s->pose.bounds_max);
    if (render_geometry_create(s->scene, &s->pose, &allocator, &s->set, &error) != FACET_OK ||
        render_geometry_transform(&s->set, &s->pose, &s->camera, &allocator, 1, &error) != FACET_OK)
        die(error.message);
}

static uint64_t count_triangles(const render_geometry_set *set)
{
    uint64_t count = 0;
    for (uint32_t i = 0; i < set->count; i++)
        if (set->items[i].primitive->mode == SCENE_TRIANGLES)
            count += set->items[i].primitive->index_count / 3;
    return count;
}

/* ---- rays ---- */

static float uniform(uint32_t *state)
{
    *state = *state * 1664525u + 1013904223u;
    return (float)(*state >> 8) * (1.0f / 16777216.0f);
}

/* From the hit, about its normal on the ray's side: cosine-distributed. */
static ray_segment bounce(const ray_segment *ray, const visibility_hit *hit, uint32_t *state)
{
    ray_segment out = {.far_t = INFINITY};
    float towards = 0.0f, length2 = 0.0f;
    for (int i = 0; i < 3; i++) {
        towards += hit->normal[i] * ray->direction[i];
        length2 += hit->normal[i] * hit->normal[i];
    }
    const float scale = (towards > 0.0f ? -1.0f : 1.0f) / sqrtf(length2);
    const float z = 2.0f * uniform(state) - 1.0f;
    const float phi = 6.2831853f * uniform(state);
    const float r = sqrtf(1.0f - z * z);
    const float ball[3] = {r * cosf(phi), r * sinf(phi), z};
    for (int i = 0; i < 3; i++) {
        out.direction[i] = hit->normal[i] * scale * 1.0001f + ball[i];
        out.origin[i] = ray->origin[i] + hit->t * ray->direction[i] + 1e-5f * hit->normal[i] * scale;
    }
    return out;
}

static void make_rays(setup *s, const ray_scene *rays)
{
    uint32_t state = 1;
    for (int i = 0; i < 2; i++) {
        s->rays[i] = allocate(RAYS, sizeof **s->rays);
        s->counts[i] = 0;
    }
    for (uint32_t y = 0; y < SIZE; y++)
        for (uint32_t x = 0; x < SIZE; x++) {
            ray_segment *ray = &s->rays[0][s->counts[0]++];
            visibility_hit hit;
            *ray = (ray_segment){.near_t = s->camera.near_m, .far_t = s->camera.far_m};
            camera_rays_at(&s->camera, (float)x + 0.5f, (float)y + 0.5f, ray->origin, ray->direction);
            if (rays->tracer->nearest(rays->bvh, ray, &hit))
                s->rays[1][s->counts[1]++] = bounce(ray, &hit, &state);
        }
}

static double trace(const setup *s, const ray_scene *rays, int kind, uint64_t *hits)
{
    const ray_segment *list = s->rays[kind > 0];
    const size_t count = s->counts[kind > 0];
    visibility_hit hit;
    *hits = 0;
    const double start = cpu_seconds();
    for (size_t i = 0; i < count; i++)
        *hits += kind == 2 ? rays->tracer->occluded(rays->bvh, &list[i])
                           : rays->tracer->nearest(rays->bvh, &list[i], &hit);
    return cpu_seconds() - start;
}

/* ---- */

static double build(const setup *s, const ray_tracer *tracer, ray_scene *out)
{
    facet_error error;
    const facet_allocator allocator = {0};
    const ray_scene_desc desc = {.ray_count = UINT64_MAX, .thread_count = 1};
    ray_scene_destroy(out);
    out->tracer = tracer;
    const double start = cpu_seconds();
    if (tracer->create(&s->set, &desc, &allocator, &out->bvh, &error) != FACET_OK)
        die(error.message);
    return cpu_seconds() - start;
}

static void measure(setup *s, const char *name)
{
    static const char *const kinds[] = {"camera", "bounce", "shadow"};
    facet_error error;
    const ray_tracer *tracers[2] = {NULL, &bvh_tracer};
    if (embree_find_tracer(&tracers[0], &error) != FACET_OK)
        die(error.message);
    ray_scene scenes[2] = {{0}};
    double seconds[2][MAX_RUNS];
    const double triangles = (double)count_triangles(&s->set);
    double medians[2];
    for (int run = 0; run < s->runs; run++)
        for (int i = 0; i < 2; i++)
            seconds[i][run] = build(s, tracers[i], &scenes[i]);
    for (int i = 0; i < 2; i++)
        medians[i] = median(seconds[i], s->runs);
    printf("%s: %.0f triangles\n    build   Embree %7.1f ns   own %7.1f ns   ratio %.2f\n", name, triangles,
           medians[0] / triangles * 1e9, medians[1] / triangles * 1e9, medians[0] / medians[1]);
    make_rays(s, &scenes[0]);
    for (int kind = 0; kind < 3; kind++) {
        uint64_t hits[2];
        for (int run = 0; run < s->runs; run++)
            for (int i = 0; i < 2; i++)
                seconds[i][run] = trace(s, &scenes[i], kind, &hits[i]);
        for (int i = 0; i < 2; i++)
            medians[i] = median(seconds[i], s->runs);
        const double count = (double)s->counts[kind > 0] * 1e-6;
        printf("    %s  Embree %7.2f M/s  own %7.2f M/s  ratio %.2f   hits %llu, %llu\n", kinds[kind],
               count / medians[0], count / medians[1], medians[0] / medians[1], (unsigned long long)hits[0],
               (unsigned long long)hits[1]);
    }
    for (int i = 0; i < 2; i++) {
        ray_scene_destroy(&scenes[i]);
        mem_free(s->rays[i]);
    }
}

int main(int argc, char **argv)
{
    setup s = {.runs = 5};
    int first = 1;
    if (argc > 2 && strcmp(argv[1], "-n") == 0) {
        s.runs = atoi(argv[2]);
        first = 3;
    }
    if (s.runs < 1 || s.runs > MAX_RUNS)
        die("-n: 1 to 99");
    for (int i = first; i < argc; i++) {
        load_model(&s, argv[i]);
        measure(&s, argv[i]);
    }
    for (uint32_t i = 0; i < 2 && first == argc; i++) {
        const uint32_t columns = i ? 1280 : 240;
        make_sphere(&s, columns, i ? 768 : 128);
        look_at(&s, (float[3]){-1, -1, -1}, (float[3]){1, 1, 1});
        measure(&s, "wavy sphere");
    }
    return 0;
}
