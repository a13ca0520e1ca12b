/* compare_fixture.h - for tests: small images, and comparisons of them. Include after cmocka.h. */
#ifndef COMPARE_COMPARE_FIXTURE_H
#define COMPARE_COMPARE_FIXTURE_H

#include <stdlib.h>

#include "tests/support/support.h"
#include "compare/compare.h"
#include "image/srgb.h"

enum { FIXTURE_MAX = 320 * 200 };

typedef struct fixture {
    float rgba[FIXTURE_MAX * 4];
    image texels;
    compare_image image;
} fixture;

static inline fixture *fixture_create(uint32_t width, uint32_t height, bool is_display)
{
    fixture *f = calloc(1, sizeof *f);
    assert_non_null(f);
    assert_true((size_t)width * height <= FIXTURE_MAX);
    f->texels =
        (image){.pixels = f->rgba, .width = width, .height = height, .channel_count = 4, .type = IMAGE_F32};
    f->image = (compare_image){.texels = &f->texels, .is_display = is_display};
    for (size_t i = 0; i < (size_t)width * height; i++)
        f->rgba[4 * i + 3] = 1.0f;
    return f;
}

static inline float *fixture_at(fixture *f, uint32_t x, uint32_t y)
{
    return f->rgba + 4 * ((size_t)y * f->texels.width + x);
}

static inline void fixture_fill(fixture *f, float r, float g, float b, float opacity)
{
    for (uint32_t y = 0; y < f->texels.height; y++)
        for (uint32_t x = 0; x < f->texels.width; x++) {
            float *p = fixture_at(f, x, y);
            p[0] = r;
            p[1] = g;
            p[2] = b;
            p[3] = opacity;
        }
}

/* Stripes, a disc, a ramp and noise of an amplitude (seed 0: none): features for every filter. */
static inline void fixture_draw(fixture *f, uint32_t seed, float amount)
{
    uint32_t state = seed;
    for (uint32_t y = 0; y < f->texels.height; y++)
        for (uint32_t x = 0; x < f->texels.width; x++) {
            float *p = fixture_at(f, x, y);
            float dx = (float)x - 40.0f, dy = (float)y - 30.0f;
            p[0] = (float)x / (float)f->texels.width;
            p[1] = x / 5 % 2 ? 0.7f : 0.1f;
            p[2] = dx * dx + dy * dy < 300.0f ? 0.9f : 0.2f;
            for (int k = 0; k < 3 && seed; k++) {
                p[k] += amount * (lcg_float(&state) - 0.5f);
                p[k] = p[k] < 0.0f ? 0.0f : p[k] > 1.0f ? 1.0f : p[k];
            }
        }
}

/* Fails the test unless the comparison succeeds. */
static inline facet_comparison fixture_compare(const fixture *a, const fixture *b,
                                               const facet_compare_desc *desc)
{
    facet_comparison c;
    facet_error error = {0};
    if (compare_images(&a->image, &b->image, NULL, desc, &c, NULL, &error) != FACET_OK)
        fail_msg("%s", error.message);
    return c;
}

#endif
