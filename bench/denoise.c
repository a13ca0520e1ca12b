/* denoise.c - milliseconds per megapixel of denoising, on one thread and on two: of a pure noise image, of
 * one with edges everywhere, which needs a window per pixel, and of one almost without noise.
 *     build/release/bench/denoise [WIDTH HEIGHT] */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "base/clock.h"
#include "film/film.h"

enum { REPEATS = 3 };

static float uniform(uint32_t *state)
{
    *state = *state * 1664525u + 1013904223u;
    return (float)(*state >> 8) * 0x1p-24f;
}

/* Radiance 1 with normal noise of standard deviation noise; tiles of block pixels differ in albedo and
 * normal. */
static void fill(film *f, float noise, uint32_t block)
{
    uint32_t random = 1;
    for (size_t i = 0; i < (size_t)f->width * f->height; i++) {
        uint32_t tile = (uint32_t)(i % f->width) / block * 7919u + (uint32_t)(i / f->width) / block * 104729u;
        uniform(&tile);
        float albedo = 0.2f + 0.7f * uniform(&tile), angle = 3.0f * uniform(&tile);
        const float normal[3] = {sinf(angle), 0.0f, cosf(angle)};
        for (size_t c = 0; c < 3; c++) {
            float sum = -6.0f;
            for (int k = 0; k < 12; k++)
                sum += uniform(&random);
            f->layers[0].pixels[4 * i + c] = albedo * (1.0f + 0.2f * normal[0] + noise * sum);
            film_find(f, "albedo")->pixels[3 * i + c] = albedo;
            film_find(f, "normal")->pixels[3 * i + c] = normal[c];
            film_find(f, "variance")->pixels[3 * i + c] = albedo * albedo * noise * noise;
        }
        f->layers[0].pixels[4 * i + 3] = 1.0f;
    }
}

static double best_ms(film *f, float noise, uint32_t block, uint32_t thread_count)
{
    double best = 1e30;
    for (int repeat = 0; repeat < REPEATS; repeat++) {
        fill(f, noise, block);
        double start = clock_seconds();
        if (film_denoise(f, NULL, thread_count, NULL) != FACET_OK)
            exit(1);
        double time = 1e3 * (clock_seconds() - start);
        best = time < best ? time : best;
    }
    return best / (1e-6 * (double)f->width * (double)f->height);
}

int main(int argc, char **argv)
{
    static const struct {
        const char *name;
        float noise;
        uint32_t block;
    } images[] = {
        {"noise", 0.3f, 1u << 20}, {"blocks of 24", 0.3f, 24}, {"blocks of 4", 0.3f, 4}, {"calm", 0.01f, 24}};
    uint32_t width = argc > 2 ? (uint32_t)strtoul(argv[1], NULL, 10) : 1024;
    uint32_t height = argc > 2 ? (uint32_t)strtoul(argv[2], NULL, 10) : 768;
    film f;
    if (film_create(NULL, width, height, FACET_AOV_ALBEDO | FACET_AOV_NORMAL | FACET_AOV_VARIANCE, &f,
                    NULL) != FACET_OK)
        return 1;
    printf("%u x %u pixels, best of %u, ms per megapixel\n%-14s %10s %10s\n", width, height, REPEATS, "image",
           "1 thread", "2 threads");
    for (size_t k = 0; k < sizeof images / sizeof *images; k++)
        printf("%-14s %10.0f %10.0f\n", images[k].name, best_ms(&f, images[k].noise, images[k].block, 1),
               best_ms(&f, images[k].noise, images[k].block, 2));
    film_destroy(&f);
    return 0;
}
