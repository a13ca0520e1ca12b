/* legacy.c - conversions of materials between OpenGL 1 and PBR per second, with and without their errors.
 *     build/release/bench/legacy [THREADS] */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/clock.h"
#include "base/parallel.h"
#include "legacy/classic_materials.h"

enum { MATERIALS = 4096, REPEATS = 3 };

typedef struct work {
    const fit_metric *metric;
    const ogl1_surface *old;
    const pbr_surface *new;
    double *error;
} work;

static fit_error compare(const work *w, size_t i, const pbr_surface *pbr)
{
    return fit_compare(w->metric, &w->old[i], pbr, FIT_FROM_OGL1);
}

static void closed(void *context, size_t begin, size_t end)
{
    work *w = context;
    for (size_t i = begin; i < end; i++) {
        pbr_surface pbr;
        ogl1_to_pbr_closed(&w->old[i], &pbr);
        w->error[i] = (double)pbr.specular;
    }
}

static void core_closed(void *context, size_t begin, size_t end)
{
    work *w = context;
    for (size_t i = begin; i < end; i++) {
        pbr_surface pbr;
        ogl1_to_pbr_core_closed(&w->old[i], &pbr);
        w->error[i] = (double)pbr.metallic;
    }
}

static void closed_and_errors(void *context, size_t begin, size_t end)
{
    work *w = context;
    for (size_t i = begin; i < end; i++) {
        pbr_surface pbr;
        ogl1_to_pbr_closed(&w->old[i], &pbr);
        w->error[i] = compare(w, i, &pbr).E;
    }
}

/* All errors in a report on one material: E, E of the display, of views, of the naive formula, of core glTF. */
static void reported(void *context, size_t begin, size_t end)
{
    work *w = context;
    for (size_t i = begin; i < end; i++) {
        pbr_surface pbr;
        ogl1_to_pbr_naive(&w->old[i], &pbr);
        w->error[i] = compare(w, i, &pbr).E;
        ogl1_to_pbr_core_closed(&w->old[i], &pbr);
        w->error[i] += compare(w, i, &pbr).E;
        ogl1_to_pbr_closed(&w->old[i], &pbr);
        w->error[i] += compare(w, i, &pbr).E;
    }
}

static void fit(void *context, size_t begin, size_t end)
{
    work *w = context;
    for (size_t i = begin; i < end; i++) {
        pbr_surface pbr;
        ogl1_to_pbr_fit(w->metric, &w->old[i], FACET_LEGACY_TARGET_LINEAR, &pbr);
        w->error[i] = compare(w, i, &pbr).E;
    }
}

static void fit_display(void *context, size_t begin, size_t end)
{
    work *w = context;
    for (size_t i = begin; i < end; i++) {
        pbr_surface pbr;
        ogl1_to_pbr_fit(w->metric, &w->old[i], FACET_LEGACY_TARGET_DISPLAY, &pbr);
        w->error[i] = compare(w, i, &pbr).E_display;
    }
}

static void core_fit(void *context, size_t begin, size_t end)
{
    work *w = context;
    for (size_t i = begin; i < end; i++) {
        pbr_surface pbr;
        ogl1_to_pbr_core_fit(w->metric, &w->old[i], FACET_LEGACY_TARGET_LINEAR, &pbr);
        w->error[i] = compare(w, i, &pbr).E;
    }
}

static void old_closed(void *context, size_t begin, size_t end)
{
    work *w = context;
    for (size_t i = begin; i < end; i++) {
        ogl1_surface old;
        pbr_to_ogl1_closed(&w->new[i], &old);
        w->error[i] = (double)old.shininess;
    }
}

static void old_closed_at(void *context, size_t begin, size_t end)
{
    work *w = context;
    for (size_t i = begin; i < end; i++) {
        ogl1_surface old;
        pbr_to_ogl1_closed_at(&w->new[i], 50.0f, &old);
        w->error[i] = (double)old.specular[0];
    }
}

static void old_fit(void *context, size_t begin, size_t end)
{
    work *w = context;
    for (size_t i = begin; i < end; i++) {
        ogl1_surface old;
        pbr_to_ogl1_fit(w->metric, &w->new[i], FACET_LEGACY_TARGET_LINEAR, FIT_DISPLAYABLE, &old);
        w->error[i] = fit_compare(w->metric, &old, &w->new[i], FIT_FROM_PBR).E;
    }
}

static void old_fit_display(void *context, size_t begin, size_t end)
{
    work *w = context;
    for (size_t i = begin; i < end; i++) {
        ogl1_surface old;
        pbr_to_ogl1_fit(w->metric, &w->new[i], FACET_LEGACY_TARGET_DISPLAY, FIT_DISPLAYABLE, &old);
        w->error[i] = fit_compare(w->metric, &old, &w->new[i], FIT_FROM_PBR).E_display;
    }
}

typedef struct entry {
    const char *name;
    void (*body)(void *context, size_t begin, size_t end);
    size_t count;
} entry;

static float noise(void)
{
    static uint32_t state = 1;
    state = state * 1664525u + 1013904223u;
    return (float)(state >> 8) * 0x1p-24f;
}

int main(int argc, char **argv)
{
    static ogl1_surface old[MATERIALS];
    static pbr_surface new[MATERIALS];
    static double error[MATERIALS];
    uint32_t thread_count = argc > 1 ? (uint32_t)strtoul(argv[1], NULL, 10) : facet_thread_count();
    for (size_t i = 0; i < MATERIALS; i++) { /* the classic materials, slightly varied */
        old[i] = classic_materials[i % CLASSIC_COUNT].surface;
        old[i].shininess *= 0.9f + 0.2f * noise();
        new[i] = pbr_surface_default();
        new[i].perceptual_roughness = noise();
        new[i].metallic = i % 2 ? 1.0f : 0.0f;
        for (int k = 0; k < 3; k++)
            new[i].base_color[k] = noise();
    }
    fit_metric *metric = NULL;
    double start = clock_seconds();
    if (fit_metric_create(NULL, PBR_CORRELATED, &metric, NULL) != FACET_OK)
        return 1;
    printf("metric: %.2f ms; %u threads, best of %d\n%-34s %12s %10s\n", 1e3 * (clock_seconds() - start),
           thread_count, REPEATS, "", "materials/s", "mean");
    static const entry entries[] = {{"OGL1 to PBR, closed", closed, MATERIALS},
                                    {"  core, closed", core_closed, MATERIALS},
                                    {"  closed, E, E_display, views", closed_and_errors, MATERIALS},
                                    {"  the same with naive and core", reported, MATERIALS},
                                    {"  fit, E", fit, 1024},
                                    {"  fit for the display, E_display", fit_display, 512},
                                    {"  core, fit, E", core_fit, 512},
                                    {"PBR to OGL1, closed", old_closed, MATERIALS},
                                    {"  closed for a given exponent", old_closed_at, MATERIALS},
                                    {"  fit, E", old_fit, 1024},
                                    {"  fit for the display, E_display", old_fit_display, 512}};
    for (size_t e = 0; e < sizeof entries / sizeof *entries; e++) {
        work w = {metric, old, new, error};
        double best = (double)INFINITY;
        double mean = 0.0;
        for (int repeat = 0; repeat < REPEATS; repeat++) {
            start = clock_seconds();
            parallel_for(thread_count, entries[e].count, 16, entries[e].body, &w);
            best = fmin(best, clock_seconds() - start);
        }
        for (size_t i = 0; i < entries[e].count; i++)
            mean += error[i] / (double)entries[e].count;
        printf("%-34s %12.0f %10.4f\n", entries[e].name, (double)entries[e].count / best, mean);
    }
    fit_metric_destroy(metric);
    return 0;
}
