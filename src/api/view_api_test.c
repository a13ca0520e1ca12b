/* view_api_test.c - facet_view() refuses what cannot be before it opens a window; path tracing shows its
 * passes. */
#include "facet/facet.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <string.h>

#include <cmocka.h>

static void what_cannot_be_is_refused(void **state)
{
    (void)state;
    const facet_view_desc wrong[] = {
        {.render = {.renderer = FACET_RENDERER_KIND_PREVIEW}},
        {.render = {.renderer = FACET_RENDERER_KIND_GL, .width = 20000, .height = 100}},
        {.render = {.renderer = FACET_RENDERER_KIND_GL, .exposure_ev = NAN}}};
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        facet_error error;
        assert_int_equal(facet_view(&wrong[i], &error), FACET_ERROR_ARGUMENT);
        assert_true(strlen(error.message) > 10);
    }
}

/* ---- passes ---- */

enum { WIDTH = 24, HEIGHT = 16, MOST = 8 };

typedef struct passes {
    uint32_t samples[MOST], count;
    float pixels[MOST][4 * WIDTH * HEIGHT];
} passes;

static void copy(const facet_image *image, float out[4 * WIDTH * HEIGHT])
{
    facet_image_view v = facet_image_get_layer(image, 0);
    assert_int_equal(v.width, WIDTH);
    assert_int_equal(v.height, HEIGHT);
    for (uint32_t y = 0; y < HEIGHT; y++)
        memcpy(out + (size_t)4 * WIDTH * y, (const char *)v.pixels + y * v.row_stride_bytes,
               4 * WIDTH * sizeof(float));
}

static void keep(void *user, const facet_image *image, uint32_t samples)
{
    passes *p = user;
    assert_true(p->count < MOST);
    p->samples[p->count] = samples;
    copy(image, p->pixels[p->count++]);
}

static facet_render_desc path_desc(uint32_t samples)
{
    return (facet_render_desc){.width = WIDTH,
                               .height = HEIGHT,
                               .renderer = FACET_RENDERER_KIND_PATH,
                               .samples = samples,
                               .background = FACET_BACKGROUND_COLOR,
                               .background_color = {0.5f, 0.2f, 0.1f},
                               .tonemap = FACET_TONEMAP_NEUTRAL};
}

/* A pass shows the image that is made with that many samples, to the last bit; looking changes nothing. */
static void passes_are_images_of_fewer_samples(void **state)
{
    (void)state;
    static passes seen;
    static float alone[4 * WIDTH * HEIGHT];
    static float whole[4 * WIDTH * HEIGHT];
    facet_scene *scene = NULL;
    facet_image *image = NULL;
    facet_environment *light = NULL;
    assert_int_equal(facet_scene_create_builtin(NULL, &scene, NULL), FACET_OK);
    assert_int_equal(facet_environment_create_constant((const float[]){1.0f, 1.0f, 1.0f}, NULL, &light, NULL),
                     FACET_OK);
    facet_render_desc desc = path_desc(12);
    desc.environment = light;
    desc.path.pass = keep;
    desc.path.pass_user = &seen;
    assert_int_equal(facet_render(scene, &desc, &image, NULL), FACET_OK);
    copy(image, whole);
    facet_image_destroy(image);
    assert_int_equal(seen.count, 4);
    for (uint32_t i = 0; i <= seen.count; i++) {
        desc = path_desc(i < seen.count ? seen.samples[i] : 12);
        desc.environment = light;
        assert_true(i == seen.count || seen.samples[i] == 1u << i);
        assert_int_equal(facet_render(scene, &desc, &image, NULL), FACET_OK);
        copy(image, alone);
        assert_memory_equal(alone, i < seen.count ? seen.pixels[i] : whole, sizeof alone);
        facet_image_destroy(image);
    }
    facet_environment_destroy(light);
    facet_scene_destroy(scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(what_cannot_be_is_refused),
                                       cmocka_unit_test(passes_are_images_of_fewer_samples)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
