/* ocean_api_test.c - the sea, through the public headers only. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "api/image_layer.h"
#include "facet/facet.h"

#include "tests/support/support.h"

#define PI 3.14159265358979

static facet_error failure;

static void done(facet_result result)
{
    if (result != FACET_OK)
        fail_msg("%s", failure.message);
}

/* Small and quick, with wind. */
static facet_sea_desc small(void)
{
    facet_sea_desc d = facet_sea_default();
    d.resolution = 64;
    d.cascade_count = 2;
    d.thread_count = 1;
    return d;
}

static facet_sea *make(const facet_sea_desc *desc)
{
    facet_sea *sea = NULL;
    done(facet_sea_create(desc, &sea, &failure));
    return sea;
}

static facet_sea_render_desc small_image(void)
{
    return (facet_sea_render_desc){.render = {.width = 24, .height = 16, .samples = 1, .thread_count = 1},
                                   .sky = {.sun_elevation_rad = 0.5f}};
}

static void presets_are_seas(void **state)
{
    (void)state;
    /* significant height, m, and peak, s, computed independently; 0: none */
    static const struct {
        const char *name;
        double height, period;
    } expected[] = {{"breeze", 0.561, 3.21}, {"trade-wind", 2.244, 6.42}, {"gale", 8.978, 12.83}};
    size_t found = 0;
    assert_int_equal(facet_sea_get_preset_count(), 6);
    assert_null(facet_sea_get_preset_name(6));
    for (uint32_t i = 0; i < facet_sea_get_preset_count(); i++) {
        facet_sea_desc d;
        const char *name = facet_sea_get_preset_name(i);
        done(facet_sea_preset(name, &d, &failure));
        d.resolution = 64;
        facet_sea *sea = make(&d);
        facet_sea_info info = facet_sea_get_info(sea);
        assert_true(info.height_m > 0.0 && info.ior > 1.3 && info.tile_count == d.cascade_count);
        for (size_t k = 0; k < sizeof expected / sizeof *expected; k++)
            if (strcmp(expected[k].name, name) == 0) {
                assert_true(fabs(info.height_m / expected[k].height - 1.0) < 0.01);
                assert_true(fabs(info.peak_period_s / expected[k].period - 1.0) < 0.01);
                found++;
            }
        facet_sea_destroy(sea);
    }
    assert_int_equal(found, 3);
    facet_sea_desc d;
    assert_int_equal(facet_sea_preset("pond", &d, &failure), FACET_ERROR_ARGUMENT);
    assert_non_null(strstr(failure.message, "trade-wind"));
}

/* Slopes along a wind that blows somewhere else, and where the peak is a swell's. */
static void info_follows_wind_and_swell(void **state)
{
    (void)state;
    facet_sea_desc d = small();
    facet_sea *sea = make(&d);
    facet_sea_info east = facet_sea_get_info(sea);
    facet_sea_destroy(sea);
    d.wind_direction_rad = 2.0f;
    sea = make(&d);
    facet_sea_info other = facet_sea_get_info(sea);
    facet_sea_destroy(sea);
    assert_true(east.slope_variance[0] > 1.2 * east.slope_variance[1]);
    for (int i = 0; i < 2; i++) {
        assert_true(fabs(other.slope_variance[i] / east.slope_variance[i] - 1.0) < 1e-3);
        assert_true(east.resolved_slope_variance[i] > 0.0 &&
                    east.resolved_slope_variance[i] < east.slope_variance[i]);
    }
    assert_true(fabs(east.slope_variance[0] + east.slope_variance[1] - 0.0542) < 1e-3); /* Cox and Munk */
    d.wind_mps = 3.0f;
    d.swell = (facet_swell){.height_m = 2.0f, .period_s = 12.0f};
    sea = make(&d);
    facet_sea_info swell = facet_sea_get_info(sea);
    facet_sea_destroy(sea);
    assert_true(fabs(swell.peak_period_s - 12.0) < 0.01 && fabs(swell.peak_length_m / 224.8 - 1.0) < 0.01);
    assert_true(fabs(swell.height_m - hypot(2.0, 0.202)) < 0.02);
    d.wind_mps = 0.0f;
    d.swell.height_m = 0.0f;
    sea = make(&d);
    facet_sea_info flat = facet_sea_get_info(sea);
    facet_sea_destroy(sea);
    assert_true(flat.height_m == 0.0 && flat.peak_period_s == 0.0 && flat.tile_count == 0);
}

/* A wave of one length: height, velocity and normal as the formula has them, and all points at once as one
 * by one. */
static void points_move_as_waves_do(void **state)
{
    (void)state;
    enum { COUNT = 100 };
    facet_sea_desc d = small();
    d.thread_count = 2;
    facet_sea *sea = make(&d);
    double places[COUNT][2];
    facet_sea_point now[COUNT], before[COUNT], after[COUNT];
    for (int i = 0; i < COUNT; i++) {
        places[i][0] = 37.0 * i - 1000.0;
        places[i][1] = 11.0 * i * i;
    }
    double dt = 0.005, mean = 0.0, height = 0.0;
    done(facet_sea_set_time(sea, 7.0 - dt, &failure));
    facet_sea_get_points(sea, places[0], COUNT, before);
    done(facet_sea_set_time(sea, 7.0 + dt, &failure));
    facet_sea_get_points(sea, places[0], COUNT, after);
    done(facet_sea_set_time(sea, 7.0, &failure));
    facet_sea_get_points(sea, places[0], COUNT, now);
    for (int i = 0; i < COUNT; i++) {
        facet_sea_point one;
        facet_sea_get_points(sea, places[i], 1, &one);
        assert_memory_equal(&one, &now[i], sizeof one);
        const float *n = now[i].normal;
        assert_true(fabsf(n[0] * n[0] + n[1] * n[1] + n[2] * n[2] - 1.0f) < 1e-4f && n[1] > 0.0f);
        assert_true(now[i].jacobian > -1.0f && now[i].jacobian < 4.0f);
        height += (double)now[i].height_m * (double)now[i].height_m / COUNT;
        /* the surface above a place rises as its water does, but for what flows by along the slope */
        double rise = ((double)after[i].height_m - (double)before[i].height_m) / (2.0 * dt);
        mean += fabs(rise - (double)now[i].velocity_mps) / COUNT;
    }
    assert_true(fabs(4.0 * sqrt(height) / 2.244 - 1.0) < 0.35);
    assert_true(mean < 0.15); /* velocities are 0.55 m/s, flow along slopes a fifth of that */
    assert_int_equal(facet_sea_set_time(sea, (double)NAN, &failure), FACET_ERROR_ARGUMENT);
    facet_sea_destroy(sea);
}

/* Variances of the maps are those of the spectrum; the foam's mean is what info says. */
static void maps_hold_the_tiles(void **state)
{
    (void)state;
    facet_sea_desc d = facet_sea_default();
    d.resolution = 128;
    facet_sea *sea = make(&d);
    facet_sea_info info = facet_sea_get_info(sea);
    double variance = 0.0, slopes = 0.0, jacobian = 0.0;
    for (uint32_t tile = 0; tile < info.tile_count; tile++) {
        facet_image *maps = NULL;
        done(facet_sea_create_maps(sea, tile, NULL, &maps, &failure));
        const float *p = layer_of(maps, "", 4), *s = layer_of(maps, "slope", 2);
        const float *n = layer_of(maps, "normal", 3), *j = layer_of(maps, "jacobian", 1);
        const float *f = layer_of(maps, "foam", 1);
        size_t count = (size_t)d.resolution * d.resolution;
        double foam = 0.0;
        for (size_t i = 0; i < count; i++) {
            variance += (double)p[4 * i + 1] * (double)p[4 * i + 1] / (double)count;
            slopes += ((double)s[2 * i] * (double)s[2 * i] + (double)s[2 * i + 1] * (double)s[2 * i + 1]) /
                      (double)count;
            jacobian += (double)j[i] / (double)count / info.tile_count;
            foam += (double)f[i] * (double)j[i] / (double)count;
            assert_true(fabsf(n[3 * i] * n[3 * i] + n[3 * i + 1] * n[3 * i + 1] +
                              n[3 * i + 2] * n[3 * i + 2] - 1.0f) < 1e-4f);
            assert_true(f[i] >= 0.0f && f[i] <= 1.0f && p[4 * i + 3] == 1.0f);
        }
        assert_true(foam > 0.5 * info.foam_coverage && foam < 1.5 * info.foam_coverage);
        facet_image_destroy(maps);
    }
    assert_true(fabs(4.0 * sqrt(variance) / info.height_m - 1.0) < 0.2); /* of one seed; 5 % are usual */
    double resolved = info.resolved_slope_variance[0] + info.resolved_slope_variance[1];
    assert_true(fabs(slopes / resolved - 1.0) < 0.1);
    assert_true(fabs(jacobian - 1.0) < 1e-3);
    facet_image *none = NULL;
    assert_int_equal(facet_sea_create_maps(sea, info.tile_count, NULL, &none, &failure),
                     FACET_ERROR_ARGUMENT);
    assert_null(none);
    facet_sea_destroy(sea);
}

/* The mesh is the surface, its material the water; a file holds both. */
static void mesh_is_the_surface(void **state)
{
    (void)state;
    facet_sea_desc d = small();
    facet_sea *sea = make(&d);
    facet_scene *scene = NULL;
    const facet_sea_mesh_desc desc = {.size_m = 40.0f, .samples = 33, .center_m = {100.0, 50.0}};
    done(facet_sea_create_mesh(sea, &desc, &scene, &failure));
    facet_scene_counts counts = facet_scene_get_counts(scene);
    assert_int_equal(counts.triangles, 2 * 32 * 32 + 2);
    assert_int_equal(counts.materials, 2);
    float low[3], high[3];
    assert_true(facet_scene_get_bounds(scene, NULL, low, high));
    assert_true(low[0] > 75.0f && high[0] < 125.0f && low[2] > 25.0f && high[2] < 75.0f && high[1] < 3.0f);
    char *text = NULL;
    done(facet_scene_describe_json(scene, &text, &failure));
    assert_non_null(strstr(text, "deep water"));
    facet_text_destroy(text);
    facet_scene_destroy(scene);
    d.bed = (facet_sea_bed){.depth_m = 4.0f, .slope = 0.05f, .albedo = {0.4f, 0.3f, 0.2f}};
    facet_sea_destroy(sea);
    sea = make(&d);
    done(facet_sea_create_mesh(sea, &(facet_sea_mesh_desc){.size_m = 40.0f, .samples = 2}, &scene, &failure));
    assert_true(facet_scene_get_bounds(scene, NULL, low, high));
    assert_true(fabsf(low[1] + 5.0f) < 1e-3f); /* 4 m and 20 m down the slope */
    facet_scene_destroy(scene);
    static const facet_sea_mesh_desc wrong[] = {
        {.size_m = -1.0f}, {.samples = 1}, {.samples = 5000}, {.refinement = 0.5f}, {.size_m = (float)NAN}};
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        assert_int_equal(facet_sea_create_mesh(sea, &wrong[i], &scene, &failure), FACET_ERROR_ARGUMENT);
        assert_null(scene);
    }
    facet_sea_destroy(sea);
}

static double brightness(const facet_image *image)
{
    facet_image_view v = facet_image_get_layer(image, 0);
    double sum = 0.0;
    for (size_t i = 0; i < (size_t)v.width * v.height; i++)
        for (int c = 0; c < 3; c++) {
            assert_true(isfinite(v.pixels[4 * i + (size_t)c]));
            sum += (double)v.pixels[4 * i + (size_t)c] / (3.0 * v.width * v.height);
        }
    return sum;
}

static void images_are_exposed(void **state)
{
    (void)state;
    facet_sea_desc desc = small();
    facet_sea *sea = make(&desc);
    facet_sea_render_desc d = small_image();
    double ev100 = 0.0, night = 0.0;
    done(facet_sea_meter(sea, &d, &ev100, &failure));
    assert_true(ev100 > 12.0 && ev100 < 16.0); /* a sunny day */
    assert_true(fabs((double)facet_exposure_from_ev100(ev100) + ev100 + log2(1.2)) < 1e-5);
    d.render.exposure_ev = facet_exposure_from_ev100(ev100);
    const facet_camera camera = facet_sea_camera(sea, 0.0f, 2.0f); /* not into the sun's glitter */
    d.render.camera = &camera;
    facet_image *image = NULL, *again = NULL;
    done(facet_sea_render(sea, NULL, &d, &image, &failure));
    double mean = brightness(image);
    assert_true(mean > 0.02 && mean < 1.0);
    d.render.thread_count = 3;
    done(facet_sea_render(sea, NULL, &d, &again, &failure));
    facet_image_view a = facet_image_get_layer(image, 0), b = facet_image_get_layer(again, 0);
    assert_memory_equal(a.pixels, b.pixels, sizeof(float) * 4 * a.width * a.height);
    facet_image_destroy(image);
    facet_image_destroy(again);
    d.sky.sun_elevation_rad = -0.6f;
    done(facet_sea_meter(sea, &d, &night, &failure));
    assert_true(night < 0.0);
    facet_sea_destroy(sea);
}

/* Nothing that is said of a sea is said in words: numbers far away and no numbers at all have answers. */
static void numbers_far_away_are_answered(void **state)
{
    (void)state;
    facet_sea_desc desc = small();
    facet_sea *sea = make(&desc);
    const double far_away[] = {(double)NAN, 0.0, 0.0, (double)INFINITY, -1.7e308, 1.7e308, 1e9, -1e15};
    facet_sea_point points[4];
    facet_sea_get_points(sea, far_away, 4, points);
    for (int i = 0; i < 4; i++)
        assert_true(isfinite(points[i].height_m) && isfinite(points[i].velocity_mps) &&
                    isfinite(points[i].jacobian) && isfinite(points[i].normal[1]));
    assert_true(isfinite(facet_sea_camera(sea, NAN, NAN).eye[1]));
    facet_sea_render_desc d = small_image();
    d.render.samples = 1;
    const facet_camera camera = {.eye = {1e9f, 3.0f, 1e9f}, .target = {1e9f, 0.0f, 2e9f}, .fov_y_rad = 0.6f};
    for (int i = 0; i < 3; i++) {
        facet_image *image = NULL;
        done(facet_sea_set_time(sea, i == 0 ? 1e300 : i == 1 ? -1e9 : 0.0, &failure));
        d.render.camera = i == 2 ? &camera : NULL;
        done(facet_sea_render(sea, NULL, &d, &image, &failure));
        assert_true(brightness(image) >= 0.0);
        facet_image_destroy(image);
    }
    facet_sea_destroy(sea);
    desc.loop_s = 0.1;
    sea = make(&desc);
    static const double ages[] = {1e300, -1.7e308, 1e15, -1e-300};
    for (int i = 0; i < 4; i++) {
        done(facet_sea_set_time(sea, ages[i], &failure));
        facet_sea_get_points(sea, far_away + 1, 1, points);
        assert_true(isfinite(points[0].height_m) && points[0].velocity_mps > -1e3f &&
                    points[0].velocity_mps < 1e3f);
    }
    facet_sea_destroy(sea);
}

/* Still, fresh, pure water; and a loop of 2.4 s closes though no float is 2.4. */
static void zero_is_a_sea(void **state)
{
    (void)state;
    const facet_sea_desc zero = {0};
    facet_sea *sea = make(&zero);
    facet_sea_info info = facet_sea_get_info(sea);
    assert_true(info.height_m == 0.0 && info.tile_count == 0 && info.ior > 1.33 && info.ior < 1.34);
    facet_sea_destroy(sea);
    facet_sea_desc desc = small();
    desc.loop_s = 2.4;
    sea = make(&desc);
    const double origin[2] = {3.0, 4.0};
    facet_sea_point before, after;
    facet_sea_get_points(sea, origin, 1, &before);
    for (int i = 0; i < 3; i++) { /* away from there, there, and there again */
        static const double times[3] = {0.9, 2.4, 4.8};
        done(facet_sea_set_time(sea, times[i], &failure));
        facet_sea_get_points(sea, origin, 1, &after);
        assert_true((memcmp(&before, &after, sizeof before) == 0) == (i > 0));
    }
    facet_sea_destroy(sea);
}

static void what_is_wrong_is_said(void **state)
{
    (void)state;
    facet_sea_desc desc = small();
    facet_sea *sea = make(&desc);
    facet_image *image = NULL;
    double ev100 = 0.0;
    for (int i = 0; i < 9; i++) {
        facet_sea_render_desc d = small_image();
        if (i == 0)
            d.shading.stage = 6;
        if (i == 1)
            d.shading.perceptual_roughness = 2.0f;
        if (i == 2)
            d.shading.clamp = -1.0f;
        if (i == 3)
            d.render.renderer = (facet_renderer_kind)9;
        if (i == 4)
            d.render.crop[2] = 100, d.render.crop[3] = 100;
        if (i == 5)
            d.shading.style = (facet_sea_style)9;
        if (i == 6)
            d.render.renderer = FACET_RENDERER_KIND_PATH, d.shading.style = FACET_SEA_STYLE_LEGACY_INTENDED;
        if (i == 7)
            d.render.environment_ev = INFINITY;
        if (i == 8)
            d.render.sun.illuminance_lux[0] = NAN;
        assert_int_equal(facet_sea_meter(sea, &d, &ev100, &failure), FACET_ERROR_ARGUMENT);
        assert_int_equal(facet_sea_render(sea, NULL, &d, &image, &failure), FACET_ERROR_ARGUMENT);
        assert_null(image);
        assert_true(strlen(failure.message) > 10);
    }
    desc.wind_mps = 50.0f;
    facet_sea *none = NULL;
    assert_int_equal(facet_sea_preset(NULL, &desc, &failure), FACET_ERROR_ARGUMENT);
    assert_int_equal(facet_sea_create(&desc, &none, &failure), FACET_ERROR_ARGUMENT);
    assert_null(none);
    facet_sea_destroy(sea);
}

static void stand_in(const facet_camera *c, float height)
{
    assert_true(c->eye[0] == 0.0f && c->eye[2] == 0.0f && c->target[1] < c->eye[1]);
    assert_true(fabsf(c->eye[1] - height) < 1e-4f);
}

static void eyes_stay_above_the_water(void **state)
{
    (void)state;
    facet_sea_desc desc = small();
    facet_sea *sea = make(&desc);
    facet_camera c = facet_sea_camera(sea, 0.0f, 0.5f * (float)PI);
    stand_in(&c, 3.0f);
    assert_true(c.target[0] > 0.9f); /* azimuths turn from +Z towards +X */
    c = facet_sea_camera(sea, -2.0f, 0.0f);
    stand_in(&c, -2.0f);
    facet_sea_destroy(sea);
    done(facet_sea_preset("gale", &desc, &failure));
    desc.resolution = 64;
    sea = make(&desc);
    c = facet_sea_camera(sea, 0.0f, 0.0f);
    assert_true(c.eye[1] >= 8.9f);
    const double origin[2] = {0.0, 0.0};
    for (int i = 0; i < 20; i++) {
        facet_sea_point p;
        done(facet_sea_set_time(sea, 1.7 * i, &failure));
        facet_sea_get_points(sea, origin, 1, &p);
        c = facet_sea_camera(sea, 0.1f, 0.0f);
        assert_true(c.eye[1] > p.height_m + 0.9f);
    }
    facet_sea_destroy(sea);
}

/* Each call's memory is refused in turn: a clean failure, and all is given back. */
static void memory_runs_out(void **state)
{
    (void)state;
    bool has_ended = false;
    for (long at = 0; at < 400 && !has_ended; at += at < 40 ? 1 : 7) {
        failing_allocator f = {.fail_at = at};
        facet_sea_desc desc = small();
        desc.resolution = 32;
        desc.allocator = failing_allocator_get(&f);
        facet_sea *sea = NULL;
        facet_image *maps = NULL, *image = NULL, *sheet = NULL;
        facet_scene *scene = NULL;
        facet_result result = facet_sea_create(&desc, &sea, &failure);
        if (result == FACET_OK)
            result = facet_sea_create_maps(sea, 0, &desc.allocator, &maps, &failure);
        const facet_sea_mesh_desc mesh = {.allocator = desc.allocator, .samples = 8};
        if (result == FACET_OK)
            result = facet_sea_create_mesh(sea, &mesh, &scene, &failure);
        facet_sea_render_desc d = small_image();
        d.render.allocator = desc.allocator;
        d.render.width = d.render.height = 8;
        const facet_contact_sheet_desc s = {.allocator = desc.allocator};
        if (result == FACET_OK && (at < 30 || at % 14 == 5))
            result = facet_sea_render(sea, NULL, &d, &image, &failure);
        if (result == FACET_OK && image)
            result =
                facet_image_create_sheet((const facet_image *const[]){image, image}, 2, &s, &sheet, &failure);
        has_ended = result == FACET_OK && sheet && atomic_load(&f.calls) <= at;
        if (result != FACET_OK && result != FACET_ERROR_MEMORY)
            fail_msg("call %ld: %s", at, failure.message);
        facet_image_destroy(sheet);
        facet_image_destroy(image);
        facet_image_destroy(maps);
        facet_scene_destroy(scene);
        facet_sea_destroy(sea);
        assert_int_equal(atomic_load(&f.blocks), 0);
    }
}

static void sheets_lie_side_by_side(void **state)
{
    (void)state;
    facet_image *parts[3], *sheet = NULL;
    for (int i = 0; i < 3; i++) {
        float pixels[2 * 2 * 4];
        for (int k = 0; k < 16; k++)
            pixels[k] = k % 4 == 3 ? 1.0f : 0.25f * (float)(i + 1);
        const facet_image_view v = {.width = 2, .height = 2, .channel_count = 4, .pixels = pixels};
        done(facet_image_create(&v, NULL, &parts[i], &failure));
    }
    const facet_contact_sheet_desc d = {.column_count = 2, .gap = 1};
    done(facet_image_create_sheet((const facet_image *const *)parts, 3, &d, &sheet, &failure));
    facet_image_view v = facet_image_get_layer(sheet, 0);
    assert_int_equal(v.width, 5);
    assert_int_equal(v.height, 5);
    static const struct {
        uint32_t x, y;
        float value;
    } seen[] = {{0, 0, 0.25f}, {1, 1, 0.25f}, {2, 0, 0.01f}, {3, 0, 0.5f},
                {4, 1, 0.5f},  {0, 3, 0.75f}, {3, 3, 0.01f}};
    for (size_t i = 0; i < sizeof seen / sizeof *seen; i++)
        assert_true(v.pixels[4 * (seen[i].y * 5 + seen[i].x)] == seen[i].value);
    facet_image_destroy(sheet);
    const float one[4] = {0};
    facet_image_destroy(parts[2]);
    done(facet_image_create(&(facet_image_view){.width = 1, .height = 1, .channel_count = 4, .pixels = one},
                            NULL, &parts[2], &failure));
    assert_int_equal(facet_image_create_sheet((const facet_image *const *)parts, 3, &d, &sheet, &failure),
                     FACET_ERROR_ARGUMENT);
    assert_int_equal(facet_image_create_sheet((const facet_image *const *)parts, 0, &d, &sheet, &failure),
                     FACET_ERROR_ARGUMENT);
    for (int i = 0; i < 3; i++)
        facet_image_destroy(parts[i]);
}

static void models_are_placed(void **state)
{
    (void)state;
    static const char
        file[] = /* two nodes, no scene but their roots; a box of 2 x 2 x 2 m would need buffers */
        "{\"asset\":{\"version\":\"2.0\"},\"nodes\":[{\"camera\":0,\"translation\":[1,2,3]},{}],"
        "\"cameras\":[{\"type\":\"perspective\",\"perspective\":{\"yfov\":1,\"znear\":0.1}}]}";
    const float there[16] = {0, 0, -1, 0, 0, 1, 0, 0, 1, 0, 0, 0, 10, 20, 30, 1};
    const float skewed[16] = {1, 0, 0, 1};
    facet_scene *scene = NULL;
    done(facet_scene_load_memory(file, strlen(file), "n.gltf", NULL, &scene, &failure));
    facet_camera c;
    for (int i = 0; i < 2; i++) { /* a second place replaces the first */
        float m[16];
        memcpy(m, there, sizeof m);
        m[13] += (float)i;
        done(facet_scene_place(scene, m, &failure));
        done(facet_camera_from_scene(scene, NULL, 0, &c, &failure));
        assert_true(c.eye[0] == 13.0f && c.eye[1] == 22.0f + (float)i && c.eye[2] == 29.0f);
    }
    assert_int_equal(facet_scene_place(scene, skewed, &failure), FACET_ERROR_ARGUMENT);
    facet_scene_destroy(scene);
    facet_scene *builtin = NULL;
    float low[3], high[3], low_after[3], high_after[3];
    done(facet_scene_create_builtin(&(facet_scene_desc){.thread_count = 1}, &builtin, &failure));
    assert_true(facet_scene_get_bounds(builtin, NULL, low, high));
    done(facet_scene_place(builtin, there, &failure));
    assert_true(facet_scene_get_bounds(builtin, NULL, low_after, high_after));
    assert_true(fabsf(low_after[0] - (10.0f + low[2])) < 1e-3f &&
                fabsf(high_after[2] - (30.0f - low[0])) < 1e-3f);
    facet_scene_destroy(builtin);
}

/* Two built-in scenes, the second 100 m aside: its spheres are seen there, with objects of their own. */
static void appended_models_have_their_own_place(void **state)
{
    (void)state;
    const float aside[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 100, 0, 0, 1};
    facet_scene *scene = NULL, *other = NULL;
    float low[3], high[3], low_after[3], high_after[3];
    done(facet_scene_create_builtin(&(facet_scene_desc){.thread_count = 1}, &scene, &failure));
    done(facet_scene_create_builtin(&(facet_scene_desc){.thread_count = 1}, &other, &failure));
    const facet_scene_counts before = facet_scene_get_counts(scene);
    assert_true(facet_scene_get_bounds(scene, NULL, low, high));
    done(facet_scene_append(scene, other, &failure));
    done(facet_scene_place_part(scene, 1, aside, &failure));
    assert_int_equal(facet_scene_place_part(scene, 2, aside, &failure), FACET_ERROR_ARGUMENT);
    assert_int_equal(facet_scene_append(scene, scene, &failure), FACET_ERROR_ARGUMENT);
    assert_int_equal(facet_scene_append(scene, other, &failure), FACET_ERROR_ARGUMENT);
    assert_int_equal(facet_scene_append(other, scene, &failure), FACET_ERROR_ARGUMENT);
    assert_int_equal(facet_scene_get_counts(scene).instances, 2 * before.instances);
    assert_true(facet_scene_get_bounds(scene, NULL, low_after, high_after));
    assert_true(fabsf(low_after[0] - low[0]) < 1e-3f && fabsf(high_after[0] - (100.0f + high[0])) < 1e-3f);
    facet_camera camera[2];
    camera[0] = (facet_camera){.eye = {0, 2, 12}, .target = {0, 0.5f, 0}, .fov_y_rad = 0.6f};
    camera[1] = camera[0];
    camera[1].eye[0] += 100.0f;
    camera[1].target[0] += 100.0f;
    float objects[2] = {0.0f, 0.0f}; /* the largest ID in each view */
    for (int view = 0; view < 2; view++) {
        const facet_render_desc d = {.width = 24,
                                     .height = 16,
                                     .samples = 1,
                                     .thread_count = 1,
                                     .camera = &camera[view],
                                     .aovs = FACET_AOV_OBJECT_ID};
        facet_image *image = NULL;
        done(facet_render(scene, &d, &image, &failure));
        const float *ids = layer_of(image, "object", 1);
        for (int i = 0; i < 24 * 16; i++)
            objects[view] = fmaxf(objects[view], ids[i]);
        facet_image_destroy(image);
    }
    assert_true(objects[0] > 0.0f && objects[0] <= (float)before.nodes);
    assert_true(objects[1] > (float)before.nodes + 1.0f);
    facet_scene_destroy(scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(presets_are_seas),
                                       cmocka_unit_test(info_follows_wind_and_swell),
                                       cmocka_unit_test(points_move_as_waves_do),
                                       cmocka_unit_test(maps_hold_the_tiles),
                                       cmocka_unit_test(mesh_is_the_surface),
                                       cmocka_unit_test(images_are_exposed),
                                       cmocka_unit_test(numbers_far_away_are_answered),
                                       cmocka_unit_test(zero_is_a_sea),
                                       cmocka_unit_test(what_is_wrong_is_said),
                                       cmocka_unit_test(eyes_stay_above_the_water),
                                       cmocka_unit_test(memory_runs_out),
                                       cmocka_unit_test(sheets_lie_side_by_side),
                                       cmocka_unit_test(models_are_placed),
                                       cmocka_unit_test(appended_models_have_their_own_place)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
