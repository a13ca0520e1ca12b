/* light_fixture.h - for tests: environments of formulas, lights, directions. Include after cmocka.h. */
#ifndef IBL_LIGHT_FIXTURE_H
#define IBL_LIGHT_FIXTURE_H

#include <math.h>

#include "ibl/environment.h"
#include "ibl/equirect.h"
#include "ibl/ibl.h"

/* An environment of width x height whose texels come from radiance(direction). */
static inline facet_environment *make_environment(uint32_t width, uint32_t height,
                                                  void (*radiance)(const float d[3], float out[3]))
{
    facet_environment *e = NULL;
    assert_int_equal(facet_environment_create_constant((float[3]){0.0f, 0.0f, 0.0f}, NULL, &e, NULL),
                     FACET_OK);
    image_destroy(&e->panorama);
    assert_int_equal(image_create(NULL, width, height, 3, IMAGE_F32, &e->panorama, NULL), FACET_OK);
    for (uint32_t y = 0; y < height; y++)
        for (uint32_t x = 0; x < width; x++) {
            float d[3];
            equirect_direction(width, height, x, y, d);
            radiance(d, (float *)e->panorama.pixels + 3 * ((size_t)y * width + x));
        }
    return e;
}

/* All lookups at any roughness. */
static const ibl_light_desc all_lookups = {.needs_irradiance = true,
                                           .needs_specular = true,
                                           .max_roughness = 1.0f,
                                           .needs_sheen = true,
                                           .max_sheen_roughness = 1.0f,
                                           .needs_background = true};

static inline const ibl_light *prepare(facet_environment *e, ibl_light_desc desc)
{
    const ibl_light *light = NULL;
    facet_error error = {0};
    facet_result result = ibl_light_prepare(e, &desc, &light, &error);
    if (result != FACET_OK)
        print_error("%s\n", error.message);
    assert_int_equal(result, FACET_OK);
    return light;
}

/* Direction number i of count, spread evenly over the sphere. */
static inline void test_direction(int i, int count, float d[3])
{
    /* a spiral (Fibonacci lattice) */
    double y = 1.0 - (2.0 * i + 1.0) / count;
    double phi = i * 2.399963229728653;
    double across = sqrt(1.0 - y * y);
    d[0] = (float)(across * cos(phi));
    d[1] = (float)y;
    d[2] = (float)(across * sin(phi));
}

#endif
