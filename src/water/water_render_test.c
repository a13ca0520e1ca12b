/* water_render_test.c - images of rough seas: all values are finite whatever the camera, water and
 * weather; threads and parts make no difference; limits; the profile finds what marching finds. */
#include "water/water_fixture.h"

#include "film/meter.h"
#include "water/water_setup.h"

static facet_sea_desc small_sea(float wind)
{
    facet_sea_desc d = sea_default();
    d.wind_mps = wind;
    d.resolution = 64;
    return d;
}

/* ---- edge cases ---- */

typedef struct edge_case {
    const char *name;
    float wind, choppiness, depth_m, bed_slope, eye_m, down_rad, sun_rad;
    bool is_on_surface, is_parallel;
} edge_case;

static const edge_case edge_cases[] = {
    {"grazing", 10, 1, 0, 0, 1.5f, 0.0f, 0.3f, false, false},
    {"sun on the horizon", 10, 1, 0, 0, 3, 0.1f, 0.0f, false, false},
    {"sun below the horizon", 10, 1, 0, 0, 3, 0.1f, -0.2f, false, false},
    {"midnight", 10, 1, 0, 0, 3, 0.1f, -1.5f, false, false},
    {"sun in the zenith", 5, 1, 0, 0, 3, 0.1f, 1.5707f, false, false},
    {"from 10 km", 10, 1, 0, 0, 10000, 0.5f, 0.5f, false, false},
    {"no wind", 0, 1, 0, 0, 3, 0.1f, 0.5f, false, false},
    {"storm", 30, 1, 0, 0, 10, 0.2f, 0.5f, false, false},
    {"sines", 10, 0, 0, 0, 3, 0.2f, 0.5f, false, false},
    {"folded", 15, 2, 0, 0, 4, 0.2f, 0.5f, false, false},
    {"shallow", 5, 1, 0.02f, 0, 2, 0.4f, 0.5f, false, false},
    {"shallower than its waves", 15, 1, 0.5f, 0, 3, 0.3f, 0.5f, false, false},
    {"beach", 5, 1, 1.0f, 0.1f, 2, 0.2f, 0.5f, false, false},
    {"on the surface", 10, 1, 0, 0, 0, 0.1f, 0.5f, true, false},
    {"straight down", 10, 1, 0, 0, 10, 1.5707f, 0.5f, false, false},
    {"straight up", 10, 1, 0, 0, 10, -1.5707f, 0.5f, false, false},
    {"under water, up", 5, 1, 0, 0, -3, -0.8f, 0.9f, false, false},
    {"under water, level", 5, 1, 0, 0, -3, 0.0f, 0.9f, false, false},
    {"under water, down to a bed", 5, 1, 8, 0, -3, 0.7f, 0.9f, false, false},
    {"just under water", 10, 1, 0, 0, -2.5f, -0.1f, 0.2f, false, false},
    {"parallel rays", 10, 1, 0, 0, 50, 0.6f, 0.5f, false, true},
};

/* Those after this one are lit by three colors and a sun, which takes a fifth of the time that a sky does. */
enum { LAST_OF_SKY = 6 };

static void light_by_environment(shot *s)
{
    static const float zenith[3] = {1000.0f, 2000.0f, 4000.0f}, horizon[3] = {5000.0f, 5500.0f, 6000.0f};
    static const float nadir[3] = {100.0f, 100.0f, 100.0f};
    facet_render_desc *r = &s->desc;
    assert_int_equal(facet_environment_create_gradient(zenith, horizon, nadir, NULL, &r->environment, NULL),
                     FACET_OK);
    r->sun = (facet_sun){.azimuth_rad = s->desc.sky.sun_azimuth_rad,
                         .elevation_rad = s->desc.sky.sun_elevation_rad,
                         .illuminance_lux = {1e5f, 9e4f, 8e4f}};
}

static void extreme_seas_are_finite(void **state)
{
    (void)state;
    for (size_t i = 0; i < sizeof edge_cases / sizeof *edge_cases; i++) {
        const edge_case *e = &edge_cases[i];
        facet_sea_desc d = small_sea(e->wind);
        d.choppiness = e->choppiness;
        d.bed = (facet_sea_bed){.depth_m = e->depth_m, .slope = e->bed_slope, .albedo = {0.5f, 0.5f, 0.4f}};
        d.bed.direction_rad = 1.0f;
        facet_sea *sea = make_sea(&d);
        shot s;
        float eye = e->is_on_surface ? waves_height(&sea->waves, 0.0, 0.0, 0.0f) : e->eye_m;
        make_shot(&s, 28, 20, eye, e->down_rad);
        s.desc.sky.sun_elevation_rad = e->sun_rad;
        if (i > LAST_OF_SKY)
            light_by_environment(&s);
        if (e->is_parallel) {
            s.camera.fov_y_rad = 0.0f;
            s.camera.ortho_height = 60.0f;
        }
        draw_shot(sea, &s);
        float largest = scan_shot(&s, e->name);
        assert_true(largest > 0.0f || e->sun_rad < -1.0f);
        assert_true(largest < 2.1e9f); /* the sun outside of the air */
        facet_environment_destroy(s.desc.environment);
        film_destroy(&s.film);
        sea_destroy(sea);
    }
}

/* ---- the same bytes ---- */

static void threads_change_no_byte(void **state)
{
    (void)state;
    facet_sea_desc d = small_sea(8.0f);
    facet_sea *sea = make_sea(&d);
    shot one, three;
    make_shot(&one, 50, 70, 3.0f, 0.1f);
    make_shot(&three, 50, 70, 3.0f, 0.1f);
    light_by_environment(&one);
    light_by_environment(&three);
    one.desc.thread_count = 1;
    three.desc.thread_count = 3;
    draw_shot(sea, &one);
    draw_shot(sea, &three);
    assert_memory_equal(one.film.layers[0].pixels, three.film.layers[0].pixels, 50 * 70 * 4 * sizeof(float));
    const uint32_t part[4] = {11, 30, 20, 35};
    memcpy(three.desc.crop, part, sizeof part);
    draw_shot(sea, &three);
    for (uint32_t y = 0; y < part[3]; y++)
        assert_memory_equal(shot_pixel(&three, 0, y), shot_pixel(&one, part[0], part[1] + y),
                            part[2] * 4 * sizeof(float));
    facet_environment_destroy(one.desc.environment);
    facet_environment_destroy(three.desc.environment);
    film_destroy(&one.film);
    film_destroy(&three.film);
    sea_destroy(sea);
}

/* ---- limits ---- */

static bool cancel(void *user, const char *stage, double fraction)
{
    (void)user;
    (void)stage;
    (void)fraction;
    return false;
}

static void limits_and_cancelling_are_reported(void **state)
{
    (void)state;
    facet_sea_desc d = small_sea(8.0f);
    facet_sea *sea = make_sea(&d);
    shot s;
    facet_error error;
    make_shot(&s, 24, 24, 3.0f, 0.1f);
    s.desc.time_limit_s = 1e-6;
    assert_int_equal(try_shot(sea, &s, &error), FACET_ERROR_LIMIT);
    s.desc.time_limit_s = 0.0;
    s.desc.progress.report = cancel;
    assert_int_equal(try_shot(sea, &s, &error), FACET_ERROR_CANCELLED);
    s.desc.progress.report = NULL;
    s.desc.sky.turbidity = 0.5f;
    assert_int_equal(try_shot(sea, &s, &error), FACET_ERROR_ARGUMENT);
    assert_non_null(strstr(error.message, "turbidity"));
    film_destroy(&s.film);
    sea_destroy(sea);
}

/* ---- profile and march ---- */

static march_ray ray_of(const camera_rays *c, float x, float y)
{
    float o[3], d[3];
    camera_rays_at(c, x, y, o, d);
    double length =
        sqrt((double)d[0] * (double)d[0] + (double)d[1] * (double)d[1] + (double)d[2] * (double)d[2]);
    march_ray ray = {.near_m = 0.0, .far_m = 1e7, .spread = c->pixel_size / (float)length};
    for (int i = 0; i < 3; i++) {
        ray.origin[i] = (double)o[i];
        ray.direction[i] = (double)d[i] / length;
    }
    return ray;
}

/* Rays that are found by bisection of a profile end where rays end that march, but for those that pass a
 * crest by less than a pixel; and nowhere under water or over it by more than some of a pixel. */
static void profiles_find_the_hits_of_marching(void **state)
{
    (void)state;
    facet_sea_desc d = small_sea(10.0f);
    facet_sea *sea = make_sea(&d);
    facet_camera camera = {.eye = {3.0f, 4.0f, 5.0f}, .target = {40.0f, 0.0f, 60.0f}, .fov_y_rad = 0.8f};
    camera_rays rays;
    assert_int_equal(camera_rays_create(&camera, 240, 160, &rays, NULL), FACET_OK);
    water_march march = water_march_of(&sea->waves, &sea->slopes, true);
    const uint32_t part[4] = {0, 0, 240, 160};
    water_profile profile;
    assert_int_equal(water_profile_create(&march, &rays, part, false, 2, NULL, &profile, NULL), FACET_OK);
    assert_non_null(profile.tangents);
    int count = 0, apart = 0, off = 0;
    for (uint32_t y = 2; y < 160; y += 5)
        for (uint32_t x = 3; x < 240; x += 7) {
            march_ray ray = ray_of(&rays, (float)x, (float)y);
            march_hit fast = {.t = 0.0}, slow = {.t = 0.0};
            bool is_fast = water_profile_find(&profile, &ray, &fast),
                 is_slow = water_march_find(&march, &ray, &slow);
            count++;
            apart += is_fast != is_slow || (is_fast && fabs(fast.t - slow.t) > 0.05 * slow.t);
            if (is_fast) {
                double f;
                water_march_hit_at(&march, &ray, fast.t, fast.displacement, &f);
                off += fabs(f) > 0.5 * (double)fast.width_m;
            }
        }
    assert_true(count > 1000);
    assert_true(apart < count / 25);
    assert_true(off < count / 25);
    water_profile_destroy(&profile);
    sea_destroy(sea);
}

/* With the near plane near_m away along each ray. Returns how many of the rays that hit nearer water find none. */
static int cut_rays(const facet_sea *sea, float eye_m, float down_rad, double near_m)
{
    shot s;
    make_shot(&s, 240, 160, eye_m, down_rad);
    camera_rays rays;
    assert_int_equal(camera_rays_create(&s.camera, 240, 160, &rays, NULL), FACET_OK);
    water_march march = water_march_of(&sea->waves, &sea->slopes, true);
    const uint32_t part[4] = {0, 0, 240, 160};
    water_profile profile;
    assert_int_equal(water_profile_create(&march, &rays, part, eye_m < 0.0f, 2, NULL, &profile, NULL),
                     FACET_OK);
    int open = 0;
    for (uint32_t i = 0; i < 24 * 16; i++) {
        march_ray ray = ray_of(&rays, (float)(i % 24 * 10), (float)(i / 24 * 10));
        ray.is_below = eye_m < 0.0f;
        march_hit whole = {.t = 0.0}, hit = {.t = 0.0};
        bool is_whole = water_profile_find(&profile, &ray, &whole);
        ray.near_m = near_m;
        bool is_met = water_profile_find(&profile, &ray, &hit);
        double f, before;
        if (is_whole && whole.t > near_m * 1.01)
            assert_true(is_met && hit.t == whole.t);
        else if (is_met) {
            assert_true(hit.t > near_m * 0.99);
            water_march_hit_at(&march, &ray, hit.t, hit.displacement, &f);
            water_march_hit_at(&march, &ray, hit.t - 4.0 * (double)hit.width_m, hit.displacement, &before);
            assert_true(fabs(f) < (double)hit.width_m && before > f);
        }
        open += is_whole && !is_met;
    }
    water_profile_destroy(&profile);
    return open;
}

/* Water nearer than the near plane is not seen, nor is its inside: rays go on to the next wave. */
static void the_near_plane_cuts_water_off(void **state)
{
    (void)state;
    for (int i = 0; i < 2; i++) {
        facet_sea_desc d = small_sea(i ? 10.0f : 0.0f);
        facet_sea *sea = make_sea(&d);
        assert_true(cut_rays(sea, 4.0f, 0.3f, 12.0) > 100);
        assert_true(cut_rays(sea, -4.0f, -0.3f, 12.0) > 100);
        assert_int_equal(cut_rays(sea, 4.0f, 0.3f, 0.5), 0);
        water_march march = water_march_of(&sea->waves, &sea->slopes, false);
        march_ray parallel = {.origin = {0.0, -5.0, 0.0}, .direction = {0.8, -0.6, 0.0}, .far_m = 1e7};
        march_hit hit;
        assert_false(water_march_find(&march, &parallel, &hit)); /* the eye is above the water */
        sea_destroy(sea);
    }
}

/* ---- exposure ---- */

/* Light on level water by a sun 20 degrees high in a clear sky: E = 75 730 sin 20 + 9 500 = 35 400 lx. */
static void level_water_has_the_illuminance_of_a_clear_sky(void **state)
{
    (void)state;
    shot s;
    make_shot(&s, 8, 8, 3.0f, 0.1f);
    s.desc.sky.sun_elevation_rad = 0.34906585f;
    water_sky sky;
    assert_int_equal(water_sky_create(&s.desc, 0.0f, 1.0f, &sky, NULL), FACET_OK);
    vec3 E = sky.sun_irradiance * sky.L[1] + sky.sky_irradiance;
    water_sky_destroy(&sky);
    assert_true(fabs((double)luminance(E) / 35400.0 - 1.0) < 0.035);
}

static unsigned warning_count;

static void count_warning(void *user, facet_log_level level, const char *words)
{
    (void)user, (void)words;
    warning_count += level == FACET_LOG_LEVEL_WARNING;
}

static double metered(const facet_sea *sea, const facet_render_desc *desc)
{
    double ev100 = 0.0;
    facet_render_desc in_sea = *desc;
    water_cache cache = {.sea_serial = 0};
    in_sea.sea = sea;
    assert_int_equal(water_meter(&cache, &in_sea, &ev100, NULL), FACET_OK);
    water_cache_clear(&cache);
    return ev100;
}

/* As metered, the log-average of an image is 0.22; light, not the image's size, part or samples, is
 * what a meter reads. */
static void the_meter_measures_light_only(void **state)
{
    (void)state;
    facet_sea_desc desc = small_sea(6.0f);
    facet_sea *sea = make_sea(&desc);
    shot s;
    make_shot(&s, 96, 64, 3.0f, 0.1f);
    s.desc.camera = &s.camera;
    s.desc.sea_shading.omits_glints = true;
    double day = metered(sea, &s.desc), sum = 0.0;
    s.desc.exposure_ev = (float)meter_exposure_ev(day);
    draw_shot(sea, &s);
    for (uint32_t i = 0; i < 96 * 64; i++) {
        const float *p = shot_pixel(&s, i % 96, i / 96);
        sum += log((double)luminance(vec3(p[0], p[1], p[2]))) / (96 * 64);
    }
    film_destroy(&s.film);
    assert_true(fabs(exp(sum) / 0.22 - 1.0) < 0.04);
    s.desc.samples = 7;
    s.desc.crop[0] = 20;
    s.desc.crop[2] = 8;
    assert_true(metered(sea, &s.desc) == day);
    s.desc.log.message = count_warning;
    s.desc.sky.sun_elevation_rad = -0.07f;
    double dusk = metered(sea, &s.desc);
    assert_true(dusk < day - 3.0 && warning_count == 0);
    s.desc.sky.sun_elevation_rad = -1.5f;
    assert_true(fabs(metered(sea, &s.desc) - log2(1e-3 / 0.264)) < 1e-6);
    assert_int_equal(warning_count, 1);
    assert_true(fabs(exp2(meter_exposure_ev(15.0)) * 1.2 * 32768.0 - 1.0) < 1e-12);
    sea_destroy(sea);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(extreme_seas_are_finite),
        cmocka_unit_test(threads_change_no_byte),
        cmocka_unit_test(limits_and_cancelling_are_reported),
        cmocka_unit_test(profiles_find_the_hits_of_marching),
        cmocka_unit_test(the_near_plane_cuts_water_off),
        cmocka_unit_test(level_water_has_the_illuminance_of_a_clear_sky),
        cmocka_unit_test(the_meter_measures_light_only),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
