/* water_glints_test.c - glints are random, but conserve light: images that look into the
 * sun have the same mean with and without them. */
#include "water/water_fixture.h"

enum { WIDTH = 72, HEIGHT = 54, BLOCKS = 3 };

static const char *const names[] = {"glass", "breeze", "trade-wind", "gale", "lagoon", "harbour"};
static const float heights_deg[] = {2.0f, 6.0f, 20.0f, 60.0f};

/* Towards the sun, from the horizon to steeply down; where there is no wind, its image alone is seen,
 * close up. */
static void make_view(shot *s, const facet_sea_desc *desc, facet_environment *sky, float height_deg,
                      uint32_t samples)
{
    bool is_mirror = desc->wind_mps == 0.0f;
    make_shot(s, WIDTH, HEIGHT, 3.0f, is_mirror ? height_deg * 0.0174532925f : 0.35f);
    s->camera.fov_y_rad = is_mirror ? 0.08f : 0.66f;
    s->desc.samples = samples;
    s->desc.environment = sky;
    s->desc.sun = (facet_sun){.azimuth_rad = 3.14159265f,
                              .elevation_rad = height_deg * 0.0174532925f,
                              .illuminance_lux = {9e4f, 9e4f, 9e4f}};
    s->desc.sea_shading.omits_foam = true;
}

/* Light of the rows of a block, and of their squares. */
typedef struct block {
    double sum, squares;
} block;

static void sum_blocks(const shot *s, block blocks[BLOCKS])
{
    for (uint32_t y = 0; y < HEIGHT; y++)
        for (uint32_t x = 0; x < WIDTH; x++) {
            double light = (double)shot_pixel(s, x, y)[1];
            block *b = &blocks[y * BLOCKS / HEIGHT];
            b->sum += light;
            b->squares += light * light;
        }
}

/* The fewer pixels have the light, the more is chance; X of a cell, of four pixels, has a variance of at
 * most some 1. */
static void compare(const facet_sea *sea, const facet_sea_desc *desc, facet_environment *sky,
                    const char *name, float height_deg, uint32_t samples)
{
    block with[BLOCKS] = {{0}}, without[BLOCKS] = {{0}};
    shot s;
    make_view(&s, desc, sky, height_deg, samples);
    for (int i = 0; i < 2; i++) {
        s.desc.sea_shading.omits_glints = i;
        draw_shot(sea, &s);
        scan_shot(&s, name);
        sum_blocks(&s, i ? without : with);
    }
    film_destroy(&s.film);
    for (int i = 0; i < BLOCKS; i++) {
        double pixels = without[i].sum * without[i].sum / without[i].squares;
        double more = with[i].sum / without[i].sum - 1.0, most = 0.01 + 2.0 / sqrt(pixels);
        if (!(fabs(more) < most))
            fail_msg("%s, sun at %g, block %d: glints add %g to the light of %g pixels, at most %g is chance",
                     name, (double)height_deg, i, more, pixels, most);
    }
}

static void glints_keep_the_mean(void **state)
{
    (void)state;
    static const float color[3] = {1.0f, 1.0f, 1.0f};
    facet_environment *sky = NULL;
    assert_int_equal(facet_environment_create_gradient(color, color, color, NULL, &sky, NULL), FACET_OK);
    for (size_t k = 0; k < sizeof names / sizeof *names; k++) {
        facet_sea_desc desc;
        assert_int_equal(sea_preset(names[k], &desc, NULL), FACET_OK);
        desc.resolution = 64;
        facet_sea *sea = make_sea(&desc);
        for (size_t i = 0; i < sizeof heights_deg / sizeof *heights_deg; i++)
            compare(sea, &desc, sky, names[k], heights_deg[i], (k + i) % 2 ? 4 : 1);
        sea_destroy(sea);
    }
    facet_environment_destroy(sky);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(glints_keep_the_mean)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
