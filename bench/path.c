/* path.c - speed of the path tracer: paths, rays, vertices, on one thread and two, and its rays beside bare
 * Embree on the same stream.
 *
 *     path [-c 1] [-n RUNS] [-s SIZE] MODEL[,LIGHT.hdr] ...    5 runs, 512 x 512 pixels, 4 samples, the file's camera if any
 *
 * -c 1: seconds are CPU time over the number of threads, for a busy machine; they exclude the time that two
 * threads wait for each other.
 *
 * First line of a model: samples of path_trace() alone, without the film; medians of RUNS runs that alternate
 * between one thread and two. A vertex is a surface hit by a path. Then, by kind of ray, the rate of facet's
 * functions (src/cpu/ray_trace.h: ray setup, alpha test, hit) and of bare Embree on the same rays, M rays/s.
 * "traced" is the fraction of one thread's time spent in these rays. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/parallel.h"
#include "median.h"
#include "path/path_lights.h"
#include "path/path_scene.h"
#include "path_rays.h"

enum { MAX_RUNS = 100, SAMPLES = 4, TILE = 16, DEPTH = 64 };

/* An image ready to be sampled. */
typedef struct bench_image {
    facet_scene *scene;
    facet_environment *environment;
    facet_camera camera;
    facet_render_desc desc;
    facet_render_stats stats;
    prepared_scene prepared;
    render_setup setup;
    path_lights *lights;
    path_scene paths;
    float *sums; /* of a row of tiles: keeps the compiler from removing the work */
    uint64_t *rays;
    bool uses_cpu_time;
} bench_image;

static void check(facet_result result, const facet_error *error)
{
    if (result == FACET_OK)
        return;
    fprintf(stderr, "path: %s\n", error->message);
    exit(1);
}

static void prepare(bench_image *p, const char *model, const char *light, uint32_t size)
{
    facet_error error;
    facet_orbit orbit = facet_orbit_default();
    check(facet_scene_load(model, NULL, &p->scene, &error), &error);
    if (light)
        check(facet_environment_load(light, NULL, &p->environment, &error), &error);
    p->desc = (facet_render_desc){.thread_count = 2,
                                  .width = size,
                                  .height = size,
                                  .crop = {0, 0, size, size},
                                  .renderer = FACET_RENDERER_KIND_PATH,
                                  .samples = 64,
                                  .camera = &p->camera,
                                  .environment = p->environment,
                                  .path = {.max_depth = DEPTH}};
    if (facet_camera_from_scene(p->scene, NULL, 0, &p->camera, &error) != FACET_OK)
        check(facet_camera_from_orbit(p->scene, NULL, &orbit, 1.0f, &p->camera, &error), &error);
    prepared_scene_init(&p->prepared, p->scene, &p->desc.allocator);
    check(prepared_scene_pose(&p->prepared, &p->desc, &error), &error);
    p->setup = (render_setup){.prepared = &p->prepared,
                              .desc = &p->desc,
                              .stats = &p->stats,
                              .reads_everywhere = true,
                              .samples_light = true};
    check(render_setup_create(&p->setup, &error), &error);
    check(path_lights_create(&p->setup, &p->lights, &error), &error);
    p->paths = (path_scene){.setup = &p->setup, .lights = p->lights};
    p->sums = calloc(size / TILE, sizeof *p->sums);
    p->rays = calloc(size / TILE, sizeof *p->rays);
    if (!p->sums || !p->rays)
        exit(1);
}

static void release(bench_image *p)
{
    path_lights_destroy(p->lights);
    render_setup_destroy(&p->setup);
    prepared_scene_clear(&p->prepared);
    facet_environment_destroy(p->environment);
    facet_scene_destroy(p->scene);
    free(p->sums);
    free(p->rays);
}

/* ---- sampling ---- */

static void draw_rows(void *context, size_t begin, size_t end)
{
    bench_image *p = context;
    for (size_t row = begin; row < end; row++) {
        float sum = 0.0f;
        uint64_t rays = 0;
        for (uint32_t i = 0; i < p->desc.width * TILE * SAMPLES; i++) {
            uint32_t pixel = i / SAMPLES;
            uint32_t tile = pixel / (TILE * TILE);
            path_sample sample;
            path_trace(&p->paths, tile * TILE + pixel % TILE, (uint32_t)row * TILE + pixel / TILE % TILE,
                       i % SAMPLES, &sample);
            sum += sample.radiance[0] + sample.radiance[1] + sample.radiance[2];
            rays += sample.rays;
        }
        p->sums[row] = sum;
        p->rays[row] = rays;
    }
}

static double draw(bench_image *p, uint32_t thread_count)
{
    double start = rays_now(p->uses_cpu_time, thread_count);
    parallel_for(thread_count, p->desc.height / TILE, 1, draw_rows, p);
    return rays_now(p->uses_cpu_time, thread_count) - start;
}

/* ---- rates ---- */

/* Medians of each method of tracing a kind of ray: seconds[method]. */
static void time_rays(const bench_image *p, rays_kind kind, int runs, uint32_t threads, double seconds[3],
                      uint64_t hits[3])
{
    static double times[3][MAX_RUNS];
    for (int i = 0; i < runs; i++) {
        const shading_scene *scene = &p->setup.shading;
        rays_result results[3] = {rays_trace_facet(scene, kind, threads),
                                  rays_trace_embree(scene, kind, threads)};
        if (kind == RAYS_CAMERA)
            results[2] = rays_trace_packets(scene, kind, threads);
        for (int method = 0; method < 3; method++) {
            times[method][i] = results[method].seconds;
            hits[method] = results[method].hits;
        }
    }
    for (int method = 0; method < 3; method++)
        seconds[method] = median(times[method], runs);
}

static const char *const kind_names[RAYS_KINDS] = {"camera", "bounce", "shadow"};

/* Seconds of all rays on one thread; counts surface hits in *vertices. */
static double print_rays(const bench_image *p, int runs, uint64_t *vertices)
{
    double traced = 0.0;
    *vertices = 0;
    printf("    %-8s %9s %7s | %8s %8s %6s | %8s %8s %6s | %8s\n", "rays", "M", "hit", "facet 1", "Embree",
           "ratio", "facet 2", "Embree", "ratio", "packets");
    for (int kind = 0; kind < RAYS_KINDS; kind++) {
        double one[3];
        double two[3];
        uint64_t hits[3];
        double rays = (double)rays_count((rays_kind)kind) * 1e-6;
        time_rays(p, (rays_kind)kind, runs, 1, one, hits);
        time_rays(p, (rays_kind)kind, runs, 2, two, hits);
        printf("    %-8s %9.3f %6.1f%% | %8.2f %8.2f %6.2f | %8.2f %8.2f %6.2f | ", kind_names[kind], rays,
               1e-4 * (double)hits[0] / rays, rays / one[0], rays / one[1], one[1] / one[0], rays / two[0],
               rays / two[1], two[1] / two[0]);
        if (kind == RAYS_CAMERA)
            printf("%8.2f", rays / two[2]);
        printf("\n");
        if (hits[0] != hits[1])
            printf("    Embree hits %.1f %%: what alpha and culled sides let pass\n",
                   1e-4 * (double)hits[1] / rays);
        traced += one[0];
        *vertices += kind == RAYS_SHADOW ? 0 : hits[0];
    }
    return traced;
}

static void measure(const char *model, const char *light, uint32_t size, int runs, bool uses_cpu_time)
{
    bench_image p = {.uses_cpu_time = uses_cpu_time};
    rays_use_cpu_time(uses_cpu_time);
    prepare(&p, model, light, size);
    double one[MAX_RUNS];
    double two[MAX_RUNS];
    double paths = (double)size * size * SAMPLES;
    rays_record((size_t)paths * 8);
    draw(&p, 1);
    rays_record(0);
    for (int i = 0; i < runs; i++) {
        one[i] = draw(&p, 1);
        two[i] = draw(&p, 2);
    }
    double seconds = median(one, runs);
    double seconds2 = median(two, runs);
    double rays = 0.0;
    for (uint32_t row = 0; row < size / TILE; row++)
        rays += (double)p.rays[row];
    const char *name = strrchr(model, '/');
    printf("%s\n", name ? name + 1 : model);
    uint64_t vertices;
    double traced = print_rays(&p, runs, &vertices);
    printf("    %.2f M paths/s, %.2f M rays/s on two threads (%.2f times one); one thread: %.0f ns a path, "
           "%.0f ns a "
           "vertex, %.2f vertices and %.2f rays a path, traced %.0f %%\n",
           1e-6 * paths / seconds2, 1e-6 * rays / seconds2, seconds / seconds2, 1e9 * seconds / paths,
           1e9 * seconds / (double)vertices, (double)vertices / paths, rays / paths,
           100.0 * traced / seconds);
    release(&p);
}

int main(int argc, char **argv)
{
    int runs = 5;
    uint32_t size = 512;
    bool uses_cpu_time = false;
    int first = 1;
    for (; first + 1 < argc && argv[first][0] == '-'; first += 2) {
        if (argv[first][1] == 'n')
            runs = atoi(argv[first + 1]);
        else if (argv[first][1] == 'c')
            uses_cpu_time = atoi(argv[first + 1]) != 0;
        else
            size = (uint32_t)atoi(argv[first + 1]) / TILE * TILE;
    }
    if (first >= argc || runs < 1 || runs > MAX_RUNS || size == 0) {
        fprintf(stderr, "usage: path [-c 1] [-n RUNS] [-s SIZE] MODEL[,LIGHT.hdr] ...\n");
        return 2;
    }
    for (int i = first; i < argc; i++) {
        char *light = strchr(argv[i], ',');
        if (light)
            *light++ = 0;
        measure(argv[i], light, size, runs, uses_cpu_time);
    }
    return 0;
}
