/* obj.c - time of reading OBJ files, from the open file to the finished scene, beside a scan of the same
 * bytes for line ends by memchr(). Usage: bench/obj [MEGABYTES (300)] [FILE..]; without files it writes a
 * temporary one per kind: a wavy sheet of positions, texture coordinates, normals and triangles; the same
 * with positions only, where normals are computed; quadrilaterals with negative (relative) indices.
 * Medians. */
#define _POSIX_C_SOURCE 200809L
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/clock.h"
#include "base/file.h"
#include "io/obj/obj.h"
#include "median.h"

enum { RUNS = 5 };

/* ---- files ---- */

typedef enum kind { ALL_ATTRIBUTES, POSITIONS_ONLY, RELATIVE_QUADS, KIND_COUNT } kind;

static const char *const KIND_NAMES[] = {"v vt vn, triangles", "v, triangles", "v vt vn, relative quads"};

static void write_vertex(FILE *file, kind k, double x, double y)
{
    double z = 0.05 * sin(40.0 * x) * cos(31.0 * y);
    double dx = 2.0 * cos(40.0 * x) * cos(31.0 * y);
    double dy = -1.55 * sin(40.0 * x) * sin(31.0 * y);
    double length = sqrt(1.0 + dx * dx + dy * dy);
    fprintf(file, "v %.6f %.6f %.6f\n", 10.0 * x - 5.0, 10.0 * y - 5.0, z);
    if (k != POSITIONS_ONLY)
        fprintf(file, "vt %.6f %.6f\nvn %.4f %.4f %.4f\n", x, y, -dx / length, -dy / length, 1.0 / length);
}

static void write_faces(FILE *file, kind k, long a, long width)
{
    const long c[4] = {a, a + 1, a + 1 + width, a + width};
    if (k == RELATIVE_QUADS) {
        fprintf(file, "f");
        for (int i = 0; i < 4; i++)
            fprintf(file, " %ld/%ld/%ld", c[i], c[i], c[i]);
        fprintf(file, "\n");
        return;
    }
    for (int i = 0; i < 2; i++)
        if (k == POSITIONS_ONLY)
            fprintf(file, "f %ld %ld %ld\n", c[0], c[1 + i], c[2 + i]);
        else
            fprintf(file, "f %ld/%ld/%ld %ld/%ld/%ld %ld/%ld/%ld\n", c[0], c[0], c[0], c[1 + i], c[1 + i],
                    c[1 + i], c[2 + i], c[2 + i], c[2 + i]);
}

/* Rows of vertices, as written by scanners; faces at the end, or after each row if relative. */
static void write_sheet(FILE *file, kind k, double bytes)
{
    const long width = 1000;
    const double per_vertex = k == ALL_ATTRIBUTES ? 198.0 : k == POSITIONS_ONLY ? 77.0 : 145.0;
    long rows = (long)(bytes / per_vertex / (double)width) + 2;
    fprintf(file, "# facet bench\no sheet\n");
    for (long y = 0; y < rows; y++) {
        for (long x = 0; x < width; x++)
            write_vertex(file, k, (double)x / (double)width, (double)y / (double)rows);
        for (long x = 0; k == RELATIVE_QUADS && y > 0 && x + 1 < width; x++)
            write_faces(file, k, x - 2 * width, width);
    }
    for (long y = 0; k != RELATIVE_QUADS && y + 1 < rows; y++)
        for (long x = 0; x + 1 < width; x++)
            write_faces(file, k, 1 + y * width + x, width);
}

/* ---- times ---- */

static double time_scan(const char *path, double *megabytes)
{
    double seconds[RUNS];
    size_t lines = 0;
    for (int run = 0; run < RUNS; run++) {
        file_bytes file;
        double start = clock_seconds();
        if (file_open(path, 0, NULL, &file, NULL) != FACET_OK)
            return -1.0;
        const char *end = (const char *)file.data + file.size;
        for (const char *p = (const char *)file.data; p && p < end; lines++) {
            p = memchr(p, '\n', (size_t)(end - p));
            p = p ? p + 1 : NULL;
        }
        *megabytes = 1e-6 * (double)file.size;
        file_close(&file);
        seconds[run] = clock_seconds() - start;
    }
    return lines ? median(seconds, RUNS) : -1.0;
}

static double time_load(const char *path, uint32_t threads, double *peak, double *kept)
{
    double seconds[RUNS];
    for (int run = 0; run < RUNS; run++) {
        facet_budget *budget = NULL;
        facet_error error;
        if (facet_budget_create(0, &budget, &error) != FACET_OK)
            return -1.0;
        const facet_scene_desc desc = {.thread_count = threads, .allocator = facet_budget_allocator(budget)};
        facet_scene *scene = NULL;
        double start = clock_seconds();
        if (obj_load(path, &desc, &scene, &error) != FACET_OK) {
            printf("%s\n", error.message);
            facet_budget_destroy(budget);
            return -1.0;
        }
        seconds[run] = clock_seconds() - start;
        *peak = 1e-6 * (double)facet_budget_peak_bytes(budget);
        *kept = 1e-6 * (double)facet_budget_used_bytes(budget);
        scene_destroy(scene);
        facet_budget_destroy(budget);
    }
    return median(seconds, RUNS);
}

static void measure(const char *path, const char *name)
{
    double megabytes = 0.0;
    double scan = time_scan(path, &megabytes);
    printf("%-26s %8.1f MB   memchr %7.0f MB/s", name, megabytes, megabytes / scan);
    for (uint32_t threads = 1; threads <= 2; threads++) {
        double peak = 0.0;
        double kept = 0.0;
        double seconds = time_load(path, threads, &peak, &kept);
        if (seconds < 0.0)
            return;
        printf("   T%u %6.0f MB/s", threads, megabytes / seconds);
        if (threads == 2)
            printf("   peak %.0f MB, kept %.0f MB (%.2f)\n", peak, kept, peak / kept);
    }
    fflush(stdout);
}

int main(int argc, char **argv)
{
    double bytes = 1e6 * (argc > 1 ? strtod(argv[1], NULL) : 300.0);
    for (int i = 2; i < argc; i++)
        measure(argv[i], path_base_name(argv[i]));
    for (int k = 0; argc < 3 && k < KIND_COUNT; k++) {
        char path[] = "/tmp/facet-bench-XXXXXX";
        int descriptor = mkstemp(path);
        FILE *file = descriptor >= 0 ? fdopen(descriptor, "w") : NULL;
        if (!file) {
            perror(path);
            return 1;
        }
        write_sheet(file, (kind)k, bytes);
        fclose(file);
        measure(path, KIND_NAMES[k]);
        unlink(path);
    }
    return 0;
}
