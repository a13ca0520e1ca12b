/* water_around_test.c - the environment of a model, compared with images of the sea. */
#include "water/water_fixture.h"

#include "cpu/preview_fixture.h"
#include "ibl/environment.h"
#include "ibl/equirect.h"
#include "water/water_setup.h"

static const float white[3] = {1.0f, 1.0f, 1.0f};
static const float STEEP_RAD = 1.2f;

/* Mean of an image. */
static vec3 mean_of(const shot *s)
{
    vec3 sum = vec3(0.0f);
    for (uint32_t i = 0; i < s->film.width * s->film.height; i++) {
        const float *texel = s->film.layers[0].pixels + 4 * i;
        sum = sum + vec3(texel[0], texel[1], texel[2]);
    }
    return sum * (1.0f / (float)(s->film.width * s->film.height));
}

/* What a sphere over it sees in that direction. */
static vec3 seen_by_model(const facet_sea *sea, shot *s)
{
    fixture f = fixture_create();
    fixture_place(&f, fixture_add_sphere(&f, 8, fixture_add_material(&f, scene_material_default())), 0.0f,
                  9.0f, 0.0f, 1.0f);
    water_setup setup;
    facet_render_stats stats = {0};
    facet_error error;
    if (water_setup_create(shot_in(sea, s), f.scene, &s->desc, WATER_SETUP_ALL, &setup, &stats, &error) !=
        FACET_OK)
        fail_msg("%s", error.message);
    const image *around = &setup.cache->light->around->panorama;
    float d[3];
    vec3 found = vec3(0.0f);
    double closest = -1.0;
    for (uint32_t y = 0; y < around->height; y++)
        for (uint32_t x = 0; x < around->width; x++) {
            equirect_direction(around->width, around->height, (double)x, (double)y, d);
            double cosine = -sin((double)STEEP_RAD) * (double)d[1] - cos((double)STEEP_RAD) * (double)d[2];
            const float *texel = (const float *)around->pixels + 3 * ((size_t)y * around->width + x);
            if (cosine > closest)
                found = vec3(texel[0], texel[1], texel[2]), closest = cosine;
        }
    water_setup_destroy(&setup);
    water_cache_clear(&s->cache);
    fixture_destroy(&f);
    return found;
}

/* In even light. From higher up there is more foam to take the mean of, and more air. */
static void compare(const facet_sea_desc *d, float eye_m, double bound, const char *name)
{
    facet_sea *sea = make_sea(d);
    shot s;
    make_shot(&s, 64, 64, eye_m, STEEP_RAD);
    s.camera.fov_y_rad = 0.3f;
    assert_int_equal(facet_environment_create_constant(white, NULL, &s.desc.environment, NULL), FACET_OK);
    draw_shot(sea, &s);
    vec3 expected = mean_of(&s), seen = seen_by_model(sea, &s);
    for (int k = 0; k < 3; k++)
        if (!(fabs((double)(seen[k] / expected[k]) - 1.0) < bound))
            fail_msg("%s, channel %d: %g, not %g", name, k, (double)seen[k], (double)expected[k]);
    facet_environment_destroy(s.desc.environment);
    film_destroy(&s.film);
    sea_destroy(sea);
}

static void the_environment_of_a_model_matches_images_of_the_sea(void **state)
{
    (void)state;
    facet_sea_desc breeze = sea_default(), bed = sea_default(), gale = sea_default();
    breeze.wind_mps = 5.0f;
    bed.wind_mps = 3.0f;
    bed.bed = (facet_sea_bed){.depth_m = 3.0f, .albedo = {0.5f, 0.4f, 0.3f}};
    gale.wind_mps = 20.0f;
    breeze.resolution = bed.resolution = gale.resolution = 128;
    compare(&breeze, 10.0f, 0.03, "breeze");
    compare(&bed, 10.0f, 0.03, "bed");
    compare(&gale, 100.0f, 0.15, "gale");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_environment_of_a_model_matches_images_of_the_sea)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
