/* path_film_test.c - precision of the means, noise estimates, the ground, adaptive sampling. */
#include <float.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "tests/support/support.h"
#include "base/hash.h"
#include "base/parallel.h"
#include "path/path_film_state.h"

enum { ALL = FACET_AOV_NORMAL | FACET_AOV_ALBEDO | FACET_AOV_VARIANCE | FACET_AOV_SAMPLES };

static path_film *create(uint32_t width, uint32_t height, bool has_ground)
{
    path_film *f;
    assert_int_equal(path_film_create(NULL, width, height, has_ground, &f, NULL), FACET_OK);
    return f;
}

static film resolve(const path_film *f, float scale, uint32_t thread_count)
{
    film target;
    assert_int_equal(film_create(NULL, f->width, f->height, ALL, &target, NULL), FACET_OK);
    path_film_resolve(f, scale, &target, thread_count);
    return target;
}

static float at(film *target, const char *layer, size_t i)
{
    return film_find(target, layer)->pixels[i];
}

static path_sample grey(float radiance)
{
    return (path_sample){.radiance = {radiance, radiance, radiance}, .opacity = 1.0f};
}

/* ---- random numbers ---- */

static double uniform(uint64_t *state) /* in (0, 1) */
{
    return ((double)(mix64(*state += MIX64_STEP) >> 12) + 0.5) / 4503599627370496.0;
}

static double normal(uint64_t *state)
{
    double r = sqrt(-2.0 * log(uniform(state)));
    return r * cos(6.283185307179586 * uniform(state));
}

/* ---- means ---- */

static void means_keep_their_precision(void **state)
{
    (void)state;
    enum { COUNT = 3000000 };
    path_film *f = create(3, 1, false);
    uint64_t random = 1;
    long double sum = 0.0L, albedo = 0.0L;
    for (int i = 0; i < COUNT; i++) {
        path_sample s = grey((float)(1000.0 + 0.01 * normal(&random)));
        s.albedo[1] = (float)uniform(&random);
        path_film_add(f, 0, &s);
        sum += (long double)s.radiance[0];
        albedo += (long double)s.albedo[1];
        s = grey(0.1f);
        path_film_add(f, 1, &s);
    }
    const path_pixel *p = &f->pixels[0];
    assert_near((double)p->color[0] / COUNT * 0x1p-56, (double)(sum / COUNT), 1e-12);
    assert_near(path_pixel_share(p, p->albedo[1]), (double)(albedo / COUNT), 1e-9);
    /* a constant is preserved bit for bit, without noise */
    p = &f->pixels[1];
    for (int c = 0; c < 3; c++) {
        assert_true(path_pixel_mean(p, c) == 0.1f && path_pixel_spread(p, c) == 0.0);
    }
    assert_true(path_pixel_mean(p, 3) == 1.0f);
    assert_int_equal(path_film_samples(f, 0), COUNT);
    assert_int_equal(path_film_samples(f, 2), 0);
    assert_int_equal(path_film_total_samples(f), 2 * COUNT);
    path_film_destroy(f);
}

/* Against two passes in long double, for nearly constant and for rare light. */
static void variance_does_not_cancel(void **state)
{
    (void)state;
    enum { COUNT = 20000 };
    static float x[3][COUNT];
    path_film *f = create(1, 1, false);
    uint64_t random = 2;
    long double mean[3] = {0.0L}, square[3] = {0.0L};
    for (int i = 0; i < COUNT; i++) {
        path_sample s = {.opacity = 1.0f};
        s.radiance[0] = x[0][i] =
            1e6f + (uniform(&random) < 0.5 ? 0.0625f : 0.0f); /* the last bit of a float */
        s.radiance[1] = x[1][i] = uniform(&random) < 0.001 ? 1000.0f : 0.0f;
        s.radiance[2] = x[2][i] = (float)normal(&random);
        path_film_add(f, 0, &s);
        for (int c = 0; c < 3; c++)
            mean[c] += (long double)x[c][i] / COUNT;
    }
    for (int c = 0; c < 3; c++)
        for (int i = 0; i < COUNT; i++)
            square[c] += ((long double)x[c][i] - mean[c]) * ((long double)x[c][i] - mean[c]) / (COUNT - 1);
    film target = resolve(f, 2.0f, 1);
    for (size_t c = 0; c < 3; c++) {
        double expected = (double)(4.0L * square[c] / COUNT);
        assert_near(at(&target, "variance", c), expected, 1e-4 * expected);
    }
    film_destroy(&target);
    path_film_destroy(f);
}

/* Samples in any order, and in two films of which one has the samples from `split` on, give the same sums. */
static void sums_do_not_depend_on_the_order(void **state)
{
    (void)state;
    enum { COUNT = 1000 };
    static path_sample samples[COUNT];
    uint64_t random = 3;
    for (int i = 0; i < COUNT; i++)
        for (int c = 0; c < 3; c++) {
            double light = exp2(60.0 * uniform(&random) - 30.0);
            samples[i].radiance[c] = (float)(uniform(&random) < 0.1 ? -light : light);
            samples[i].albedo[c] = (float)uniform(&random);
            samples[i].normal[c] = (float)uniform(&random) - 0.5f;
            samples[i].ground_open[c] = i % 3 ? (float)uniform(&random) : 0.0f;
            samples[i].ground_lit[c] = i % 3 ? (float)uniform(&random) : 0.0f;
            samples[i].opacity = samples[i].filter_excess = (float)normal(&random);
        }
    path_film *forwards = create(1, 1, true), *backwards = create(1, 1, true);
    for (int i = 0; i < COUNT; i++) {
        path_film_add(forwards, 0, &samples[i]);
        path_film_add(backwards, 0, &samples[COUNT - 1 - i]);
    }
    assert_memory_equal(forwards->pixels, backwards->pixels, sizeof *forwards->pixels);
    assert_memory_equal(forwards->ground, backwards->ground, sizeof *forwards->ground);
    for (int split = 0; split <= COUNT; split += 333) {
        path_film *first = create(1, 1, true), *second = create(1, 1, true);
        for (int i = 0; i < COUNT; i++)
            path_film_add(i < split ? first : second, 0, &samples[i]);
        assert_true(path_film_is_sound(first) && path_film_is_sound(second));
        assert_true(path_film_add_film(second, first));
        assert_memory_equal(forwards->pixels, second->pixels, sizeof *forwards->pixels);
        assert_memory_equal(forwards->ground, second->ground, sizeof *forwards->ground);
        path_film_destroy(first);
        path_film_destroy(second);
    }
    forwards->pixels[0].samples = PATH_FILM_MAX_SAMPLES;
    assert_false(path_film_add_film(backwards, forwards));
    path_film_destroy(forwards);
    path_film_destroy(backwards);
}

static void few_samples_have_an_estimate(void **state)
{
    (void)state;
    path_film *f = create(3, 1, true);
    path_sample s = grey(3.0f);
    path_film_add(f, 1, &s);
    path_film_add(f, 2, &s);
    s = grey(5.0f);
    path_film_add(f, 2, &s);
    film target = resolve(f, 1.0f, 1);
    for (size_t c = 0; c < 3; c++) {
        assert_true(at(&target, "", c) == 0.0f && at(&target, "variance", c) == 0.0f);
        assert_true(at(&target, "", 4 + c) == 3.0f && at(&target, "variance", 3 + c) == 9.0f);
        assert_true(at(&target, "", 8 + c) == 4.0f && at(&target, "variance", 6 + c) == 1.0f);
    }
    for (size_t i = 0; i < 3; i++)
        assert_true(at(&target, "samples", i) == (float)i && at(&target, "", 4 * i + 3) == (i ? 1.0f : 0.0f));
    film_destroy(&target);
    path_film_destroy(f);
}

static void a_pixel_can_be_full(void **state)
{
    (void)state;
    path_film *f = create(1, 1, false);
    path_sample s = grey(1.0f);
    path_film_add(f, 0, &s);
    f->pixels[0].samples = PATH_FILM_MAX_SAMPLES - 1;
    path_film_add(f, 0, &s);
    assert_int_equal(path_film_samples(f, 0), 1 << 24);
    s = grey(100.0f);
    path_film_add(f, 0, &s);
    assert_int_equal(path_film_samples(f, 0), 1 << 24);
    assert_int_equal((int)(f->pixels[0].color[0] >> 56), 2);
    film target = resolve(f, 1.0f, 1);
    assert_true(at(&target, "samples", 0) == 16777216.0f);
    film_destroy(&target);
    path_film_destroy(f);
}

/* ---- odd samples ---- */

static void non_finite_samples_are_black(void **state)
{
    (void)state;
    const float odd[3] = {NAN, INFINITY, -INFINITY};
    path_film *f = create(1, 1, true);
    path_sample good = grey(2.0f);
    good.albedo[0] = good.normal[2] = 1.0f;
    uint32_t dropped = 0;
    for (int kind = 0; kind < 3; kind++)
        for (int member = 0; member < 16; member++) {
            path_sample s = good;
            float *members[] = {s.radiance, s.albedo, s.normal, s.ground_lit, s.ground_open, &s.opacity};
            *(member == 15 ? members[5] : members[member / 3] + member % 3) = odd[kind];
            path_film_add(f, 0, &s);
            path_film_add(f, 0, &good);
            assert_int_equal(path_film_dropped(f), ++dropped);
        }
    assert_int_equal(path_film_samples(f, 0), 2 * dropped);
    film target = resolve(f, 1.0f, 1);
    assert_near(at(&target, "", 0), 1.0, 1e-6);
    assert_near(at(&target, "", 3), 0.5, 1e-6);
    assert_near(at(&target, "albedo", 0), 0.5, 1e-6);
    assert_near(at(&target, "normal", 2), 1.0, 1e-6);
    assert_int_equal(f->ground[0].samples, 0);
    film_destroy(&target);
    path_film_destroy(f);
}

static void huge_light_stays_finite(void **state)
{
    (void)state;
    path_film *f = create(1, 1, true);
    for (int i = 0; i < 1000; i++) {
        path_sample s = grey(i % 2 ? FLT_MAX : -FLT_MAX);
        for (int c = 0; c < 3; c++) {
            s.ground_open[c] = FLT_MAX;
            s.ground_lit[c] = -FLT_MAX;
        }
        path_film_add(f, 0, &s);
    }
    path_film_update(f, 0.1f, 1);
    assert_true(path_film_needs_more(f, 0));
    film target = resolve(f, 1e6f, 1);
    for (uint32_t l = 0; l < target.layer_count; l++)
        for (size_t c = 0; c < target.layers[l].channel_count; c++)
            assert_true(isfinite(target.layers[l].pixels[c]));
    assert_int_equal(path_film_dropped(f), 0);
    film_destroy(&target);
    path_film_destroy(f);
}

/* Filters with negative lobes: light may come out negative, opacity not. */
static void negative_filter_weights_are_kept(void **state)
{
    (void)state;
    path_film *f = create(2, 1, false);
    path_sample s = grey(-0.25f);
    s.opacity = -0.25f;
    path_film_add(f, 0, &s);
    s = grey(1.5f);
    s.opacity = 1.5f;
    path_film_add(f, 1, &s);
    film target = resolve(f, 1.0f, 1);
    assert_true(at(&target, "", 0) == -0.25f && at(&target, "", 3) == 0.0f);
    assert_true(at(&target, "", 4) == 1.5f && at(&target, "", 7) == 1.0f);
    film_destroy(&target);
    path_film_destroy(f);
}

/* A constant stays constant, whatever the filter weights are. */
static void weights_divided_out(void **state)
{
    (void)state;
    path_film *f = create(1, 1, false);
    for (int i = 0; i < 20; i++) {
        float weight = i % 7 == 3 ? -1.3f : 1.3f;
        path_sample s = grey(0.7f * weight);
        s.opacity = weight;
        s.filter_excess = weight - 1.0f;
        path_film_add(f, 0, &s);
    }
    film target = resolve(f, 1.0f, 1);
    for (size_t c = 0; c < 3; c++)
        assert_near(at(&target, "", c), 0.7, 1e-6);
    assert_near(at(&target, "", 3), 1.0, 1e-6);
    film_destroy(&target);
    path_film_destroy(f);
}

/* A shadow with an edge down the middle, of 16 noisy samples a pixel: denoised on both sides, with the
 * edge preserved. */
static void shadows_are_denoised_up_to_their_edge(void **state)
{
    (void)state;
    enum { SIDE = 48 };
    path_film *f = create(SIDE, SIDE, true);
    uint32_t random = 1;
    double before = 0.0;
    double after = 0.0;
    for (uint32_t i = 0; i < SIDE * SIDE; i++)
        for (int n = 0; n < 16; n++) {
            lcg_next(&random);
            bool is_lit = (double)(random >> 8) / 16777216.0 > (i % SIDE < SIDE / 2 ? 0.2 : 0.7);
            path_sample s = {0};
            for (int c = 0; c < 3; c++) {
                s.ground_open[c] = 1.0f;
                s.ground_lit[c] = is_lit ? 1.0f : 0.0f;
            }
            path_film_add(f, i, &s);
        }
    for (int is_calm = 0; is_calm < 2; is_calm++) {
        if (is_calm)
            assert_int_equal(path_film_denoise_ground(f, 2, NULL), FACET_OK);
        double *sum = is_calm ? &after : &before;
        for (uint32_t i = 0; i < SIDE * SIDE; i++) {
            double expected = i % SIDE < SIDE / 2 ? 0.2 : 0.7;
            double off = path_ground_blocked(&f->ground[i]) - expected;
            *sum += off * off;
        }
    }
    assert_true(after * 25.0 < before); /* a fifth of the error, edge and all */
    path_film_destroy(f);
}

/* Shadows without noise keep their shape. */
static void noise_free_shadows_are_unchanged(void **state)
{
    (void)state;
    path_film *f = create(16, 4, true);
    for (uint32_t i = 0; i < 64; i++)
        for (int n = 0; n < 8 && i % 16 > 2; n++) { /* the first columns see no ground */
            path_sample s = {.ground_open = {1.0f, 1.0f, 1.0f}, .ground_lit = {0.0f, 0.0f, 0.0f}};
            for (int c = 0; c < 3; c++)
                s.ground_lit[c] = i % 16 < 8 ? 0.25f : 0.75f;
            path_film_add(f, i, &s);
        }
    assert_int_equal(path_film_denoise_ground(f, 1, NULL), FACET_OK);
    for (uint32_t i = 0; i < 64; i++)
        assert_near(path_ground_blocked(&f->ground[i]), i % 16 > 2 ? (i % 16 < 8 ? 0.75 : 0.25) : 0.0, 1e-6);
    path_film_destroy(f);
}

static void guides(void **state)
{
    (void)state;
    path_film *f = create(2, 1, false);
    for (int i = 0; i < 10; i++) {
        path_sample s = {.albedo = {0.5f, 0.25f, 1.0f},
                         .normal = {i % 2 ? 1.0f : 0.0f, i % 2 ? 0.0f : 1.0f, 0.0f}};
        if (i < 8)
            path_film_add(f, 0, &s);
        s.normal[0] = i % 2 ? 1.0f : -1.0f; /* opposite ones: none */
        s.normal[1] = 0.0f;
        path_film_add(f, 1, &s);
    }
    film target = resolve(f, 4.0f, 1);
    assert_true(at(&target, "albedo", 0) == 0.5f && at(&target, "albedo", 1) == 0.25f &&
                at(&target, "albedo", 2) == 1.0f);
    assert_near(at(&target, "normal", 0), sqrt(0.5), 1e-6);
    assert_near(at(&target, "normal", 1), sqrt(0.5), 1e-6);
    assert_true(at(&target, "normal", 2) == 0.0f);
    for (size_t c = 3; c < 6; c++)
        assert_true(at(&target, "normal", c) == 0.0f);
    film_destroy(&target);
    path_film_destroy(f);
}

/* ---- the ground ---- */

static path_sample ground(float lit, float open)
{
    path_sample s = {.opacity = 0.0f};
    for (int c = 0; c < 3; c++) {
        s.ground_lit[c] = lit;
        s.ground_open[c] = open;
    }
    return s;
}

static void shadows_lie_under_the_image(void **state)
{
    (void)state;
    path_film *f = create(5, 1, true);
    for (int i = 0; i < 64; i++) {
        path_sample half = ground(1.0f, 2.0f), open = ground(2.0f, 2.0f), dark = ground(0.0f, 2.0f);
        path_sample model = grey(1.0f), nothing = {.opacity = 0.0f}, bright = ground(3.0f, 2.0f);
        path_film_add(f, 0, &half);
        path_film_add(f, 1, i % 4 ? &half : &model);   /* three quarters are ground */
        path_film_add(f, 2, i % 2 ? &dark : &nothing); /* behind the other half is nothing */
        path_film_add(f, 3, &open);
        path_film_add(f, 4, &bright); /* light from the model */
    }
    film target = resolve(f, 1.0f, 1);
    const double opacity[5] = {0.5, 0.25 + 0.75 * 0.5, 0.5, 0.0, 0.0};
    for (size_t i = 0; i < 5; i++) {
        assert_near(at(&target, "", 4 * i + 3), opacity[i], 1e-6);
        assert_near(at(&target, "", 4 * i), i == 1 ? 0.25 : 0.0, 1e-6);
    }
    film_destroy(&target);
    path_film_destroy(f);
}

/* Ground where nothing is taken but for noise: a mean opacity of 0.4 standard errors if noise were only
 * clamped. A real shadow stays. */
static void noise_does_not_darken_the_ground(void **state)
{
    (void)state;
    enum { SIDE = 64, SAMPLES = 64 };
    path_film *f = create(SIDE, SIDE, true);
    uint64_t random = 5;
    for (size_t i = 0; i < SIDE * SIDE; i++)
        for (int k = 0; k < SAMPLES; k++) {
            double truth = i < SIDE * SIDE / 2 ? 0.0 : 0.5;
            path_sample s = ground((float)(1.0 - truth + 0.4 * normal(&random)), 1.0f);
            path_film_add(f, i, &s);
        }
    film target = resolve(f, 1.0f, 2);
    double open = 0.0, shadow = 0.0, error = 0.4 / sqrt((double)SAMPLES);
    for (size_t i = 0; i < SIDE * SIDE; i++)
        *(i < SIDE * SIDE / 2 ? &open : &shadow) += (double)at(&target, "", 4 * i + 3) / (SIDE * SIDE / 2);
    assert_true(open < 0.15 * error);
    assert_near(shadow, 0.5 - error * error / 0.5, 4.0 * error / sqrt(SIDE * SIDE / 2.0));
    film_destroy(&target);
    path_film_destroy(f);
}

/* ---- adaptive sampling ---- */

enum { WIDTH = 101, HEIGHT = 75, LARGEST = 4096 };

/* An image whose light and noise are known: dark to the left, noisy to the bottom. */
static double true_mean(size_t i)
{
    return 0.02 + 1.5 * (double)(i % WIDTH) / WIDTH;
}
static double true_deviation(size_t i)
{
    return 0.02 + 0.7 * (double)(i / WIDTH) / HEIGHT * true_mean(i);
}

typedef struct drawing {
    path_film *film;
    uint32_t goal;
} drawing;

static void draw_pixels(void *context, size_t begin, size_t end)
{
    const drawing *d = context;
    for (size_t i = begin; i < end; i++) {
        if (!path_film_needs_more(d->film, i))
            continue;
        for (uint32_t k = path_film_samples(d->film, i); k < d->goal; k++) {
            uint64_t random = (uint64_t)i << 32 | k;
            random *= 0x2545f4914f6cdd1du;
            /* a gamma distribution of shape 1/2: rare bright samples, as light has them */
            double z = normal(&random);
            path_sample s = grey((float)(true_mean(i) + true_deviation(i) * (z * z - 1.0) / sqrt(2.0)));
            path_film_add(d->film, i, &s);
        }
    }
}

static path_film *draw(float noise, float scale, uint32_t threads, uint32_t *passes)
{
    path_film *f = create(WIDTH, HEIGHT, false);
    path_film_set_scale(f, scale);
    uint32_t count = 0;
    for (uint32_t goal = 16; goal <= LARGEST; goal += 16, count++) {
        path_film_update(f, noise, threads);
        if (path_film_share_done(f) >= 1.0f)
            break;
        drawing d = {f, goal};
        parallel_for(threads, WIDTH * HEIGHT, 128, draw_pixels, &d);
    }
    path_film_update(f, noise, threads);
    if (passes)
        *passes = count;
    return f;
}

/* The error of what a display shows, against the truth: the share of blocks whose root mean square is
 * below noise, the largest one over noise, and the mean over the image in its standard errors. */
static double share_below(const path_film *f, float noise, float scale, double *worst, double *bias)
{
    *worst = 0.0;
    int blocks = 0, below = 0;
    double sum = 0.0, variance = 0.0;
    for (uint32_t row = 0; row < f->block_rows; row++)
        for (uint32_t column = 0; column < f->block_columns; column++, blocks++) {
            double square = 0.0;
            int count = 0;
            for (uint32_t y = row * 8; y < row * 8 + 8 && y < HEIGHT; y++)
                for (uint32_t x = column * 8; x < column * 8 + 8 && x < WIDTH; x++, count++) {
                    size_t i = (size_t)y * WIDTH + x;
                    double error = (double)path_pixel_mean(&f->pixels[i], 0) - true_mean(i);
                    double shown =
                        error * (double)scale / (2.0 * sqrt(true_mean(i) * (double)scale + 0.0025));
                    square += shown * shown;
                    sum += error;
                    variance += true_deviation(i) * true_deviation(i) / (double)f->pixels[i].samples;
                }
            *worst = fmax(*worst, sqrt(square / count) / (double)noise);
            below += square / count < (double)noise * (double)noise;
        }
    *bias = sum / sqrt(variance);
    return (double)below / blocks;
}

static void adaptive_sampling_reaches_the_noise(void **state)
{
    (void)state;
    const float noise[2] = {0.02f, 0.01f};
    uint64_t total[2];
    for (int k = 0; k < 2; k++) {
        uint32_t passes;
        path_film *f = draw(noise[k], 1.0f, 2, &passes);
        double bias, worst, share = share_below(f, noise[k], 1.0f, &worst, &bias);
        total[k] = path_film_total_samples(f);
        print_message("noise %.3f: %.0f samples a pixel, %.1f %% of blocks below it, the worst %.2f of it, "
                      "mean off by %.1f errors\n",
                      (double)noise[k], (double)total[k] / (WIDTH * HEIGHT), 100.0 * share, worst, bias);
        assert_true(path_film_share_done(f) == 1.0f && passes < LARGEST / 16);
        /* A block ends when its noise is about as requested; over its 64 pixels the estimate scatters by
         * a tenth. */
        assert_true(share > 0.75 && worst < 1.5);
        /* dark samples end a block early: the bias that stopping rules have is small */
        assert_true(fabs(bias) < 4.0);
        uint32_t most = 0, fewest = UINT32_MAX;
        for (size_t i = 0; i < WIDTH * HEIGHT; i++) {
            most = path_film_samples(f, i) > most ? path_film_samples(f, i) : most;
            fewest = path_film_samples(f, i) < fewest ? path_film_samples(f, i) : fewest;
        }
        assert_int_equal(fewest, 32);
        assert_true(most > 150);
        path_film_destroy(f);
    }
    /* half the noise: four times the samples, minus the minimum */
    assert_true(2 * total[1] > 5 * total[0] && 5 * total[1] < 21 * total[0]);
    /* darker, its noise is below the limit sooner */
    path_film *f = draw(0.01f, 0.1f, 2, NULL);
    assert_true(path_film_total_samples(f) < total[1] / 2);
    path_film_destroy(f);
}

static void adaptive_sampling_does_not_depend_on_threads(void **state)
{
    (void)state;
    path_film *one = draw(0.02f, 1.0f, 1, NULL), *four = draw(0.02f, 1.0f, 4, NULL);
    assert_memory_equal(one->pixels, four->pixels, WIDTH * HEIGHT * sizeof *one->pixels);
    film a = resolve(one, 1.5f, 1), b = resolve(four, 1.5f, 4);
    for (uint32_t l = 0; l < a.layer_count; l++)
        assert_memory_equal(a.layers[l].pixels, b.layers[l].pixels,
                            WIDTH * HEIGHT * a.layers[l].channel_count * sizeof(float));
    film_destroy(&a);
    film_destroy(&b);
    path_film_destroy(one);
    path_film_destroy(four);
}

static void fill(path_film *f, uint32_t samples, float even, float odd)
{
    for (size_t i = 0; i < (size_t)f->width * f->height; i++)
        for (uint32_t k = 0; k < samples; k++) {
            path_sample s = grey(k % 2 ? odd : even);
            path_film_add(f, i, &s);
        }
}

static void regions(void **state)
{
    (void)state;
    path_film *f = create(40, 24, false);
    fill(f, 31, 0.5f, 0.5f);
    path_film_update(f, 0.01f, 1); /* too few, however little noise */
    assert_true(path_film_share_done(f) == 0.0f && path_film_needs_more(f, 0));
    fill(f, 1, 0.5f, 0.5f);
    path_film_update(f, 0.01f, 1);
    assert_true(path_film_share_done(f) == 1.0f && !path_film_needs_more(f, 0));
    path_film_update(f, 0.0f, 1); /* no noise limit: all get as many */
    assert_true(path_film_share_done(f) == 0.0f && path_film_needs_more(f, 0));
    /* one wild pixel in the middle of the left edge's block: it and its five neighbors go on, the others
     * do not */
    for (int k = 0; k < 32; k++) {
        path_sample s = grey(k % 2 ? 1000.0f : 0.0f);
        path_film_add(f, 12 * 40 + 3, &s);
    }
    path_film_update(f, 0.01f, 1);
    for (size_t y = 0; y < 24; y++)
        for (size_t x = 0; x < 40; x++)
            assert_int_equal(path_film_needs_more(f, y * 40 + x), x < 16);
    assert_near(path_film_share_done(f), 24.0 / 40.0, 1e-6);
    path_film_destroy(f);
}

/* A noisy shadow on the ground counts as noise, too. */
static void noise_of_shadows_counts(void **state)
{
    (void)state;
    path_film *f = create(8, 8, true);
    for (size_t i = 0; i < 64; i++)
        for (int k = 0; k < 64; k++) {
            path_sample s = ground(k % 2 ? 1.0f : 0.0f, 1.0f);
            path_film_add(f, i, &s);
        }
    double error = 0.5 / sqrt(63.0);
    double opacity = 0.5 - error * error / 0.5, shown = error / (2.0 * sqrt(1.0 - opacity + 0.0025));
    path_film_update(f, (float)(shown * 0.999), 1);
    assert_true(path_film_needs_more(f, 0));
    path_film_update(f, (float)(shown * 1.001), 1);
    assert_false(path_film_needs_more(f, 0));
    path_film_destroy(f);
}

/* ---- memory ---- */

static void failed_allocations_are_reported(void **state)
{
    (void)state;
    assert_true(sizeof(path_pixel) <= 176 && sizeof(path_ground) <= 64); /* that exact sums take */
    for (long k = 0;; k = next_failure(k)) {
        failing_allocator failing = {.fail_at = k};
        facet_allocator allocator = failing_allocator_get(&failing);
        path_film *f;
        facet_error error;
        facet_result result = path_film_create(&allocator, 64, 64, true, &f, &error);
        path_film_destroy(f);
        assert_int_equal(failing.blocks, 0);
        if (result == FACET_OK) {
            assert_true(k >= 4);
            return;
        }
        assert_int_equal(result, FACET_ERROR_MEMORY);
        assert_null(f);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(means_keep_their_precision),
        cmocka_unit_test(variance_does_not_cancel),
        cmocka_unit_test(sums_do_not_depend_on_the_order),
        cmocka_unit_test(few_samples_have_an_estimate),
        cmocka_unit_test(a_pixel_can_be_full),
        cmocka_unit_test(non_finite_samples_are_black),
        cmocka_unit_test(huge_light_stays_finite),
        cmocka_unit_test(negative_filter_weights_are_kept),
        cmocka_unit_test(weights_divided_out),
        cmocka_unit_test(shadows_are_denoised_up_to_their_edge),
        cmocka_unit_test(noise_free_shadows_are_unchanged),
        cmocka_unit_test(guides),
        cmocka_unit_test(shadows_lie_under_the_image),
        cmocka_unit_test(noise_does_not_darken_the_ground),
        cmocka_unit_test(adaptive_sampling_reaches_the_noise),
        cmocka_unit_test(adaptive_sampling_does_not_depend_on_threads),
        cmocka_unit_test(regions),
        cmocka_unit_test(noise_of_shadows_counts),
        cmocka_unit_test(failed_allocations_are_reported),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
