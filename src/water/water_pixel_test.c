/* water_pixel_test.c - four samples a pixel, shaded together, beside many that are shaded one by one. */
#include "water/water_fixture.h"

#include <string.h>

#include "tests/support/support.h"
#include "film/meter.h"

enum { WIDTH = 40, HEIGHT = 32, FEW = 4, MANY = 64 };

/* Part of an image of 960 x 540, as the command renders it: pixels of 1.3 mrad, and the sun beside.
 * Glints are chance, which differs. */
static void make_view(shot *s, float down_rad)
{
    static const float zenith[3] = {1000.0f, 2000.0f, 4000.0f}, horizon[3] = {5000.0f, 5500.0f, 6000.0f};
    static const float nadir[3] = {100.0f, 100.0f, 100.0f};
    facet_render_desc *r = &s->desc;
    make_shot(s, WIDTH, HEIGHT, 3.0f, down_rad);
    s->camera.fov_y_rad = 0.0013f * HEIGHT;
    s->desc.sea_shading.omits_glints = true;
    assert_int_equal(facet_environment_create_gradient(zenith, horizon, nadir, NULL, &r->environment, NULL),
                     FACET_OK);
    r->sun = (facet_sun){.azimuth_rad = 2.8f, .elevation_rad = 0.384f, .illuminance_lux = {7e4f, 6e4f, 5e4f}};
    r->exposure_ev = (float)meter_exposure_ev(14.0);
}

static void draw_view(const facet_sea *sea, shot *s, uint32_t samples, facet_quality quality)
{
    s->desc.samples = samples;
    s->desc.quality = quality;
    draw_shot(sea, s);
    film_tone_map(&s->film, FACET_TONEMAP_AGX, NULL, 2);
}

/* Mean distance of tone-mapped numbers, [0, 1]. */
static double distance(const shot *s, const float *many)
{
    double sum = 0.0;
    for (uint32_t i = 0; i < WIDTH * HEIGHT * 4; i++)
        sum += fabs((double)s->film.layers[0].pixels[i] - (double)many[i]);
    return sum / (3.0 * WIDTH * HEIGHT);
}

static double error_of_few(const char *name, float down_rad)
{
    facet_sea_desc desc;
    static float many[WIDTH * HEIGHT * 4];
    shot s;
    assert_int_equal(sea_preset(name, &desc, NULL), FACET_OK);
    facet_sea *sea = make_sea(&desc);
    make_view(&s, down_rad);
    draw_view(sea, &s, MANY, FACET_QUALITY_FINAL);
    memcpy(many, s.film.layers[0].pixels, sizeof many);
    draw_view(sea, &s, FEW, FACET_QUALITY_NORMAL);
    double error = distance(&s, many);
    facet_environment_destroy(s.desc.environment);
    film_destroy(&s.film);
    sea_destroy(sea);
    return error;
}

/* Together they are to be as near as one by one, within a quarter. With the mean of their slopes alone,
 * and not what these differ by, four are as far away as a single sample is. */
static void grouped_samples_are_as_accurate_as_single_ones(void **state)
{
    (void)state;
    static const struct {
        const char *name;
        float down_rad;
        double single, apart; /* how far these are */
    } views[] = {{"trade-wind", 0.08f, 0.0083, 0.0049}, {"lagoon", 0.16f, 0.0105, 0.0031},
                 {"breeze", 0.08f, 0.0171, 0.0115},     {"gale", 0.16f, 0.0059, 0.0035},
                 {"harbour", 0.08f, 0.0269, 0.0259},    {"glass", 0.16f, 0.0105, 0.0029}};
    size_t count = IS_SLOW ? 2 : sizeof views / sizeof *views;
    for (size_t i = 0; i < count; i++) {
        double error = error_of_few(views[i].name, views[i].down_rad);
        if (!(error < fmin(1.25 * views[i].apart, 0.95 * views[i].single)))
            fail_msg("%s: four samples together are %.4f off; apart %.4f, one %.4f", views[i].name, error,
                     views[i].apart, views[i].single);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(grouped_samples_are_as_accurate_as_single_ones)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
