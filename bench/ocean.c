/* ocean.c - cost of waves: a time step by resolution, LUTs of what footprints filter away, and queries of the
 * surface.
 *     build/release/bench/ocean [THREADS] */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "base/clock.h"
#include "ocean/sea.h"
#include "ocean/waves.h"

enum { REPEATS = 20, CALLS = 20000 };

static double least(double a, double b)
{
    return a < b ? a : b;
}

static int bench_steps(uint32_t thread_count)
{
    printf("3 tiles, %u threads, best of %u\n%-10s %10s %10s %10s\n", (unsigned)thread_count, REPEATS,
           "samples", "create ms", "step ms", "filter ms");
    for (uint32_t size = 64; size <= 512; size *= 2) {
        facet_sea_desc d = sea_default();
        d.resolution = size;
        d.thread_count = thread_count;
        sea_state s;
        waves w;
        double start = clock_seconds();
        if (sea_state_create(&d, &s, NULL) || waves_create(&d, &s, &w, NULL))
            return 1;
        double created = clock_seconds() - start, step = 1e9, filter = 1e9;
        for (int i = 0; i < REPEATS; i++) {
            start = clock_seconds();
            waves_set_time(&w, i);
            step = least(step, clock_seconds() - start);
        }
        for (int i = 0; i < 3; i++) {
            slope_filter f;
            start = clock_seconds();
            slope_filter_create(&w, &f);
            filter = least(filter, clock_seconds() - start);
        }
        printf("%4u x %-4u %9.1f %10.2f %10.1f\n", (unsigned)size, (unsigned)size, 1e3 * created, 1e3 * step,
               1e3 * filter);
        waves_destroy(&w);
    }
    return 0;
}

static int bench_questions(void)
{
    sea_state s;
    waves w;
    facet_sea_desc d = sea_default();
    if (sea_state_create(&d, &s, NULL) || waves_create(&d, &s, &w, NULL))
        return 1;
    printf("\n%-12s %10s %10s %10s   one thread\n", "footprint m", "height ns", "near ns", "above ns");
    for (float footprint = 0.003f; footprint < 200.0f; footprint *= 6.0f) {
        double height = 1e9, near_ = 1e9, above = 1e9;
        float sum = 0.0f;
        for (int repeat = 0; repeat < REPEATS; repeat++) {
            double start = clock_seconds(), rest[2];
            for (int i = 0; i < CALLS; i++) /* anywhere */
                sum += waves_height(&w, i * 3.7, i * -1.1, footprint);
            height = least(height, clock_seconds() - start);
            float displacement[2] = {0.0f, 0.0f};
            start = clock_seconds();
            for (int i = 0; i < CALLS; i++) /* along a ray */
                sum += waves_height_near(&w, i * 0.05, i * 0.02, footprint, displacement);
            near_ = least(near_, clock_seconds() - start);
            start = clock_seconds();
            for (int i = 0; i < CALLS; i++)
                sum += waves_above(&w, i * 3.7, i * -1.1, footprint, rest).slope[0];
            above = least(above, clock_seconds() - start);
        }
        printf("%-12.3g %10.0f %10.0f %10.0f%s\n", (double)footprint, 1e9 * height / CALLS,
               1e9 * near_ / CALLS, 1e9 * above / CALLS, isnan(sum) ? "?" : "");
    }
    double start = clock_seconds(), sum = 0.0;
    for (int i = 0; i < 200; i++)
        sum += waves_velocity(&w, i, 0.0);
    printf("velocity %.1f us%s\n", 1e6 * (clock_seconds() - start) / 200.0, isnan(sum) ? "?" : "");
    waves_destroy(&w);
    return 0;
}

int main(int argc, char **argv)
{
    uint32_t thread_count = argc > 1 ? (uint32_t)strtoul(argv[1], NULL, 10) : facet_thread_count();
    return bench_steps(thread_count) || bench_questions();
}
