/* Truth tests of how samples become an image: mean and error of an estimate with more of them, coverage,
 * shutter and lens, filters; and that an image depends neither on threads, nor on the part that is drawn,
 * nor on being interrupted. */
#define _POSIX_C_SOURCE 200809L /* unlink */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

#include "tests/support/support.h"
#include "path/path_fixture.h"

/* Glossy and diffuse meshes, an area light, a sky, glass, fog. */
static fixture busy_scene(uint32_t size)
{
    fixture f = truth_create();
    truth_set_constant_sky(&f, 0.3f, 0.4f, 0.5f);
    truth_add_floor(&f, fixture_add_material(&f, truth_lambert(0.6f)), -1.0f, 4.0f);
    truth_add_ceiling(&f, fixture_add_material(&f, truth_emitter(3.0f)), 3.0f, 1.0f);
    truth_add_flat_sphere(&f, fixture_add_material(&f, truth_metal(0.9f, 0.7f, 0.3f, 0.4f)), 24, 0.0f, 0.7f);
    fixture_place(&f, f.scene->mesh_count - 1, 1.2f, 0.0f, 0.9f, 0.5f);
    truth_add_box(&f, fixture_add_material(&f, truth_glass(1.5f, 0.2f)), 1.0f, 0.4f, 0.2f, 0.4f);
    truth_set_camera(&f, 65.0, 0.0f, 0.0f, 3.0f);
    f.desc.width = f.desc.height = size;
    f.desc.samples = 16;
    f.desc.path.max_depth = 16;
    return f;
}

static void assert_same_image(const film *a, const film *b, const char *what)
{
    assert_int_equal(a->width, b->width);
    assert_int_equal(a->height, b->height);
    assert_int_equal(a->layer_count, b->layer_count);
    for (uint32_t i = 0; i < a->layer_count; i++)
        if (memcmp(a->layers[i].pixels, b->layers[i].pixels,
                   (size_t)a->width * a->height * a->layers[i].channel_count * sizeof(float)) != 0)
            fail_msg("%s: layer \"%s\" differs", what, a->layers[i].name);
}

/* ---- more samples ---- */

/* Pixel by pixel: the mean of 64 seeds of 16 samples each, and 2048 samples of another seed. The
 * differences are those of normal numbers with the errors that both have. */
static void many_short_renders_average_to_a_long_one(void **state)
{
    (void)state;
    enum { SIZE = 16, SEEDS = 64 };
    fixture f = busy_scene(SIZE);
    f.desc.aovs = FACET_AOV_VARIANCE;
    f.desc.samples = 2048;
    f.desc.path.seed = 1000;
    film reference = truth_render(&f, NULL);
    f.desc.samples = 16;
    static double sum[SIZE * SIZE * 3], square[SIZE * SIZE * 3];
    memset(sum, 0, sizeof sum);
    memset(square, 0, sizeof square);
    for (uint32_t seed = 0; seed < SEEDS; seed++) {
        f.desc.path.seed = seed;
        film rendered = truth_render(&f, NULL);
        for (size_t i = 0; i < SIZE * SIZE * 3; i++) {
            double v = (double)rendered.layers[0].pixels[4 * (i / 3) + i % 3];
            sum[i] += v;
            square[i] += v * v;
        }
        film_destroy(&rendered);
    }
    double chi2 = 0.0, bias = 0.0, bias_error2 = 0.0;
    uint32_t count = 0;
    for (size_t i = 0; i < SIZE * SIZE * 3; i++) {
        double mean = sum[i] / SEEDS;
        double variance = fmax(square[i] / SEEDS - mean * mean, 0.0) / (SEEDS - 1);
        /* The film's estimate holds for independent samples; stratified ones are better: an upper bound. */
        double own = (double)*(
            fixture_pixel(&reference, "variance", (uint32_t)(i / 3 % SIZE), (uint32_t)(i / 3 / SIZE)) +
            i % 3);
        double difference = mean - (double)reference.layers[0].pixels[4 * (i / 3) + i % 3];
        bias += difference;
        bias_error2 += variance + own;
        if (variance + own < 1e-12)
            continue;
        chi2 += difference * difference / (variance + own);
        count++;
    }
    film_destroy(&reference);
    fixture_destroy(&f);
    assert_true(count > SIZE * SIZE);
    print_message("chi2 %.1f of %u, bias %.2g, error %.2g\n", chi2, count, bias / count,
                  sqrt(bias_error2) / count);
    /* chi2 has mean `count`; channels of a pixel go together, so its deviation is up to sqrt(6 count). */
    assert_true(chi2 < count + 4.0 * sqrt(6.0 * count));
    assert_true(fabs(bias) < TRUTH_SIGMAS * sqrt(3.0 * bias_error2));
}

/* Root mean square error against an image of 64 times the samples: it falls with the root of the samples,
 * or faster. Without the glass, whose rare caustics make the errors themselves noisy. */
static void errors_fall_with_the_square_root_of_samples(void **state)
{
    (void)state;
    enum { SIZE = 16, STEPS = 3 };
    fixture f = busy_scene(SIZE);
    f.scene->node_count--;
    f.desc.samples = 4096;
    f.desc.path.seed = 77;
    film reference = truth_render(&f, NULL);
    f.desc.path.seed = 1;
    double rmse[STEPS];
    for (int step = 0; step < STEPS; step++) {
        f.desc.samples = 4u << 2 * step;
        double sum = 0.0;
        uint32_t seeds = 16;
        for (uint32_t seed = 1; seed <= seeds; seed++) {
            f.desc.path.seed = seed;
            film rendered = truth_render(&f, NULL);
            for (size_t i = 0; i < SIZE * SIZE * 4; i++) {
                double d = (double)rendered.layers[0].pixels[i] - (double)reference.layers[0].pixels[i];
                sum += d * d / (SIZE * SIZE * 4.0 * seeds);
            }
            film_destroy(&rendered);
        }
        rmse[step] = sqrt(sum);
    }
    film_destroy(&reference);
    fixture_destroy(&f);
    double slope = log(rmse[STEPS - 1] / rmse[0]) / log(16.0);
    print_message("RMSE %.4g %.4g %.4g, slope %.3f\n", rmse[0], rmse[1], rmse[2], slope);
    assert_true(slope < -0.5 + 0.02); /* the noise of the numbers, and of the reference: 1/64 of the last */
}

/* The variance of the film is that of images: not less than half of it, and not more than that of
 * independent samples, which is an upper bound for stratified ones. */
static void the_film_estimates_its_variance(void **state)
{
    (void)state;
    enum { SIZE = 8, SEEDS = 64 };
    fixture f = busy_scene(SIZE);
    f.desc.aovs = FACET_AOV_VARIANCE;
    f.desc.samples = 64;
    double estimated = 0.0;
    static double sum[SIZE * SIZE * 3], square[SIZE * SIZE * 3];
    memset(sum, 0, sizeof sum);
    memset(square, 0, sizeof square);
    for (uint32_t seed = 1; seed <= SEEDS; seed++) {
        f.desc.path.seed = seed;
        film rendered = truth_render(&f, NULL);
        for (uint32_t i = 0; i < SIZE * SIZE * 3; i++) {
            double v = (double)rendered.layers[0].pixels[4 * (i / 3) + i % 3];
            sum[i] += v;
            square[i] += v * v;
            estimated +=
                (double)fixture_pixel(&rendered, "variance", i / 3 % SIZE, i / 3 / SIZE)[i % 3] / SEEDS;
        }
        film_destroy(&rendered);
    }
    double measured = 0.0;
    for (size_t i = 0; i < SIZE * SIZE * 3; i++)
        measured += (square[i] - sum[i] * sum[i] / SEEDS) / (SEEDS - 1);
    fixture_destroy(&f);
    print_message("variance estimated %.4g, measured %.4g\n", estimated, measured);
    assert_true(estimated > measured * 0.9 && estimated < measured * 10.0);
}

/* ---- coverage ---- */

static void blending_and_masks_cover_their_share(void **state)
{
    (void)state;
    static const float opacities[] = {0.0f, 0.3f, 0.8f};
    for (int i = 0; i < 3; i++)
        for (int layers = 1; layers <= 2; layers++) {
            fixture f = truth_create();
            f.desc.background = FACET_BACKGROUND_TRANSPARENT;
            f.desc.samples = 1024;
            truth_set_constant_sky(&f, 1.0f, 1.0f, 1.0f);
            scene_material m = truth_lambert(0.5f);
            m.alpha_mode = SCENE_ALPHA_BLEND;
            m.base_color[3] = opacities[i];
            m.is_double_sided = true;
            uint32_t material = fixture_add_material(&f, m);
            for (int k = 0; k < layers; k++)
                truth_add_floor(&f, material, -1000.0f * (float)k, 10.0f);
            truth_set_camera(&f, 0.0, 0.0f, 0.0f, 0.1f);
            truth_value v = truth_measure(&f, 16);
            double opacity = 1.0 - pow(1.0 - (double)opacities[i], layers);
            truth_assert_channel(&v, 3, opacity, "%d layers of %g", layers, (double)opacities[i]);
            if (layers == 1)
                truth_assert_grey(&v, 0.5 * opacity, "premultiplied, %g", (double)opacities[i]);
            fixture_destroy(&f);
        }
    /* A mask is all or nothing. */
    for (int i = 0; i < 2; i++) {
        fixture f = truth_create();
        f.desc.background = FACET_BACKGROUND_TRANSPARENT;
        truth_set_constant_sky(&f, 1.0f, 1.0f, 1.0f);
        scene_material m = truth_lambert(0.5f);
        m.alpha_mode = SCENE_ALPHA_MASK;
        m.alpha_cutoff = 0.5f;
        m.base_color[3] = i ? 0.5f : 0.49f;
        truth_add_floor(&f, fixture_add_material(&f, m), 0.0f, 10.0f);
        truth_set_camera(&f, 0.0, 0.0f, 0.0f, 0.1f);
        truth_value v = truth_measure_pixels(&f);
        truth_assert_channel(&v, 3, i, "mask at %g", (double)m.base_color[3]);
        fixture_destroy(&f);
    }
}

/* Shadows of half transparent surfaces: light through them. */
static void blending_casts_half_a_shadow(void **state)
{
    (void)state;
    scene_light light = {.name = "", .type = SCENE_LIGHT_POINT, .color = {1, 1, 1}, .intensity = 100.0f};
    fixture f = truth_create();
    f.desc.samples = 1024;
    truth_add_floor(&f, fixture_add_material(&f, truth_lambert(0.5f)), 0.0f, 20.0f);
    scene_material m = truth_lambert(0.0f);
    m.alpha_mode = SCENE_ALPHA_BLEND;
    m.base_color[3] = 0.3f;
    m.is_double_sided = true;
    truth_add_floor(&f, fixture_add_material(&f, m), 1.0f, 0.5f);
    fixture_add_light(&f, light, 0.2f, 2.0f, 0.0f); /* not through the diagonal, where both triangles count */
    truth_set_camera(&f, 60.0, 0.0f, 0.0f, 0.0001f);
    truth_value v = truth_measure(&f, 16);
    truth_assert_grey(&v, 0.7 * 0.5 / TRUTH_PI * 100.0 / 4.04 * 2.0 / sqrt(4.04), "under a veil");
    fixture_destroy(&f);
}

/* An edge through pixels, box filter: coverage is area. */
static void edges_cover_their_area(void **state)
{
    (void)state;
    fixture f = truth_create();
    f.desc.background = FACET_BACKGROUND_TRANSPARENT;
    f.desc.samples = 4096;
    truth_set_constant_sky(&f, 1.0f, 1.0f, 1.0f);
    truth_add_floor(&f, fixture_add_material(&f, truth_lambert(1.0f)), 0.0f, 0.8125f);
    truth_set_camera(&f, 0.0, 0.0f, 0.0f, 2.0f);
    truth_value v = truth_measure_pixels(&f);
    assert_true(fabs(v.mean[3] - 0.8125 * 0.8125) < 2e-4);
    film rendered = truth_render(&f, NULL);
    for (uint32_t y = 0; y < 4; y++)
        for (uint32_t x = 0; x < 4; x++) {
            double cx = x % 3 ? 1.0 : 0.625;
            double cy = y % 3 ? 1.0 : 0.625;
            /* Owen-scrambled: the error at an edge is about N^-3/4. */
            assert_true(fabs((double)fixture_pixel(&rendered, "", x, y)[3] - cx * cy) < 4e-3);
        }
    film_destroy(&rendered);
    fixture_destroy(&f);
}

/* ---- filters, shutter, lens ---- */

/* Each pixel of it, to rounding. */
static void filters_keep_a_constant(void **state)
{
    (void)state;
    for (int filter = 0; filter < 3; filter++) {
        fixture f = truth_create();
        f.desc.path.filter = (facet_filter)filter;
        f.desc.width = f.desc.height = 8;
        f.desc.samples = 16;
        truth_set_constant_sky(&f, 1.0f, 2.0f, 4.0f);
        truth_add_floor(&f, fixture_add_material(&f, truth_metal(1.0f, 1.0f, 1.0f, 0.0f)), -5.0f, 0.01f);
        truth_set_camera(&f, 10.0, 3.0f, 0.0f, 0.5f);
        truth_value v = truth_measure_pixels(&f);
        for (int c = 0; c < 4; c++) {
            truth_assert_channel(&v, c, c == 3 ? 1.0 : (double)(1 << c), "filter %d", filter);
            assert_true(v.error[c] < 1e-6);
        }
        fixture_destroy(&f);
    }
}

/* The filters once more, as their authors have them, not normalised. */
static double filter_weight(facet_filter filter, double x)
{
    double a = fabs(x);
    if (filter == FACET_FILTER_BOX)
        return a < 0.5 ? 1.0 : 0.0;
    if (filter == FACET_FILTER_BLACKMAN_HARRIS) {
        if (a >= 1.5)
            return 0.0;
        double t = 2.0 * TRUTH_PI * (a / 3.0 + 0.5); /* Harris 1978, four terms */
        return 0.35875 - 0.48829 * cos(t) + 0.14128 * cos(2.0 * t) - 0.01168 * cos(3.0 * t);
    }
    /* Mitchell and Netravali 1988, B = C = 1/3. */
    if (a < 1.0)
        return (7.0 * a * a * a - 12.0 * a * a + 16.0 / 3.0) / 6.0;
    return a < 2.0 ? (-7.0 / 3.0 * a * a * a + 12.0 * a * a - 20.0 * a + 32.0 / 3.0) / 6.0 : 0.0;
}

/* The value of a thin line in the pixels around it is the filter's integral over the line. */
static void filters_blur_a_line_as_they_say(void **state)
{
    (void)state;
    for (int filter = 0; filter < 3; filter++) {
        fixture f = truth_create();
        f.desc.path.filter = (facet_filter)filter;
        f.desc.background = FACET_BACKGROUND_TRANSPARENT;
        f.desc.width = f.desc.height = 8;
        f.desc.samples = 4096;
        /* A line of 1/4 pixel through the middle of column 4, 8 pixels of 1 m. */
        scene_material emitter = truth_emitter(1.0f);
        truth_add_panel(&f, fixture_add_material(&f, emitter), (float[3]){0.5f, 0.0f, 0.0f},
                        (float[3]){0.125f, 0.0f, 0.0f}, (float[3]){0.0f, 0.0f, -100.0f});
        truth_set_camera(&f, 0.0, 0.0f, 0.0f, 8.0f);
        film rendered = truth_render(&f, NULL);
        double total = 0.0;
        for (int i = -2000; i < 2000; i++)
            total += filter_weight((facet_filter)filter, (i + 0.5) / 1000.0) / 1000.0;
        for (uint32_t x = 0; x < 8; x++) {
            double expected = 0.0;
            for (int i = 0; i < 250; i++) {
                double line = (i + 0.5) / 1000.0 - 0.125 + 4.5; /* in pixels */
                expected += filter_weight((facet_filter)filter, line - (x + 0.5)) / 1000.0 / total;
            }
            double mean = 0.0;
            for (uint32_t y = 2; y < 6; y++)
                mean += (double)fixture_pixel(&rendered, "", x, y)[0] / 4.0;
            if (fabs(mean - expected) > 2e-3)
                fail_msg("filter %d, %d pixels from the line: %.5f, expected %.5f", filter, (int)x - 4, mean,
                         expected);
        }
        film_destroy(&rendered);
        fixture_destroy(&f);
    }
}

/* A shining square that crosses the image while the shutter is open. */
static void a_moving_square_is_blurred_by_a_box(void **state)
{
    (void)state;
    enum { SIZE = 16 };
    fixture f = truth_create();
    f.desc.background = FACET_BACKGROUND_TRANSPARENT;
    f.desc.width = f.desc.height = SIZE;
    f.desc.samples = 256;
    truth_add_floor(&f, fixture_add_material(&f, truth_emitter(1.0f)), 0.0f, 2.0f);
    truth_set_camera(&f, 0.0, 0.0f, 0.0f, 16.0f);
    static const float times[2] = {1.0f, 2.0f};
    static const float values[6] = {-4.0f, 0.0f, 0.0f, 4.0f, 0.0f, 0.0f};
    static const scene_sampler sampler = {
        .interpolation = SCENE_LINEAR, .key_count = 2, .times = times, .width = 3, .values = values};
    static const scene_channel channel = {
        .kind = SCENE_TARGET_NODE, .index = 0, .offset = offsetof(scene_node, translation), .scale = 1.0f};
    static scene_animation animation = {.name = "",
                                        .channel_count = 1,
                                        .sampler_count = 1,
                                        .channels = &channel,
                                        .samplers = &sampler,
                                        .begin_s = 1.0f,
                                        .end_s = 2.0f};
    f.scene->animations = &animation;
    f.scene->animation_count = 1;
    f.desc.pose = (facet_pose_desc){.animation_count = 1, .animations = (uint32_t[]){0}, .time_s = 1.0};
    f.desc.path.shutter_s = 1.0f;
    film rendered = truth_render(&f, NULL);
    double sum = 0.0;
    for (uint32_t x = 0; x < SIZE; x++) {
        double expected = 0.0;
        for (int i = 0; i < 1000; i++)
            for (int k = 0; k < 100; k++) {
                double at = x + (k + 0.5) / 100.0 - 8.0;
                double middle = -4.0 + 8.0 * (i + 0.5) / 1000.0;
                expected += fabs(at - middle) < 2.0 ? 1e-5 : 0.0;
            }
        double mean = 0.0;
        for (uint32_t y = 7; y < 9; y++)
            mean += (double)fixture_pixel(&rendered, "", x, y)[3] / 2.0;
        sum += mean;
        /* 64 instants, evenly spread: each stands for 1/64 of the time. */
        if (fabs(mean - expected) > 1.0 / 64.0)
            fail_msg("column %u: %.4f, expected %.4f", x, mean, expected);
        assert_true(fabs((double)fixture_pixel(&rendered, "", x, 2)[3]) < 1e-6);
    }
    assert_true(fabs(sum - 4.0) < 0.02);
    film_destroy(&rendered);
    fixture_destroy(&f);
}

/* A small shining square at 4 m, lens of radius 0.1 m, in focus at 2 m: in the plane of focus its circle
 * of confusion has the radius 0.1 |2 - 4| / 4 = 0.05 m, as much as 0.1 m at 4 m. Its light is the same,
 * and its mean square distance from the middle is that of a disc, R^2 / 2. */
static void a_lens_blurs_a_point_into_a_disc(void **state)
{
    (void)state;
    enum { SIZE = 32 };
    double flux[2];
    for (int is_sharp = 0; is_sharp < 2; is_sharp++) {
        fixture f = truth_create();
        f.desc.background = FACET_BACKGROUND_TRANSPARENT;
        f.desc.width = f.desc.height = SIZE;
        f.desc.samples = 4096;
        truth_add_panel(&f, fixture_add_material(&f, truth_emitter(100.0f)), (float[3]){0.0f, 0.0f, 0.0f},
                        (float[3]){0.01f, 0.0f, 0.0f}, (float[3]){0.0f, 0.01f, 0.0f});
        double height = 0.4; /* m at a distance of 4 m */
        f.camera = (facet_camera){.eye = {0.0f, 0.0f, 4.0f},
                                  .fov_y_rad = (float)(2.0 * atan(0.5 * height / 4.0)),
                                  .lens_radius_m = is_sharp ? 0.0f : 0.1f,
                                  .focus_m = 2.0f};
        film rendered = truth_render(&f, NULL);
        double sum = 0.0, moment = 0.0, middle[2] = {0.0, 0.0}, farthest = 0.0;
        for (uint32_t y = 0; y < SIZE; y++)
            for (uint32_t x = 0; x < SIZE; x++) {
                double v = (double)fixture_pixel(&rendered, "", x, y)[0];
                double px = (x + 0.5 - SIZE / 2) * height / SIZE;
                double py = (y + 0.5 - SIZE / 2) * height / SIZE;
                sum += v;
                moment += v * (px * px + py * py);
                middle[0] += v * px;
                middle[1] += v * py;
                if (v > 0.0)
                    farthest = fmax(farthest, hypot(px, py));
            }
        flux[is_sharp] = sum;
        double pixel = height / SIZE;
        /* The square has 2 (0.01^2 / 3), a pixel 2 pixel^2 / 12. */
        double expected = (is_sharp ? 0.0 : 0.1 * 0.1 / 2.0) + 2e-4 / 3.0 + pixel * pixel / 6.0;
        print_message("flux %.5g, mean square distance %.5g of %.5g, middle %.5f %.5f\n", sum, moment / sum,
                      expected, middle[0] / sum, middle[1] / sum);
        /* 10 000 of the samples hit the square: of a disc, r^2 has a deviation of 0.58 of its mean, x one
         * of R / 2. */
        assert_true(is_sharp || fabs(moment / sum - expected) < TRUTH_SIGMAS * 0.0058 * expected);
        assert_true(hypot(middle[0], middle[1]) / sum < TRUTH_SIGMAS * 0.0005);
        assert_true(farthest < (is_sharp ? 0.0 : 0.1) + 0.01 * sqrt(2.0) + 1.5 * pixel);
        film_destroy(&rendered);
        fixture_destroy(&f);
    }
    assert_true(fabs(flux[0] - flux[1]) < TRUTH_SIGMAS * 0.01 * flux[1]);
}

/* ---- independence of threads, crops, interruptions ---- */

static void images_do_not_depend_on_threads(void **state)
{
    (void)state;
    fixture f = busy_scene(48);
    f.desc.samples = 8;
    f.desc.aovs = FACET_AOV_ALBEDO | FACET_AOV_NORMAL | FACET_AOV_VARIANCE | FACET_AOV_SAMPLES;
    for (int is_adaptive = 0; is_adaptive < 2; is_adaptive++) {
        f.desc.path.noise = is_adaptive ? 0.1f : 0.0f;
        f.desc.samples = is_adaptive ? 64 : 8;
        f.desc.thread_count = 1;
        film one = truth_render(&f, NULL);
        f.desc.thread_count = 2;
        film two = truth_render(&f, NULL);
        f.desc.thread_count = 7;
        film seven = truth_render(&f, NULL);
        assert_same_image(&one, &two, "1 and 2 threads");
        assert_same_image(&one, &seven, "1 and 7 threads");
        film_destroy(&one);
        film_destroy(&two);
        film_destroy(&seven);
    }
    fixture_destroy(&f);
}

static void a_crop_equals_the_whole_image_there(void **state)
{
    (void)state;
    fixture f = busy_scene(40);
    for (int filter = 0; filter < 3; filter++) {
        f.desc.path.filter = (facet_filter)filter;
        memset(f.desc.crop, 0, sizeof f.desc.crop);
        film whole = truth_render(&f, NULL);
        static const uint32_t crop[4] = {13, 7, 18, 21};
        memcpy(f.desc.crop, crop, sizeof crop);
        film part = truth_render(&f, NULL);
        for (uint32_t y = 0; y < crop[3]; y++)
            assert_memory_equal(fixture_pixel(&part, "", 0, y),
                                fixture_pixel(&whole, "", crop[0], crop[1] + y), crop[2] * 4 * sizeof(float));
        film_destroy(&whole);
        film_destroy(&part);
    }
    fixture_destroy(&f);
}

/* Stops after so many reports. */
static bool stop_after(void *user, const char *stage, double fraction)
{
    (void)stage;
    int *left = user;
    return fraction < 0.2 || (*left)-- > 0;
}

static void interrupted_renders_resume_to_the_bit(void **state)
{
    (void)state;
    temporary_folder folder;
    temporary_folder_create(&folder);
    char path[sizeof folder.path + sizeof "/c.exr"];
    snprintf(path, sizeof path, "%s/c.exr", folder.path);
    fixture f = busy_scene(32);
    f.desc.samples = 48;
    f.desc.aovs = FACET_AOV_ALBEDO | FACET_AOV_NORMAL | FACET_AOV_VARIANCE | FACET_AOV_SAMPLES;
    for (int is_adaptive = 0; is_adaptive < 2; is_adaptive++) {
        f.desc.path.noise = is_adaptive ? 0.2f : 0.0f;
        f.desc.path.checkpoint_path = NULL;
        f.desc.path.resumes = false;
        film whole = truth_render(&f, NULL);
        /* Fewer samples, then more. */
        f.desc.path.checkpoint_path = path;
        f.desc.samples = 20;
        film some = truth_render(&f, NULL);
        f.desc.samples = 48;
        f.desc.path.resumes = true;
        film all = truth_render(&f, NULL);
        if (!is_adaptive) /* where passes end differs with the number of samples, and with it where regions are done */
            assert_same_image(&whole, &all, "more samples later");
        film_destroy(&some);
        film_destroy(&all);
        unlink(path);
        /* Cancelled in the middle, then gone on with, over and over. */
        f.desc.path.resumes = true;
        film resumed;
        facet_error error = {0};
        facet_render_stats stats;
        int tries = 0;
        for (;;) {
            int left = 1;
            f.desc.progress = (facet_progress){.user = &left, .report = tries < 2 ? stop_after : NULL};
            facet_result result = truth_try_render(&f, &resumed, &stats, &error);
            if (result == FACET_OK)
                break;
            assert_int_equal(result, FACET_ERROR_CANCELLED);
            film_destroy(&resumed);
            assert_true(++tries < 10);
        }
        f.desc.progress = (facet_progress){0};
        assert_true(tries > 0);
        if (!is_adaptive)
            assert_same_image(&whole, &resumed, "cancelled");
        film_destroy(&resumed);
        film_destroy(&whole);
        unlink(path);
    }
    fixture_destroy(&f);
    temporary_folder_remove(&folder);
}

/* Adaptive sampling stops where the noise is low; its mean is that of all samples within 1 %, and it took
 * fewer. */
static void adaptive_images_have_the_same_mean(void **state)
{
    (void)state;
    fixture f = busy_scene(16);
    f.desc.samples = 512;
    f.desc.path.noise = 0.01f;
    truth_value adaptive = truth_measure(&f, 8);
    facet_render_stats stats;
    film rendered = truth_render(&f, &stats);
    film_destroy(&rendered);
    uint64_t taken = stats.samples;
    f.desc.path.noise = 0.0f;
    truth_value all = truth_measure(&f, 8);
    fixture_destroy(&f);
    print_message("%.1f samples a pixel\n", (double)taken / (16.0 * 16.0));
    assert_true(taken < 16u * 16u * 512u / 2u && taken >= 16u * 16u * 32u);
    for (int c = 0; c < 3; c++)
        if (fabs(adaptive.mean[c] - all.mean[c]) >
            0.01 * all.mean[c] + TRUTH_SIGMAS * hypot(adaptive.error[c], all.error[c]))
            fail_msg("channel %d: adaptive %.6g +- %.2g, all %.6g +- %.2g", c, adaptive.mean[c],
                     adaptive.error[c], all.mean[c], all.error[c]);
}

/* A path of at most 64 events and one of at most 4000: longer paths contribute less than the noise, in a
 * scene without white rooms; and roulette, which ends nearly all of these paths before, does not change
 * the mean. */
static void roulette_is_unbiased(void **state)
{
    (void)state;
    truth_value v[2];
    for (int i = 0; i < 2; i++) {
        fixture f = busy_scene(16);
        f.desc.path.max_depth = i ? 4000 : 64;
        f.desc.samples = 64;
        v[i] = truth_measure(&f, 16);
        fixture_destroy(&f);
    }
    truth_assert_same(&v[0], &v[1], 3.0, "64 events against 4000");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(many_short_renders_average_to_a_long_one),
        cmocka_unit_test(errors_fall_with_the_square_root_of_samples),
        cmocka_unit_test(the_film_estimates_its_variance),
        cmocka_unit_test(blending_and_masks_cover_their_share),
        cmocka_unit_test(blending_casts_half_a_shadow),
        cmocka_unit_test(edges_cover_their_area),
        cmocka_unit_test(filters_keep_a_constant),
        cmocka_unit_test(filters_blur_a_line_as_they_say),
        cmocka_unit_test(a_moving_square_is_blurred_by_a_box),
        cmocka_unit_test(a_lens_blurs_a_point_into_a_disc),
        cmocka_unit_test(images_do_not_depend_on_threads),
        cmocka_unit_test(a_crop_equals_the_whole_image_there),
        cmocka_unit_test(interrupted_renders_resume_to_the_bit),
        cmocka_unit_test(adaptive_images_have_the_same_mean),
        cmocka_unit_test(roulette_is_unbiased),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
