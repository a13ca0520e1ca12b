/* denoise_test.c - film_denoise() removes noise and keeps the rest. */
#include <float.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "tests/support/support.h"
#include "film/film.h"
#include "film/denoise_fixture.h"

static const uint32_t guides = FACET_AOV_ALBEDO | FACET_AOV_NORMAL | FACET_AOV_VARIANCE;

/* ---- images of a known truth ---- */

typedef struct pixel_truth {
    float light, albedo, normal[3];
} pixel_truth;

/* A film of the mean of 16 samples per pixel, each light * albedo * a factor of mean 1: 1 - amount +
 * amount times an exponentially distributed number. The noise-free values go to a film of their own. */
static film noisy_film(uint32_t width, uint32_t height, pixel_truth (*at)(uint32_t x, uint32_t y),
                       float amount, uint32_t seed, film *truth)
{
    enum { SAMPLES = 16 };
    film f;
    assert_int_equal(film_create(NULL, width, height, guides, &f, NULL), FACET_OK);
    uint32_t random = seed;
    for (size_t i = 0; i < (size_t)width * height; i++) {
        pixel_truth t = at((uint32_t)(i % width), (uint32_t)(i / width));
        double sum[3] = {0}, square[3] = {0};
        for (int k = 0; k < SAMPLES; k++)
            for (int c = 0; c < 3; c++) {
                float value = t.light * t.albedo * (1.0f - amount - amount * logf(1.0f - lcg_float(&random)));
                sum[c] += (double)value;
                square[c] += (double)value * (double)value;
            }
        for (size_t c = 0; c < 3; c++) {
            double mean = sum[c] / SAMPLES;
            f.layers[0].pixels[4 * i + c] = (float)mean;
            film_find(&f, "variance")->pixels[3 * i + c] =
                (float)fmax(0.0, (square[c] / SAMPLES - mean * mean) / (SAMPLES - 1));
            film_find(&f, "albedo")->pixels[3 * i + c] = t.albedo;
            film_find(&f, "normal")->pixels[3 * i + c] = t.normal[c];
        }
        f.layers[0].pixels[4 * i + 3] = 1.0f;
    }
    if (truth) {
        *truth = fixture_copy(&f);
        for (size_t i = 0; i < (size_t)width * height; i++) {
            pixel_truth t = at((uint32_t)(i % width), (uint32_t)(i / width));
            for (size_t c = 0; c < 3; c++) {
                truth->layers[0].pixels[4 * i + c] = t.light * t.albedo;
                film_find(truth, "variance")->pixels[3 * i + c] = 0.0f;
            }
        }
    }
    return f;
}

static void denoise(film *f)
{
    facet_error error = {0};
    assert_int_equal(film_denoise(f, NULL, 2, &error), FACET_OK);
}

static double remaining_error(film *f, const film *truth)
{
    double before = fixture_error(f, truth, false);
    denoise(f);
    return fixture_error(f, truth, false) / before;
}

static pixel_truth plain_wall(uint32_t x, uint32_t y)
{
    return (pixel_truth){
        .light = 1.0f + 0.01f * (float)x + 0.005f * (float)y, .albedo = 0.5f, .normal = {0, 0, 1}};
}

/* Every texel another color. */
static pixel_truth grainy_wall(uint32_t x, uint32_t y)
{
    uint32_t random = x * 7919u + y * 104729u;
    lcg_float(&random);
    lcg_float(&random);
    return (pixel_truth){
        .light = 1.0f + 0.01f * (float)x, .albedo = 0.1f + 0.8f * lcg_float(&random), .normal = {0, 0, 1}};
}

/* Two walls of a corner, differently lit. */
static pixel_truth corner(uint32_t x, uint32_t y)
{
    (void)y;
    return x < 32 ? (pixel_truth){.light = 1.0f, .albedo = 0.5f, .normal = {0, 0, 1}}
                  : (pixel_truth){.light = 0.3f, .albedo = 0.5f, .normal = {1, 0, 0}};
}

/* A shadow's edge, which albedo and normal do not show. */
static pixel_truth shadow(uint32_t x, uint32_t y)
{
    (void)y;
    return (pixel_truth){.light = x < 32 ? 2.0f : 0.4f, .albedo = 0.5f, .normal = {0, 1, 0}};
}

/* A highlight five pixels wide. */
static pixel_truth highlight(uint32_t x, uint32_t y)
{
    float d = ((float)x - 32.0f) * ((float)x - 32.0f) + ((float)y - 24.0f) * ((float)y - 24.0f);
    return (pixel_truth){.light = 0.5f + 8.0f * expf(-d / 8.0f), .albedo = 0.5f, .normal = {0, 0, 1}};
}

enum { WIDTH = 64, HEIGHT = 48 };

/* Noise of 7 to 25 % of the radiance. A fit of nine terms to 225 similar pixels leaves at least sqrt(9 /
 * 225) = 0.2 of it, overlapping windows somewhat less. A highlight of five pixels has few similar ones. */
static void known_radiance_is_recovered_from_noise(void **state)
{
    (void)state;
    static const struct {
        pixel_truth (*at)(uint32_t x, uint32_t y);
        float amount;
        double most;
    } cases[] = {
        {plain_wall, 1.0f, 0.2}, {grainy_wall, 1.0f, 0.3}, {corner, 1.0f, 0.25},   {shadow, 0.3f, 0.4},
        {plain_wall, 0.3f, 0.2}, {grainy_wall, 0.3f, 0.3}, {highlight, 0.3f, 0.9}, {shadow, 1.0f, 0.5},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        film truth;
        film f = noisy_film(WIDTH, HEIGHT, cases[i].at, cases[i].amount, 5 + (uint32_t)i, &truth);
        double remaining = remaining_error(&f, &truth);
        if (remaining > cases[i].most)
            fail_msg("case %zu: %.3f of the error remains", i, remaining);
        film_destroy(&f);
        film_destroy(&truth);
    }
}

/* The mean of a column of red. */
static double column_mean(const film *f, uint32_t x)
{
    double sum = 0.0;
    for (uint32_t y = 0; y < f->height; y++)
        sum += (double)f->layers[0].pixels[4 * ((size_t)y * f->width + x)];
    return sum / (double)f->height;
}

/* The pixels on both sides of an edge keep their light, within 3 standard errors of a column of the noisy
 * image. */
static void edges_stay_sharp(void **state)
{
    (void)state;
    static pixel_truth (*const at[])(uint32_t, uint32_t) = {corner, shadow};
    for (size_t i = 0; i < 2; i++) {
        film truth;
        film f = noisy_film(WIDTH, HEIGHT, at[i], 0.3f, 11, &truth);
        denoise(&f);
        for (uint32_t x = 30; x < 34; x++) {
            double t = column_mean(&truth, x);
            assert_near(column_mean(&f, x), t, 3.0 * t * 0.3 / 4.0 / sqrt(HEIGHT));
        }
        film_destroy(&f);
        film_destroy(&truth);
    }
}

/* Each texel's light, image over albedo, is that of its neighbours, to a third of the noise of 12.5 %: the
 * texture is as sharp as it was. */
static void textures_stay_sharp(void **state)
{
    (void)state;
    film f = noisy_film(WIDTH, HEIGHT, grainy_wall, 0.5f, 3, NULL);
    denoise(&f);
    double sum = 0.0;
    for (uint32_t y = 0; y < HEIGHT; y++)
        for (uint32_t x = 0; x < WIDTH; x++) {
            pixel_truth t = grainy_wall(x, y);
            double light = (double)(f.layers[0].pixels[4 * (y * WIDTH + x)] / (t.albedo * t.light));
            sum += (light - 1.0) * (light - 1.0);
        }
    assert_true(sqrt(sum / (WIDTH * HEIGHT)) < 0.125 / 3.0);
    film_destroy(&f);
}

/* ---- images of real noise ---- */

/* Relative to the light (Rousselle et al. 2011) and absolute; the remaining absolute error is mostly
 * that of edges, which are as rough as 16 samples make them: color and guides share their samples. In
 * the last one surfaces come and go by chance, which the guides say too, and the noise of that stays. */
static void errors_of_traced_images_fall(void **state)
{
    (void)state;
    static const struct {
        fixture_scene scene;
        double most, most_relative;
    } cases[] = {
        {FIXTURE_BOX, 0.5, 0.3},
        {FIXTURE_LIGHTS, 0.4, 0.25},
        {FIXTURE_SKY, 0.7, 0.8},
        {FIXTURE_CUTOUT, 0.85, 0.95},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        film truth = fixture_render(cases[i].scene, 80, 60, 160, 77);
        film f = fixture_render(cases[i].scene, 80, 60, 16, 1);
        double before = fixture_error(&f, &truth, false), relative = fixture_error(&f, &truth, true);
        denoise(&f);
        double remaining = fixture_error(&f, &truth, false) / before;
        double remaining_relative = fixture_error(&f, &truth, true) / relative;
        if (remaining > cases[i].most || remaining_relative > cases[i].most_relative)
            fail_msg("%s: %.3f and %.3f of the errors remain", fixture_scene_names[cases[i].scene], remaining,
                     remaining_relative);
        film_destroy(&f);
        film_destroy(&truth);
    }
}

/* Weights by similarity and damped outliers alone would make images too dark: here by 4 % and more. */
static void energy_is_kept(void **state)
{
    (void)state;
    static const fixture_scene scenes[] = {FIXTURE_BOX, FIXTURE_LIGHTS};
    for (size_t k = 0; k < 2; k++) {
        film f = fixture_render(scenes[k], 128, 96, 16, 1);
        double sums[2] = {0};
        for (int pass = 0; pass < 2; pass++) {
            if (pass)
                denoise(&f);
            for (size_t i = 0; i < 4 * 128 * 96; i++)
                sums[pass] += i % 4 < 3 ? (double)f.layers[0].pixels[i] : 0.0;
        }
        assert_near(sums[1] / sums[0], 1.0, 0.02);
        film_destroy(&f);
    }
}

/* A spot of 50 times the radiance, from one sample: it is removed, and its neighbors do not become
 * brighter. */
static void fireflies_are_removed(void **state)
{
    (void)state;
    film truth;
    film f = noisy_film(WIDTH, HEIGHT, plain_wall, 0.5f, 9, &truth);
    static const uint32_t places[][2] = {{20, 20}, {0, 0}, {63, 30}, {40, 47}};
    for (size_t k = 0; k < 4; k++)
        for (size_t c = 0; c < 3; c++) {
            size_t i = places[k][1] * WIDTH + places[k][0];
            f.layers[0].pixels[4 * i + c] = 30.0f;
            film_find(&f, "variance")->pixels[3 * i + c] = 900.0f;
        }
    denoise(&f);
    for (size_t i = 0; i < 4 * WIDTH * HEIGHT; i++)
        assert_near(f.layers[0].pixels[i], truth.layers[0].pixels[i], 0.3);
    film_destroy(&f);
    film_destroy(&truth);
}

/* Highlights of two and of four pixels, the sun in chrome: as noisy as they are, what is beside them is not: less than
 * a hundredth of their light spreads there, and they stay highlights. */
static void highlights_do_not_spread(void **state)
{
    (void)state;
    film truth;
    film f = noisy_film(WIDTH, HEIGHT, plain_wall, 0.1f, 9, &truth);
    static const uint32_t places[][2] = {{20, 20}, {21, 20}, {40, 30}, {41, 30}, {40, 31}, {41, 31}};
    enum { PLACES = sizeof places / sizeof *places };
    for (size_t k = 0; k < PLACES; k++)
        for (size_t c = 0; c < 3; c++) {
            size_t i = places[k][1] * WIDTH + places[k][0];
            f.layers[0].pixels[4 * i + c] = 400.0f;
            film_find(&f, "variance")->pixels[3 * i + c] = 200.0f * 200.0f;
        }
    denoise(&f);
    float most = 0.0f;
    for (uint32_t i = 0; i < WIDTH * HEIGHT; i++) {
        bool is_highlight = false;
        for (size_t k = 0; k < PLACES; k++)
            is_highlight = is_highlight || i == places[k][1] * WIDTH + places[k][0];
        float change = fabsf(f.layers[0].pixels[4 * i] - truth.layers[0].pixels[4 * i]);
        most = !is_highlight && change > most ? change : most;
        assert_true(!is_highlight || f.layers[0].pixels[4 * i] > 200.0f);
    }
    print_message("beside highlights of 400: %.3f\n", (double)most);
    assert_true(most < 4.0f);
    film_destroy(&f);
    film_destroy(&truth);
}

/* ---- kept properties ---- */

static void clean_images_keep_their_bits(void **state)
{
    (void)state;
    film f = noisy_film(WIDTH, HEIGHT, grainy_wall, 1.0f, 21, NULL);
    memset(film_find(&f, "variance")->pixels, 0, 3 * WIDTH * HEIGHT * sizeof(float));
    for (size_t i = 0; i < WIDTH * HEIGHT; i += 3)
        f.layers[0].pixels[4 * i + 3] = 0.25f * (float)(i % 5);
    film before = fixture_copy(&f);
    denoise(&f);
    assert_memory_equal(f.layers[0].pixels, before.layers[0].pixels, 4 * WIDTH * HEIGHT * sizeof(float));
    film_destroy(&f);
    film_destroy(&before);
}

/* As variance falls the samples are trusted: a pixel never changes by more than 8 standard deviations. */
static void the_filter_fades_out_as_variance_falls(void **state)
{
    (void)state;
    film f = noisy_film(WIDTH, HEIGHT, grainy_wall, 1.0f, 23, NULL);
    for (size_t i = 0; i < 3 * WIDTH * HEIGHT; i++) {
        film_find(&f, "variance")->pixels[i] = 1e-10f;
        film_find(&f, "albedo")->pixels[i] = 1.0f;
    }
    film before = fixture_copy(&f);
    denoise(&f);
    for (size_t i = 0; i < 4 * WIDTH * HEIGHT; i++)
        assert_near(f.layers[0].pixels[i], before.layers[0].pixels[i], 8.1e-5);
    film_destroy(&f);
    film_destroy(&before);
}

/* Opacity keeps its bits, nothing comes of nothing, and at the edges, where the image may be laid over
 * anything, color over opacity gets no noisier: there are no fringes. */
static void opacity_is_kept(void **state)
{
    (void)state;
    film truth = fixture_render(FIXTURE_CUTOUT, 80, 60, 160, 7);
    film f = fixture_render(FIXTURE_CUTOUT, 80, 60, 16, 2);
    film before = fixture_copy(&f);
    denoise(&f);
    double errors[2] = {0};
    size_t empty_count = 0, edge_count = 0;
    for (size_t i = 0; i < 80 * 60; i++) {
        const float *old = before.layers[0].pixels + 4 * i, *now = f.layers[0].pixels + 4 * i;
        const float *t = truth.layers[0].pixels + 4 * i;
        assert_true(now[3] == old[3]);
        if (old[3] == 0.0f) {
            assert_memory_equal(now, old, 4 * sizeof *now);
            empty_count++;
        } else if (old[3] < 1.0f) {
            for (int c = 0; c < 3; c++) {
                double light = (double)(t[c] / t[3]);
                errors[0] += ((double)(old[c] / old[3]) - light) * ((double)(old[c] / old[3]) - light);
                errors[1] += ((double)(now[c] / old[3]) - light) * ((double)(now[c] / old[3]) - light);
            }
            edge_count++;
        }
    }
    assert_in_range(empty_count, 1000, 80 * 60);
    assert_in_range(edge_count, 100, 80 * 60);
    if (errors[1] > errors[0])
        fail_msg("error over opacity from %.3f to %.3f", sqrt(errors[0]), sqrt(errors[1]));
    film_destroy(&f);
    film_destroy(&before);
    film_destroy(&truth);
}

/* ---- independence ---- */

static void scale(film *f, float factor)
{
    for (size_t i = 0; i < 4 * (size_t)f->width * f->height; i++)
        if (i % 4 < 3)
            f->layers[0].pixels[i] *= factor;
    for (size_t i = 0; i < 3 * (size_t)f->width * f->height; i++)
        film_find(f, "variance")->pixels[i] *= factor * factor;
}

static void results_do_not_depend_on_units(void **state)
{
    (void)state;
    film one = fixture_render(FIXTURE_BOX, 48, 36, 16, 1);
    film noisy = fixture_copy(&one);
    denoise(&one);
    static const float factors[] = {0x1p-20f, 0x1p30f, 3.7f, 1e-5f, 1e12f};
    for (size_t k = 0; k < sizeof factors / sizeof *factors; k++) {
        film other = fixture_copy(&noisy);
        scale(&other, factors[k]);
        denoise(&other);
        for (size_t i = 0; i < 4 * 48 * 36; i++) {
            double expected = (double)one.layers[0].pixels[i] * (i % 4 < 3 ? (double)factors[k] : 1.0);
            double tolerance =
                k < 2 ? 0.0 : 2e-3 * fabs(expected) + (i % 4 < 3 ? 1e-4 * (double)factors[k] : 0.0);
            assert_near(other.layers[0].pixels[i], expected, tolerance);
        }
        film_destroy(&other);
    }
    film_destroy(&one);
    film_destroy(&noisy);
}

static void results_do_not_depend_on_threads(void **state)
{
    (void)state;
    film one = fixture_render(FIXTURE_SKY, 149, 83, 4, 3);
    film many = fixture_copy(&one);
    assert_int_equal(film_denoise(&one, NULL, 1, NULL), FACET_OK);
    assert_int_equal(film_denoise(&many, NULL, 7, NULL), FACET_OK);
    assert_memory_equal(one.layers[0].pixels, many.layers[0].pixels, 149 * 83 * 4 * sizeof(float));
    film_destroy(&one);
    film_destroy(&many);
}

/* ---- invalid pixels ---- */

/* Two invalid pixels do not affect pixels beyond two radii of a window and the extent of the noise
 * estimate. */
static void invalid_pixels_do_not_spread(void **state)
{
    (void)state;
    enum { REACH = 18 };
    static const float odd[] = {NAN, INFINITY, -INFINITY, FLT_MAX, -FLT_MAX, -1.0f, 1e-40f};
    static const char *const names[] = {"", "albedo", "normal", "variance"};
    for (size_t k = 0; k < sizeof odd / sizeof *odd; k++)
        for (size_t l = IS_SLOW ? k % 4 : 0; l < sizeof names / sizeof *names; l += IS_SLOW ? 4 : 1) {
            film f = noisy_film(60, 20, plain_wall, 0.5f, 33, NULL);
            film clean = fixture_copy(&f);
            film_layer *layer = film_find(&f, names[l]);
            for (size_t i = 10 * 60 + 20; i < 10 * 60 + 22; i++)
                layer->pixels[layer->channel_count * i + l % 3] = odd[k];
            denoise(&f);
            denoise(&clean);
            bool is_light = l == 0 && fabsf(odd[k]) == FLT_MAX; /* is in the image's mean */
            for (size_t i = 0; i < 4 * 60 * 20; i++) {
                float value = f.layers[0].pixels[i];
                assert_true(isfinite(value));
                size_t x = i / 4 % 60;
                bool is_far = x < 20 - REACH || x > 21 + REACH;
                if (is_far && !is_light)
                    assert_near(value, clean.layers[0].pixels[i], 2e-3);
            }
            film_destroy(&f);
            film_destroy(&clean);
        }
}

static void films_of_invalid_pixels_become_finite(void **state)
{
    (void)state;
    static const float odd[] = {NAN, INFINITY, -1.0f, 0.0f, FLT_MAX};
    for (size_t k = 0; k < sizeof odd / sizeof *odd; k++) {
        film f = noisy_film(20, 20, plain_wall, 0.5f, 1, NULL);
        for (uint32_t l = 0; l < f.layer_count; l++)
            for (size_t i = 0; i < 400 * (size_t)f.layers[l].channel_count; i++)
                f.layers[l].pixels[i] = odd[k];
        denoise(&f);
        for (size_t i = 0; i < 1600; i++)
            assert_true(isfinite(f.layers[0].pixels[i]));
        film_destroy(&f);
    }
}

static void small_films_are_filtered(void **state)
{
    (void)state;
    static const uint32_t sizes[][2] = {{1, 1}, {1, 40}, {40, 1}, {2, 3}, {33, 5}, {15, 64}};
    for (size_t k = 0; k < sizeof sizes / sizeof *sizes; k++) {
        film truth;
        film f = noisy_film(sizes[k][0], sizes[k][1], plain_wall, 1.0f, 4, &truth);
        double remaining = remaining_error(&f, &truth);
        assert_true(remaining <= (sizes[k][0] * sizes[k][1] > 100 ? 0.5 : 1.001));
        film_destroy(&f);
        film_destroy(&truth);
    }
}

static void missing_layers_are_errors(void **state)
{
    (void)state;
    static const uint32_t aovs[] = {0, FACET_AOV_ALBEDO, FACET_AOV_ALBEDO | FACET_AOV_NORMAL,
                                    FACET_AOV_NORMAL | FACET_AOV_VARIANCE,
                                    FACET_AOV_ALBEDO | FACET_AOV_VARIANCE};
    static const char *const missing[] = {"albedo", "normal", "variance", "albedo", "normal"};
    for (size_t k = 0; k < sizeof aovs / sizeof *aovs; k++) {
        film f;
        facet_error error = {0};
        assert_int_equal(film_create(NULL, 4, 4, aovs[k], &f, NULL), FACET_OK);
        assert_int_equal(film_denoise(&f, NULL, 1, &error), FACET_ERROR_ARGUMENT);
        assert_non_null(strstr(error.message, missing[k]));
        film_destroy(&f);
    }
}

/* Each refused block is an error that leaves the image alone and gives all blocks back. */
static void running_out_of_memory_leaks_nothing(void **state)
{
    (void)state;
    film f = noisy_film(40, 30, plain_wall, 0.5f, 33, NULL);
    film before = fixture_copy(&f);
    for (long n = 0;; n = next_failure(n)) {
        failing_allocator source = {.fail_at = n};
        facet_allocator allocator = failing_allocator_get(&source);
        facet_result result = film_denoise(&f, &allocator, 2, NULL);
        assert_int_equal(source.blocks, 0);
        if (result == FACET_OK) {
            assert_in_range(n, 2, 10);
            break;
        }
        assert_int_equal(result, FACET_ERROR_MEMORY);
        assert_memory_equal(f.layers[0].pixels, before.layers[0].pixels, 4 * 40 * 30 * sizeof(float));
    }
    film_destroy(&f);
    film_destroy(&before);
}

static void *count_bytes(void *user, size_t size)
{
    *(size_t *)user += size;
    return malloc(size);
}

static void release_bytes(void *user, void *memory, size_t size)
{
    (void)user;
    (void)size;
    free(memory);
}

static void memory_is_bounded(void **state)
{
    (void)state;
    size_t bytes = 0;
    facet_allocator allocator = {.user = &bytes, .allocate = count_bytes, .release = release_bytes};
    film f;
    assert_int_equal(film_create(NULL, 640, 360, guides, &f, NULL), FACET_OK);
    assert_int_equal(film_denoise(&f, &allocator, 2, NULL), FACET_OK);
    assert_in_range(bytes, 1, 100 * 640 * 360);
    film_destroy(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(known_radiance_is_recovered_from_noise),
        cmocka_unit_test(edges_stay_sharp),
        cmocka_unit_test(textures_stay_sharp),
        cmocka_unit_test(errors_of_traced_images_fall),
        cmocka_unit_test(energy_is_kept),
        cmocka_unit_test(fireflies_are_removed),
        cmocka_unit_test(highlights_do_not_spread),
        cmocka_unit_test(clean_images_keep_their_bits),
        cmocka_unit_test(the_filter_fades_out_as_variance_falls),
        cmocka_unit_test(opacity_is_kept),
        cmocka_unit_test(results_do_not_depend_on_units),
        cmocka_unit_test(results_do_not_depend_on_threads),
        cmocka_unit_test(invalid_pixels_do_not_spread),
        cmocka_unit_test(films_of_invalid_pixels_become_finite),
        cmocka_unit_test(small_films_are_filtered),
        cmocka_unit_test(missing_layers_are_errors),
        cmocka_unit_test(running_out_of_memory_leaks_nothing),
        cmocka_unit_test(memory_is_bounded),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
