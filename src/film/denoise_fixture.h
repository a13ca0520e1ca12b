/* denoise_fixture.h - images of few samples with real Monte Carlo noise, and their converged references: a
 * path tracer of spheres for the denoiser's tests, which must not depend on src/path. */
#ifndef FILM_DENOISE_FIXTURE_H
#define FILM_DENOISE_FIXTURE_H

#include "film/film.h"

typedef enum fixture_scene {
    /* Closed room with a small bright light: a diffuse, a glossy, a glass sphere; checkered floor */
    FIXTURE_BOX,
    FIXTURE_SKY,    /* textured spheres on a textured floor under sun and sky: hard and contact shadows */
    FIXTURE_LIGHTS, /* many small lights of all colors, one sampled at a time: heavy tails */
    /* Spheres over an empty background, one of them half transparent by random choice: partial opacity */
    FIXTURE_CUTOUT,
    FIXTURE_SCENE_COUNT
} fixture_scene;

extern const char *const fixture_scene_names[FIXTURE_SCENE_COUNT];

/* Renders samples per pixel of a scene into a film with the layers "", "normal", "albedo" and "variance";
 * seed selects the noise. */
film fixture_render(fixture_scene scene, uint32_t width, uint32_t height, uint32_t samples, uint32_t seed);
/* A copy of f, and of its layers. */
film fixture_copy(const film *f);
/* Root mean squared error of RGB (premultiplied). is_relative: each squared error over the squared reference
 * plus 1 % of its mean, as in Rousselle et al. 2011. */
double fixture_error(const film *f, const film *truth, bool is_relative);

#endif
