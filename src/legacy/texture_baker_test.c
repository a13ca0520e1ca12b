/* texture_baker_test.c - statistics of images, bakes and shared results. */
#include "legacy/convert_test_support.h"
#include "legacy/texture_baker.h"

static const uint8_t TEXELS[] = {10, 20, 30, 255, 10, 20, 30, 0, 250, 20, 30, 255, 255, 255, 0, 0};

static texture_baker *baker_of(facet_scene *scene)
{
    texture_baker *baker = NULL;
    const bool wanted[TEST_MAX] = {true, true, true, true};
    assert_int_equal(texture_baker_create(scene, &baker, NULL), FACET_OK);
    assert_int_equal(texture_baker_survey(baker, wanted, &(facet_log){0}, NULL), FACET_OK);
    return baker;
}

static unsigned count_lines;
static void count_line(void *user, facet_log_level level, const char *message)
{
    (void)user, (void)level, (void)message;
    count_lines++;
}

/* An unreadable image is one warning; one above the size limit is a failure, not a white texture. */
static void unreadable_images_are_reported(void **state)
{
    (void)state;
    facet_scene *scene = gltf_scene(0);
    add_texels(scene, 2, 2, 4, TEXELS);
    add_texels(scene, 2, 2, 4, TEXELS);
    scene->images[1].size = 50;
    const bool wanted[TEST_MAX] = {true, true, true, true};
    const facet_log log = {.message = count_line};
    texture_baker *baker = NULL;
    facet_error error;
    count_lines = 0;
    assert_int_equal(texture_baker_create(scene, &baker, NULL), FACET_OK);
    assert_int_equal(texture_baker_survey(baker, wanted, &log, NULL), FACET_OK);
    assert_int_equal(count_lines, 1);
    texture_baker_destroy(baker);
    scene->max_texture_size = 1;
    assert_int_equal(texture_baker_create(scene, &baker, NULL), FACET_OK);
    assert_int_equal(texture_baker_survey(baker, wanted, &log, &error), FACET_ERROR_LIMIT);
    assert_non_null(strstr(error.message, "2 x 2 texels, more than 1 along an edge"));
    texture_baker_destroy(baker);
    scene_destroy(scene);
}

static void statistics_count_codes(void **state)
{
    (void)state;
    facet_scene *scene = gltf_scene(0);
    uint32_t texture = add_texels(scene, 2, 2, 4, TEXELS);
    uint32_t broken = add_texels(scene, 2, 2, 4, TEXELS);
    scene->images[1].size = 20;
    texture_baker *baker = baker_of(scene);
    const texture_statistics *s = texture_baker_statistics(baker, texture);
    assert_non_null(s);
    assert_null(texture_baker_statistics(baker, broken));
    assert_null(texture_baker_statistics(baker, SCENE_NONE));
    assert_int_equal(s->texel_count, 4);
    assert_true(s->has_alpha);
    assert_int_equal(s->histogram[TEXTURE_RED][10], 2);
    assert_int_equal(s->histogram[TEXTURE_GREY][20], 2);
    assert_int_equal(s->histogram[TEXTURE_GREY][170], 1); /* (255 + 255 + 0) / 3 */
    assert_int_equal(s->histogram[TEXTURE_ALPHA][0] + s->histogram[TEXTURE_ALPHA][255], s->texel_count);
    for (int code = 0; code < 256; code++) {
        assert_true(code >= 10 || s->histogram[TEXTURE_RED][code] == 0);
        assert_true(code <= 30 || s->histogram[TEXTURE_BLUE][code] == 0);
    }
    assert_int_equal(texture_percentile(s, TEXTURE_RED, .5), 10);
    assert_int_equal(texture_percentile(s, TEXTURE_RED, .7), 250);
    assert_int_equal(texture_percentile(s, TEXTURE_RED, .9), 255);
    float codes[256];
    for (int i = 0; i < 256; i++)
        codes[i] = (float)i;
    assert_near(texture_mean(s, TEXTURE_RED, codes), (10 + 10 + 250 + 255) / 4.0, 1e-9);
    texture_baker_destroy(baker);
    scene_destroy(scene);
}

/* Images are counted row by row, with equal results for any layout, without memory for all texels. */
static void large_images_are_counted_in_little_memory(void **state)
{
    (void)state;
    for (image_type type = IMAGE_U8; type <= IMAGE_U16; type++)
        for (uint32_t channels = 1; channels <= 4; channels++) {
            facet_scene *scene = gltf_scene(0);
            uint32_t texture = add_texels(scene, 2, 2, 4, TEXELS);
            image i;
            unsigned char *bytes;
            assert_int_equal(image_create(NULL, 1024, 512, channels, type, &i, NULL), FACET_OK);
            i.is_srgb = true;
            memset(i.pixels, 100, image_row_size(&i) * i.height);
            assert_int_equal(image_encode(&i, IMAGE_CODEC_PNG, NULL, &bytes, &scene->images[0].size, NULL),
                             FACET_OK);
            image_destroy(&i);
            scene->images[0].bytes = bytes;
            facet_budget *budget;
            assert_int_equal(facet_budget_create(400 << 10, &budget, NULL), FACET_OK);
            const facet_allocator kept = scene->allocator;
            scene->allocator = facet_budget_allocator(budget);
            texture_baker *baker = baker_of(scene);
            const texture_statistics *s = texture_baker_statistics(baker, texture);
            assert_non_null(s);
            assert_int_equal(s->texel_count, 1024 * 512);
            assert_int_equal(s->width, 1024);
            assert_int_equal(s->height, 512);
            assert_int_equal(s->histogram[TEXTURE_RED][100], 1024 * 512);
            assert_int_equal(s->histogram[TEXTURE_GREY][100], 1024 * 512);
            assert_int_equal(s->has_alpha, channels % 2 == 0);
            texture_baker_destroy(baker);
            scene->allocator = kept;
            facet_budget_destroy(budget);
            scene_destroy(scene);
            mem_free(bytes);
        }
}

/* Sums of the inputs and the parameter. */
static void add_row(const void *parameters, uint32_t width, const uint8_t *const *in, uint8_t *out)
{
    int plus = *(const int *)parameters;
    for (uint32_t x = 0; x < width; x++) {
        out[x * 3] = (uint8_t)(in[0][x * 4] + plus);
        out[x * 3 + 1] = in[1] ? in[1][x * 4] : 7;
        out[x * 3 + 2] = 0;
    }
}

static uint32_t bake(texture_baker *baker, uint32_t first, uint32_t second, int plus)
{
    uint32_t out = SCENE_NONE;
    texture_bake job = {.name = "made",
                        .inputs = {first, second},
                        .input_count = 2,
                        .channel_count = 3,
                        .row = add_row,
                        .parameters = &plus,
                        .parameter_size = sizeof plus};
    assert_int_equal(texture_baker_bake(baker, &job, &out, NULL), FACET_OK);
    return out;
}

static void bakes_are_shared_and_sized(void **state)
{
    (void)state;
    const uint8_t small[] = {0, 100};
    facet_scene *scene = gltf_scene(0);
    uint32_t large = add_texels(scene, 2, 2, 4, TEXELS);
    uint32_t pair = add_texels(scene, 2, 1, 1, small);
    scene->textures[large].wrap_u = SCENE_WRAP_MIRROR;
    texture_baker *baker = baker_of(scene);
    uint32_t a = bake(baker, large, pair, 3);
    uint32_t b = bake(baker, large, pair, 3);
    uint32_t c = bake(baker, large, pair, 4);
    uint32_t d = bake(baker, large, SCENE_NONE, 3);
    assert_int_equal(a, 2);
    assert_int_equal(b, a);
    assert_int_equal(c, 3);
    assert_int_equal(d, 4);
    assert_int_equal(texture_baker_made(baker), 3);
    assert_int_equal(texture_baker_shared(baker), 1);
    assert_int_equal(bake(baker, SCENE_NONE, SCENE_NONE, 3), SCENE_NONE);
    assert_int_equal(scene->texture_count, 2); /* only at the end */
    assert_int_equal(texture_baker_finish(baker, NULL), FACET_OK);
    assert_int_equal(scene->texture_count, 5);
    assert_int_equal(scene->image_count, 5);
    assert_string_equal(scene->images[2].mime_type, "image/png");
    assert_int_equal(scene->images[2].width, 2);
    assert_int_equal(scene->textures[a].wrap_u, SCENE_WRAP_MIRROR);
    uint8_t t[4];
    texel_at(scene, a, 2, t);
    assert_int_equal(t[0], 253);
    assert_int_equal(t[1], 0);
    texel_at(scene, d, 3, t);
    assert_int_equal(t[1], 7);
    texture_baker_destroy(baker);
    scene_destroy(scene);
}

static void resizing_wraps_as_the_sampler_does(void **state)
{
    (void)state;
    const uint8_t pair[] = {0, 200};
    const uint8_t wide[] = {0, 0, 0, 0};
    facet_scene *scene = gltf_scene(0);
    uint32_t large = add_texels(scene, 4, 1, 1, wide);
    uint32_t repeats = add_texels(scene, 2, 1, 1, pair);
    uint32_t clamps = add_texels(scene, 2, 1, 1, pair);
    scene->textures[clamps].wrap_u = SCENE_WRAP_CLAMP;
    texture_baker *baker = baker_of(scene);
    uint32_t a = bake(baker, large, repeats, 0);
    uint32_t b = bake(baker, large, clamps, 0);
    assert_int_equal(texture_baker_finish(baker, NULL), FACET_OK);
    /* Centers of four texels lie at -1/4, 1/4, 3/4, 5/4 of two. */
    const uint8_t repeated[] = {50, 50, 150, 150};
    const uint8_t clamped[] = {0, 50, 150, 200};
    for (size_t i = 0; i < 4; i++) {
        uint8_t t[4];
        texel_at(scene, a, i, t);
        assert_int_equal(t[1], repeated[i]);
        texel_at(scene, b, i, t);
        assert_int_equal(t[1], clamped[i]);
    }
    texture_baker_destroy(baker);
    scene_destroy(scene);
}

static void flat_heights_point_up_and_edges_wrap(void **state)
{
    (void)state;
    const uint8_t step[] = {0, 255, 255, 255};
    facet_scene *scene = gltf_scene(0);
    uint32_t texture = add_texels(scene, 4, 1, 1, step);
    texture_baker *baker = baker_of(scene);
    uint32_t made;
    texture_relief relief = {
        .name = "n", .texture = texture, .weights = {1, 0, 0, 0}, .gain = 1, .slope = .5f};
    assert_int_equal(texture_baker_relief(baker, &relief, &made, NULL), FACET_OK);
    assert_int_equal(texture_baker_finish(baker, NULL), FACET_OK);
    uint8_t t[4];
    texel_at(scene, made, 2, t);
    assert_int_equal(t[0], 128); /* flat */
    assert_int_equal(t[2], 255);
    texel_at(scene, made, 1, t); /* rises to the right: the normal leans to the left, 45 degrees */
    assert_near(t[0] / 255.0 * 2 - 1, -sqrt(.5), 1.0 / 255);
    texel_at(scene, made, 3, t); /* falls to the first texel, behind the edge */
    assert_near(t[0] / 255.0 * 2 - 1, sqrt(.5), 1.0 / 255);
    texture_baker_destroy(baker);
    scene_destroy(scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(unreadable_images_are_reported),
        cmocka_unit_test(statistics_count_codes),
        cmocka_unit_test(large_images_are_counted_in_little_memory),
        cmocka_unit_test(bakes_are_shared_and_sized),
        cmocka_unit_test(resizing_wraps_as_the_sampler_does),
        cmocka_unit_test(flat_heights_point_up_and_edges_wrap),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
