/* rays.c - camera rays per second: facet's blocks against bare Embree on the same rays, one thread each.
 *
 *     rays [MODEL.glb] [SIZE]     default: a wavy sphere of 15 360 triangles, 1024 x 1024 pixels, 4 samples
 *
 * Bare Embree is the time inside rtcIntersect16 only (or 8, 4 by the machine's width), with packets
 * prepared beforehand; facet's time includes generating the rays and storing the hits. Prints the medians
 * of RUNS runs that alternate. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/clock.h"
#include "base/memory.h"
#include "cpu/embree_scene.h"
#include "cpu/visibility.h"
#include "median.h"
#include "ray_setup.h"

enum { RUNS = 15, SAMPLES = 4, COLUMNS = 160, ROWS = 48, CHUNK = 64 };

typedef struct setup {
    ray_setup scene;
    ray_scene rays;
    visibility_pattern pattern;
} setup;

static void die(const facet_error *error)
{
    fprintf(stderr, "rays: %s\n", error->message);
    exit(1);
}

/* ---- facet ---- */

static double time_facet(const setup *s, uint64_t *hit_count)
{
    visibility_hit hits[VISIBILITY_BLOCK_PIXELS * SAMPLES];
    uint64_t count = 0;
    double start = clock_seconds();
    for (uint32_t y = 0; y < s->scene.size; y += VISIBILITY_BLOCK)
        for (uint32_t x = 0; x < s->scene.size; x += VISIBILITY_BLOCK) {
            visibility_trace_block(&s->rays, &s->scene.camera, x, y, &s->pattern, hits);
            for (int i = 0; i < VISIBILITY_BLOCK_PIXELS * SAMPLES; i++)
                count += hits[i].geometry != VISIBILITY_NONE;
        }
    *hit_count = count;
    return clock_seconds() - start;
}

/* ---- bare Embree ---- */

/* The 16 rays of a 2 x 2 square of pixels. */
static void make_packet(const setup *s, uint32_t x, uint32_t y, struct RTCRayHit16 *p)
{
    memset(p, 0, sizeof *p);
    for (uint32_t i = 0; i < 16; i++) {
        float origin[3];
        float direction[3];
        camera_rays_at(&s->scene.camera, (float)(x + i / 4 % 2) + s->pattern.points[2 * (i % 4)],
                       (float)(y + i / 8) + s->pattern.points[2 * (i % 4) + 1], origin, direction);
        p->ray.org_x[i] = origin[0];
        p->ray.org_y[i] = origin[1];
        p->ray.org_z[i] = origin[2];
        p->ray.dir_x[i] = direction[0];
        p->ray.dir_y[i] = direction[1];
        p->ray.dir_z[i] = direction[2];
        p->ray.tfar[i] = INFINITY;
        p->ray.mask[i] = UINT32_MAX;
        p->hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
        p->hit.instID[0][i] = RTC_INVALID_GEOMETRY_ID;
    }
}

static double time_embree(const setup *s, uint64_t *hit_count)
{
    static struct RTCRayHit16 packets[CHUNK]; /* 80 kB: stay in the second cache */
    static const _Alignas(64) int all[16] = {-1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1};
    double seconds = 0.0;
    uint64_t count = 0;
    uint32_t squares = s->scene.size / 2;
    /* in 4 x 4 blocks, as in facet */
    uint32_t total = squares * squares;
    for (uint32_t first = 0; first < total; first += CHUNK) {
        uint32_t n = total - first < CHUNK ? total - first : CHUNK;
        for (uint32_t i = 0; i < n; i++) {
            uint32_t block = (first + i) / 4;
            uint32_t square = (first + i) % 4;
            uint32_t x = block % (s->scene.size / 4) * 4 + square % 2 * 2;
            uint32_t y = block / (s->scene.size / 4) * 4 + square / 2 * 2;
            make_packet(s, x, y, &packets[i]);
        }
        double start = clock_seconds();
        for (uint32_t i = 0; i < n; i++)
            embree_intersect16(all, ((const embree_scene *)s->rays.bvh)->scene, &packets[i]);
        seconds += clock_seconds() - start;
        for (uint32_t i = 0; i < n; i++)
            for (int lane = 0; lane < 16; lane++)
                count += packets[i].hit.geomID[lane] != RTC_INVALID_GEOMETRY_ID;
    }
    *hit_count = count;
    return seconds;
}

/* ---- */

int main(int argc, char **argv)
{
    setup s = {.scene.size = argc > 2 ? (uint32_t)strtoul(argv[2], NULL, 10) / 4 * 4 : 1024};
    facet_error error;
    facet_allocator allocator = {0};
    if (!visibility_pattern_create(&allocator, SAMPLES, &s.pattern))
        return 1;
    if ((argc > 1 && argv[1][0] ? ray_setup_load(&s.scene, argv[1], &error)
                                : ray_setup_sphere(&s.scene, COLUMNS, ROWS, 0.1, &error)) != FACET_OK)
        die(&error);
    double start = clock_seconds();
    const ray_scene_desc desc = {.ray_count = UINT64_MAX, .thread_count = 2, .isa = FACET_ISA_NATIVE};
    if (embree_find_tracer(&s.rays.tracer, &error) != FACET_OK ||
        s.rays.tracer->create(&s.scene.set, &desc, &allocator, &s.rays.bvh, &error) != FACET_OK)
        die(&error);
    double build_s = clock_seconds() - start;

    double facet_s[RUNS];
    double embree_s[RUNS];
    uint64_t facet_hits = 0;
    uint64_t embree_hits = 0;
    for (int i = 0; i < RUNS; i++) {
        facet_s[i] = time_facet(&s, &facet_hits);
        embree_s[i] = time_embree(&s, &embree_hits);
    }
    double rays = (double)s.scene.size * s.scene.size * SAMPLES;
    double ours = median(facet_s, RUNS);
    double bare = median(embree_s, RUNS);
    printf("hierarchy  %6.2f ms\n", build_s * 1e3);
    printf("embree     %6.1f M rays/s, %.1f %% hit\n", rays / bare * 1e-6,
           100.0 * (double)embree_hits / rays);
    printf("facet      %6.1f M rays/s, %.1f %% hit\n", rays / ours * 1e-6, 100.0 * (double)facet_hits / rays);
    printf("ratio      %6.2f\n", bare / ours);
    ray_scene_destroy(&s.rays);
    visibility_pattern_destroy(&s.pattern);
    return facet_hits == embree_hits ? 0 : 1;
}
