/* water_flat_test.c - still water, whose images have a closed form: F L_sky(mirror) + (1 - F) / n^2 L_u, the
 * sun as its own disc times F. And a closed box, in which rough water is as bright as all around it. */
#include "water/water_fixture.h"

#include "water/water_setup.h"

static facet_sea_desc still_sea(void)
{
    facet_sea_desc d = sea_default();
    d.wind_mps = 0.0f;
    d.resolution = 32;
    return d;
}

/* Fresnel reflectance of unpolarised light, in double. */
static double fresnel(double c, double n)
{
    double g = sqrt(n * n + c * c - 1.0), a = (g - c) / (g + c),
           b = (c * (g + c) - 1.0) / (c * (g - c) + 1.0);
    return 0.5 * a * a * (1.0 + b * b);
}

/* 2 int F mu dmu by the midpoint rule. */
static double diffuse_fresnel(double n)
{
    double sum = 0.0;
    for (int i = 0; i < 20000; i++) {
        double mu = (i + 0.5) / 20000.0;
        sum += 2.0 * fresnel(mu, n) * mu / 20000.0;
    }
    return sum;
}

/* What a pixel is to show; d its ray, unit. */
static vec3 expected_flat(const water_setup *s, const double d[3])
{
    const double R = 6360000.0, n = (double)s->water.ior, h = (double)s->camera.origin[1];
    double level2 = 1.0 - d[1] * d[1], a = level2 / (2.0 * R);
    double t = (-d[1] - sqrt(d[1] * d[1] - 4.0 * a * h)) / (2.0 * a); /* h + d_y t + a t^2 = 0 */
    double rise = d[1] + 2.0 * a * t, length = sqrt(level2 + rise * rise);
    double c = -rise / length, F = fresnel(c, n);
    vec3 mirror = vec3((float)(d[0] / length), (float)c, (float)(d[2] / length));
    vec3 sky = water_sky_reflected(&s->sky, mirror, 0.0f);
    double sun = (1.0 - fresnel((double)s->light.L[1], n)) * (double)s->light.L[1];
    double all = 1.0 - diffuse_fresnel(n);
    vec3 down = s->light.sun_irradiance * (float)sun + s->light.sky_irradiance * (float)all;
    vec3 below = s->water.reflectance * down * (float)(1.0 / (3.14159265358979323846 * 0.52 * n * n));
    water_air air = water_sky_air(&s->sky, vec3((float)d[0], (float)d[1], (float)d[2]), (float)t, 0.0f);
    return (sky * (float)F + below * (float)(1.0 - F)) * air.transmittance + air.light;
}

static void flat_water_has_the_closed_form(void **state)
{
    (void)state;
    facet_sea_desc d = still_sea();
    facet_sea *sea = make_sea(&d);
    shot s;
    make_shot(&s, 32, 48, 3.0f, 0.3f);
    s.desc.sky.sun_azimuth_rad = 0.3f; /* behind the eye: no disc in sight */
    draw_shot(sea, &s);
    water_setup setup;
    assert_int_equal(
        water_setup_create(shot_in(sea, &s), NULL, &s.desc, WATER_SETUP_ALL, &setup, &s.stats, NULL),
        FACET_OK);
    int seen = 0;
    for (uint32_t y = 0; y < 48; y++)
        for (uint32_t x = 0; x < 32; x++) {
            float o[3], f[3];
            camera_rays_at(&setup.camera, (float)x + 0.5f, (float)y + 0.5f, o, f);
            double length =
                sqrt((double)f[0] * (double)f[0] + (double)f[1] * (double)f[1] + (double)f[2] * (double)f[2]);
            double e[3] = {(double)f[0] / length, (double)f[1] / length, (double)f[2] / length};
            if (e[1] > -0.002)
                continue;
            vec3 expected = expected_flat(&setup, e);
            for (int i = 0; i < 3; i++) {
                double is = (double)shot_pixel(&s, x, y)[i], ought = (double)expected[i];
                if (fabs(is - ought) > 1e-4 * ought)
                    fail_msg("pixel %u, %u, channel %d: %g, not %g", x, y, i, is, ought);
            }
            seen++;
        }
    assert_in_range(seen, 700, 1500);
    water_setup_destroy(&setup);
    water_cache_clear(&s.cache);
    film_destroy(&s.film);
    sea_destroy(sea);
}

/* Of the sun's disc in still water: its middle is F times the disc, and all of it F times its light. */
static void still_water_reflects_the_suns_disc(void **state)
{
    (void)state;
    facet_sea_desc d = still_sea();
    facet_sea *sea = make_sea(&d);
    shot s;
    make_shot(&s, 65, 65, 3.0f, 0.7f);
    s.camera.fov_y_rad = 0.04f;
    s.desc.samples = 4;
    s.desc.sky.sun_azimuth_rad = 3.14159265f;
    draw_shot(sea, &s);
    water_setup setup;
    assert_int_equal(
        water_setup_create(shot_in(sea, &s), NULL, &s.desc, WATER_SETUP_ALL, &setup, &s.stats, NULL),
        FACET_OK);
    double F = fresnel(sin(0.7), (double)setup.water.ior);
    double E = (double)setup.light.sun_irradiance[1],
           disc = E / (3.14159265358979323846 * 0.00465305 * 0.00465305);
    double pixel = (double)setup.camera.pixel_size, flux = 0.0, around = (double)shot_pixel(&s, 0, 0)[1];
    for (uint32_t y = 0; y < 65; y++)
        for (uint32_t x = 0; x < 65; x++)
            flux += ((double)shot_pixel(&s, x, y)[1] - around) * pixel * pixel;
    double middle = (double)shot_pixel(&s, 32, 32)[1];
    assert_true(fabs(middle / (F * disc) - 1.0) < 0.02);
    assert_true(fabs(flux / (F * E) - 1.0) < 0.02);
    for (uint32_t y = 0; y < 65;
         y++) /* as large as the sun, and sharp: white is a hundred thousandth of it */
        for (uint32_t x = 0; x < 65; x++) {
            double radii = hypot((double)x - 32.0, (double)y - 32.0) * pixel / 0.00465305;
            double share = ((double)shot_pixel(&s, x, y)[1] - around) / (F * disc);
            assert_true(radii < 1.15 || fabs(share) < 1e-5);
            assert_true(radii > 0.85 || share > 0.98);
        }
    water_setup_destroy(&setup);
    water_cache_clear(&s.cache);
    film_destroy(&s.film);
    sea_destroy(sea);
}

/* A uniform sky of 1 and n^2 everywhere below: rough or smooth, water shows 1. */
static void a_closed_box_shows_one(void **state)
{
    (void)state;
    const float one[3] = {1.0f, 1.0f, 1.0f};
    static const float winds[] = {0.0f, 5.0f, 15.0f};
    for (int k = 0; k < 3; k++) {
        facet_sea_desc d = still_sea();
        d.wind_mps = winds[k];
        facet_sea *sea = make_sea(&d);
        shot s;
        make_shot(&s, 24, 48, 30.0f, 0.8f);
        s.camera.fov_y_rad = 1.5f;
        s.desc.sea_shading.omits_foam = true;
        assert_int_equal(facet_environment_create_constant(one, NULL, &s.desc.environment, NULL), FACET_OK);
        s.desc.camera = &s.camera;
        for (int i = 0; i < 3; i++)
            sea->optics.reflectance[i] = 1.0f;
        draw_shot(sea, &s);
        for (uint32_t i = 0; i < 24 * 48 * 4; i++)
            if (fabsf(s.film.layers[0].pixels[i] - 1.0f) > 0.01f)
                fail_msg("wind %g: pixel %u, %u shows %g", (double)winds[k], i / 4 % 24, i / 96,
                         (double)s.film.layers[0].pixels[i]);
        facet_environment_destroy(s.desc.environment);
        film_destroy(&s.film);
        sea_destroy(sea);
    }
}

/* A sky of 1 over water that absorbs nothing: 1 above it and n^2 below, over the depth and over a white
 * bed, whatever the index. */
static void water_that_absorbs_nothing_shows_its_sky(void **state)
{
    (void)state;
    const float one[3] = {1.0f, 1.0f, 1.0f};
    for (int k = 0; k < 8; k++) {
        facet_sea_desc d = still_sea();
        bool is_below = k & 1, has_bed = k & 2;
        d.wind_mps = 6.0f;
        d.water = (facet_water){.kind = FACET_WATER_KIND_COEFFICIENTS,
                                .scattering = {0.1f, 0.2f, 0.3f},
                                .backscattering = {0.005f, 0.01f, 0.1f},
                                .ior = k & 4 ? 1.0f : 1.34f,
                                .foam_albedo = 0.4f};
        if (has_bed)
            d.bed = (facet_sea_bed){.depth_m = 4.0f, .albedo = {1.0f, 1.0f, 1.0f}};
        facet_sea *sea = make_sea(&d);
        shot s;
        make_shot(&s, 12, 24, 3.0f, 0.8f);
        s.camera.fov_y_rad = 1.5f;
        if (is_below)
            s.camera.eye[1] = -2.0f, s.camera.target[1] = -1.9f;
        s.desc.sea_shading.omits_foam = !is_below;
        assert_int_equal(facet_environment_create_constant(one, NULL, &s.desc.environment, NULL), FACET_OK);
        draw_shot(sea, &s);
        float expected = is_below ? sea->optics.ior * sea->optics.ior : 1.0f;
        for (uint32_t i = 0; i < 12 * 24 * 4; i++)
            if (i % 4 < 3 && fabsf(s.film.layers[0].pixels[i] / expected - 1.0f) > 2e-3f)
                fail_msg("case %d: pixel %u, %u shows %g, not %g", k, i / 4 % 12, i / 48,
                         (double)s.film.layers[0].pixels[i], (double)expected);
        facet_environment_destroy(s.desc.environment);
        film_destroy(&s.film);
        sea_destroy(sea);
    }
}

/* Without light there is none. */
static void without_light_all_is_black(void **state)
{
    (void)state;
    const float black[3] = {0.0f, 0.0f, 0.0f};
    facet_sea_desc d = still_sea();
    d.wind_mps = 10.0f;
    facet_sea *sea = make_sea(&d);
    shot s;
    make_shot(&s, 16, 16, 3.0f, 0.2f);
    assert_int_equal(facet_environment_create_constant(black, NULL, &s.desc.environment, NULL), FACET_OK);
    draw_shot(sea, &s);
    for (uint32_t i = 0; i < 16 * 16; i++)
        for (uint32_t c = 0; c < 3; c++)
            assert_true(s.film.layers[0].pixels[4 * i + c] == 0.0f);
    facet_environment_destroy(s.desc.environment);
    film_destroy(&s.film);
    sea_destroy(sea);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(flat_water_has_the_closed_form),
        cmocka_unit_test(still_water_reflects_the_suns_disc),
        cmocka_unit_test(a_closed_box_shows_one),
        cmocka_unit_test(water_that_absorbs_nothing_shows_its_sky),
        cmocka_unit_test(without_light_all_is_black),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
