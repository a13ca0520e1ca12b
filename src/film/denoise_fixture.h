/* denoise_fixture.h - images of few samples with real Monte Carlo noise, and what they converge to: a path tracer of
 * spheres for tests of the denoiser, which cannot see the real one. */
#ifndef FILM_DENOISE_FIXTURE_H
#define FILM_DENOISE_FIXTURE_H

#include "film/film.h"

typedef enum fixture_scene {
    FIXTURE_BOX,    /* closed room, small bright lamp: a matte, a glossy, a glass sphere; checkered floor */
    FIXTURE_SKY,    /* textured spheres on a textured floor under sun and sky: hard and contact shadows */
    FIXTURE_LIGHTS, /* many small lamps of all colors, one sampled at a time: heavy tails */
    FIXTURE_CUTOUT, /* spheres before nothing, one of them half transparent by chance: partial opacity */
    FIXTURE_SCENE_COUNT
} fixture_scene;

extern const char *const fixture_scene_names[FIXTURE_SCENE_COUNT];

/* Draws samples per pixel of scene into a film with the layers "", "normal", "albedo" and "variance"; seed: another one
 * gives other noise. */
film fixture_render(fixture_scene scene, uint32_t width, uint32_t height, uint32_t samples, uint32_t seed);
/* A copy of f, and of its layers. */
film fixture_copy(const film *f);
/* Root of the mean squared error of RGB (premultiplied). is_relative: each pixel's is divided by the truth's square plus
 * 1 % of its mean's, as in Rousselle et al. 2011. */
double fixture_error(const film *f, const film *truth, bool is_relative);

#endif
