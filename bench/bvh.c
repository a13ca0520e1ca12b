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
#include "median.h"
#include "ray_setup.h"

enum { MAX_RUNS = 99, SIZE = 512, RAYS = SIZE * SIZE };

typedef struct setup {
    ray_setup scene;
    ray_segment *rays[2]; /* of the camera, of bounces */
    size_t counts[2];
    int runs;
} setup;

static void die(const char *message)
{
    fprintf(stderr, "bvh: %s\n", message);
    exit(1);
}

static void *allocate(size_t count, size_t size)
{
    void *block = mem_zalloc(NULL, count, size);
    if (!block)
        die("out of memory");
    return block;
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
            *ray = (ray_segment){.near_t = s->scene.camera.near_m, .far_t = s->scene.camera.far_m};
            camera_rays_at(&s->scene.camera, (float)x + 0.5f, (float)y + 0.5f, ray->origin, ray->direction);
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
    if (tracer->create(&s->scene.set, &desc, &allocator, &out->bvh, &error) != FACET_OK)
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
    const double triangles = (double)count_triangles(&s->scene.set);
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
    setup s = {.scene.size = SIZE, .runs = 5};
    facet_error error;
    int first = 1;
    if (argc > 2 && strcmp(argv[1], "-n") == 0) {
        s.runs = atoi(argv[2]);
        first = 3;
    }
    if (s.runs < 1 || s.runs > MAX_RUNS)
        die("-n: 1 to 99");
    for (int i = first; i < argc; i++) {
        if (ray_setup_load(&s.scene, argv[i], &error) != FACET_OK)
            die(error.message);
        measure(&s, argv[i]);
    }
    for (uint32_t i = 0; i < 2 && first == argc; i++) {
        if (ray_setup_sphere(&s.scene, i ? 1280 : 240, i ? 768 : 128, 0.2, &error) != FACET_OK)
            die(error.message);
        measure(&s, "wavy sphere");
    }
    return 0;
}
