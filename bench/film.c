/* film.c - milliseconds from radiance to 8-bit codes of a film of 512 x 512 pixels, by tone mapping operator.
 *     build/release/bench/film [THREADS] */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/clock.h"
#include "film/film_image.h"

enum { SIZE = 512, REPEATS = 20 };

/* Half of the image is background, with a line of partly covered pixels; radiance from 0 to 4. */
static void fill(film *f)
{
    uint32_t random = 1;
    for (size_t i = 0; i < (size_t)SIZE * SIZE; i++) {
        size_t x = i % SIZE;
        float opacity = x < SIZE / 4 ? 0.0f : x < SIZE / 4 + 4 ? 0.5f : 1.0f;
        for (size_t k = 0; k < 3; k++) {
            random = random * 1664525u + 1013904223u;
            f->layers[0].pixels[4 * i + k] = opacity * (float)(random >> 8) * 0x1p-22f;
        }
        f->layers[0].pixels[4 * i + 3] = opacity;
    }
}

int main(int argc, char **argv)
{
    uint32_t thread_count = argc > 1 ? (uint32_t)strtoul(argv[1], NULL, 10) : facet_thread_count();
    static const char *const names[] = {"none",     "neutral",           "aces", "aces-narkowicz", "agx",
                                        "reinhard", "reinhard-extended", "hable"};
    film f;
    if (film_create(NULL, SIZE, SIZE, 0, &f, NULL) != FACET_OK)
        return 1;
    printf("%u x %u pixels, %u threads, best of %u\n%-18s %10s %10s %10s\n", SIZE, SIZE, thread_count,
           REPEATS, "operator", "tonemap ms", "8 bits ms", "16 bits ms");
    for (int op = FACET_TONEMAP_NONE; op <= FACET_TONEMAP_HABLE; op++) {
        double best[3] = {1.0, 1.0, 1.0};
        for (int repeat = 0; repeat < REPEATS; repeat++) {
            image narrow;
            image wide;
            fill(&f);
            double start = clock_seconds();
            film_tone_map(&f, (facet_tonemap)op, NULL, thread_count);
            double mapped = clock_seconds();
            if (film_to_display_image(&f, IMAGE_U8, true, NULL, thread_count, &narrow, NULL) != FACET_OK)
                return 1;
            double converted = clock_seconds();
            if (film_to_display_image(&f, IMAGE_U16, true, NULL, thread_count, &wide, NULL) != FACET_OK)
                return 1;
            double widened = clock_seconds();
            image_destroy(&narrow);
            image_destroy(&wide);
            const double times[3] = {mapped - start, converted - mapped, widened - converted};
            for (int i = 0; i < 3; i++)
                best[i] = times[i] < best[i] ? times[i] : best[i];
        }
        printf("%-18s %10.2f %10.2f %10.2f\n", names[op], 1e3 * best[0], 1e3 * best[1], 1e3 * best[2]);
    }
    film_destroy(&f);
    return 0;
}
