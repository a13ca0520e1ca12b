/* water_fixture.h - for tests: small images of seas. */
#ifndef WATER_WATER_FIXTURE_H
#define WATER_WATER_FIXTURE_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <math.h>

#include "ocean/sea.h"
#include "water/water_render.h"

/* An image that is yet to be drawn; tests change its desc first. */
typedef struct shot {
    facet_camera camera;
    facet_render_desc desc;
    const facet_scene *scene; /* in the sea; NULL: none */
    film film;
    facet_render_stats stats;
    water_cache cache;
} shot;

/* The cache for images of the sea, which desc has from now on. */
static inline water_cache *shot_in(const facet_sea *sea, shot *s)
{
    s->desc.sea = sea;
    return &s->cache;
}

static inline facet_sea *make_sea(const facet_sea_desc *desc)
{
    facet_sea *sea;
    facet_error error;
    if (sea_create(desc, &sea, &error) != FACET_OK)
        fail_msg("%s", error.message);
    return sea;
}

/* Looks from (0, height, 0) along -Z, down by a pitch; the sun is 40 degrees high, to the side. */
static inline void make_shot(shot *s, uint32_t width, uint32_t height, float eye_m, float down_rad)
{
    *s = (shot){.camera = {.eye = {0.0f, eye_m, 0.0f},
                           .target = {0.0f, eye_m - 100.0f * sinf(down_rad), -100.0f * cosf(down_rad)},
                           .fov_y_rad = 0.7f}};
    s->desc.width = width;
    s->desc.height = height;
    s->desc.samples = 1;
    s->desc.thread_count = 2;
    s->desc.sky.sun_elevation_rad = 0.7f;
    s->desc.sky.sun_azimuth_rad = 1.0f;
}

static inline facet_result try_shot(const facet_sea *sea, shot *s, facet_error *error)
{
    facet_render_desc *r = &s->desc;
    r->camera = &s->camera;
    if (r->crop[2] == 0) {
        r->crop[2] = r->width;
        r->crop[3] = r->height;
    }
    film_destroy(&s->film);
    if (film_create(&r->allocator, r->crop[2], r->crop[3], 0, &s->film, error) != FACET_OK)
        return FACET_ERROR_MEMORY;
    facet_result result = water_render(shot_in(sea, s), s->scene, &s->desc, &s->film, &s->stats, error);
    water_cache_clear(&s->cache);
    return result;
}

static inline void draw_shot(const facet_sea *sea, shot *s)
{
    facet_error error;
    if (try_shot(sea, s, &error) != FACET_OK)
        fail_msg("%s", error.message);
}

static inline const float *shot_pixel(const shot *s, uint32_t x, uint32_t y)
{
    return s->film.layers[0].pixels + 4 * ((size_t)y * s->film.width + x);
}

/* Largest of all numbers; fails at one that is not finite or negative. */
static inline float scan_shot(const shot *s, const char *name)
{
    float largest = 0.0f;
    for (uint32_t i = 0; i < s->film.width * s->film.height * 4; i++) {
        float x = s->film.layers[0].pixels[i];
        if (!(x >= 0.0f) || !isfinite(x))
            fail_msg("%s: pixel %u, %u has %g in channel %u", name, i / 4 % s->film.width,
                     i / 4 / s->film.width, (double)x, i % 4);
        largest = fmaxf(largest, x);
    }
    return largest;
}

#endif
