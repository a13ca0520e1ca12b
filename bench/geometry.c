/* geometry.c - time of reading models, compressed or not. Usage: bench/geometry MODEL.. ; each number is the
 * best of several runs, on one thread and on all. */
#include <math.h>
#include <stdio.h>

#include "base/clock.h"
#include "base/memory.h"
#include "io/gltf/gltf.h"

enum { RUNS = 7 };

static uint64_t count_triangles(const facet_scene *scene)
{
    uint64_t count = 0;
    for (uint32_t i = 0; i < scene->mesh_count; i++)
        for (uint32_t k = 0; k < scene->meshes[i].primitive_count; k++)
            count += scene->meshes[i].primitives[k].mode == SCENE_TRIANGLES
                         ? scene->meshes[i].primitives[k].index_count / 3
                         : 0;
    return count;
}

/* Seconds, and the number of triangles; negative: unreadable. */
static double time_load(const char *path, uint32_t threads, uint64_t *triangles)
{
    double best = 1e9;
    for (int run = 0; run < RUNS; run++) {
        const facet_scene_desc desc = {.thread_count = threads};
        facet_scene *scene = NULL;
        facet_error error;
        double start = clock_seconds();
        if (gltf_load(path, &desc, &scene, &error) != FACET_OK) {
            printf("%s\n", error.message);
            return -1.0;
        }
        best = fmin(best, clock_seconds() - start);
        *triangles = count_triangles(scene);
        scene_destroy(scene);
    }
    return best;
}

int main(int argc, char **argv)
{
    for (int i = 1; i < argc; i++)
        for (int k = 0; k < 2; k++) {
            uint64_t triangles = 0;
            const uint32_t threads = k ? facet_thread_count() : 1;
            double seconds = time_load(argv[i], threads, &triangles);
            if (seconds > 0)
                printf("%-40s T%u %9.2f ms %8.2f million triangles/s\n", argv[i], threads, seconds * 1e3,
                       1e-6 * (double)triangles / seconds);
        }
    return 0;
}
