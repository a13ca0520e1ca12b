/* gl_renderer_test.c - images of gl_renderer.h: crops, tiles, samples, layers as in the preview, windows.
 * Exits with 77 where there is no OpenGL. */
#include <epoxy/gl.h>
#include <math.h>
#include <stdlib.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <string.h>

#include <cmocka.h>

#include "gl/scene/gl_fixture_test.h"
#include "gl/scene/gl_camera.h"

static gl_fixture_contexts contexts;

static void on_each(void (*check)(fixture *f, gl_context *context))
{
    for (int i = 0; i < contexts.count; i++) {
        fixture f = gl_fixture_scene();
        check(&f, &contexts.items[i]);
        fixture_destroy(&f);
    }
}

/* ---- the preview ---- */

static void check_preview(fixture *f, gl_context *context)
{
    static const uint32_t samples[] = {1, 4};
    for (int i = 0; i < 2; i++) {
        f->desc.samples = samples[i];
        film ours = gl_fixture_render(f, context), theirs = fixture_render(f);
        image_difference d = gl_fixture_compare(&ours, &theirs, 0.02f);
        if (d.mean > 0.002 || d.share > 0.02)
            fail_msg("%u samples: mean difference %g, %g of the pixels by more than 0.02", samples[i], d.mean,
                     d.share);
        size_t different = 0; /* the same samples; some lie within 1 / 256 of an edge */
        for (size_t k = 0; k < 96 * 64; k++)
            different += fabsf(ours.layers[0].pixels[4 * k + 3] - theirs.layers[0].pixels[4 * k + 3]) > 1e-5f;
        if (context->has_clip_control)
            assert_in_range(different, 0, 6);
        film_destroy(&ours);
        film_destroy(&theirs);
    }
}

static void images_match_the_preview(void **state)
{
    (void)state;
    on_each(check_preview);
}

static void check_layers(fixture *f, gl_context *context)
{
    f->desc.aovs = FACET_AOV_DEPTH | FACET_AOV_NORMAL | FACET_AOV_ALBEDO | FACET_AOV_MATERIAL_ID |
                   FACET_AOV_UV | FACET_AOV_OCCLUSION;
    f->desc.crop[0] = 10, f->desc.crop[1] = 6, f->desc.crop[2] = 80, f->desc.crop[3] = 50;
    film ours = gl_fixture_render(f, context), theirs = fixture_render(f);
    assert_int_equal(ours.layer_count, 7);
    size_t shown = 0;
    for (uint32_t k = 1; k < ours.layer_count; k++) {
        const film_layer *a = &ours.layers[k], *b = &theirs.layers[k];
        assert_string_equal(a->name, b->name);
        size_t count = (size_t)80 * 50 * a->channel_count, different = 0;
        for (size_t i = 0; i < count; i++) {
            float tolerance = strcmp(a->name, "albedo") == 0 ? 0.05f : 2e-3f; /* texture filtering */
            bool is_equal = a->pixels[i] == b->pixels[i] || fabsf(a->pixels[i] - b->pixels[i]) < tolerance;
            different += !is_equal;
            shown += strcmp(a->name, "depth") == 0 && isfinite(a->pixels[i]);
        }
        if (different > count / 100) /* an edge may pass through the center of a pixel */
            fail_msg("layer %s: %zu of %zu numbers differ", a->name, different, count);
    }
    assert_in_range(shown, 1000, 3900);
    film_destroy(&ours);
    film_destroy(&theirs);
}

static void aovs_match_the_preview(void **state)
{
    (void)state;
    on_each(check_layers);
}

/* ---- crops ---- */

/* A crop is part of the whole image, to within the 1/256 pixel precision of vertices. */
static void check_crop(fixture *f, gl_context *context)
{
    film whole = gl_fixture_render(f, context);
    const uint32_t crop[4] = {31, 17, 40, 23};
    memcpy(f->desc.crop, crop, sizeof crop);
    film part = gl_fixture_render(f, context);
    size_t different = 0;
    for (uint32_t y = 0; y < crop[3]; y++)
        for (uint32_t x = 0; x < crop[2]; x++)
            for (int c = 0; c < 4; c++)
                different += fabsf(fixture_pixel(&part, "", x, y)[c] -
                                   fixture_pixel(&whole, "", crop[0] + x, crop[1] + y)[c]) > 2e-3f;
    assert_in_range(different, 0, 4 * 9);
    film_destroy(&whole);
    film_destroy(&part);
}

static void a_crop_equals_its_part_of_the_image(void **state)
{
    (void)state;
    on_each(check_crop);
}

/* As if OpenGL's limit were 40 texels: nine tiles, or 30 with twice as many pixels. */
static void check_tiles(fixture *f, gl_context *context)
{
    for (int is_final = 0; is_final < 2; is_final++) {
        f->desc.quality = is_final ? FACET_QUALITY_FINAL : FACET_QUALITY_NORMAL;
        f->desc.samples = is_final ? 16 : 4;
        film whole = gl_fixture_render(f, context);
        gl_context small = *context;
        small.max_texture_size = 40;
        film tiled = gl_fixture_render(f, &small);
        image_difference d = gl_fixture_compare(&whole, &tiled, 2e-3f);
        assert_true(d.share < 0.01);
        film_destroy(&whole);
        film_destroy(&tiled);
    }
}

static void tiles_render_the_same_image(void **state)
{
    (void)state;
    on_each(check_tiles);
}

/* ---- samples ---- */

static void every_sample_count_is_met(void **state)
{
    (void)state;
    for (uint32_t most = 1; most <= 32; most *= 2)
        for (uint32_t samples = 1; samples <= 300; samples++)
            for (int q = FACET_QUALITY_NORMAL; q <= FACET_QUALITY_FINAL; q++) {
                gl_sampling s = gl_sampling_plan(samples, (facet_quality)q, most);
                uint32_t made = s.scale * s.scale * s.samples * s.passes;
                assert_true(made >= samples && made < 2 * samples + 4);
                assert_true(s.samples <= most);
            }
    gl_sampling plan = gl_sampling_plan(16, FACET_QUALITY_FINAL, 4);
    assert_int_equal(plan.scale, 2);
    assert_int_equal(plan.passes, 1);
    plan = gl_sampling_plan(64, FACET_QUALITY_NORMAL, 4);
    float jitter[2 * 16], sum[2] = {0.0f, 0.0f};
    assert_int_equal(plan.passes, 16);
    gl_sampling_jitter(&plan, jitter);
    for (int i = 0; i < 32; i++) {
        assert_true(fabsf(jitter[i]) < 0.25f);
        sum[i & 1] += jitter[i];
    }
    assert_true(fabsf(sum[0]) < 1e-5f && fabsf(sum[1]) < 1e-5f);
}

/* More samples come closer to the preview with very many. */
static void check_samples(fixture *f, gl_context *context)
{
    f->desc.samples = 256;
    film truth = fixture_render(f);
    double before = 1.0;
    static const uint32_t samples[] = {1, 4, 64};
    for (int i = 0; i < 3; i++) {
        f->desc.samples = samples[i];
        film ours = gl_fixture_render(f, context);
        double sum = 0.0; /* only coverage */
        for (size_t k = 0; k < 96 * 64; k++)
            sum += (double)fabsf(ours.layers[0].pixels[4 * k + 3] - truth.layers[0].pixels[4 * k + 3]);
        assert_true(sum < 0.6 * before || i == 0);
        before = sum;
        film_destroy(&ours);
    }
    film_destroy(&truth);
}

static void more_samples_reduce_the_error(void **state)
{
    (void)state;
    on_each(check_samples);
}

/* ---- drivers with fewer capabilities ---- */

static void check_poor_driver(fixture *f, gl_context *context)
{
    film rich = gl_fixture_render(f, context);
    gl_context poor = *context;
    poor.has_clip_control = false; /* rows from the bottom, depth between fitted planes */
    film bottom_up = gl_fixture_render(f, &poor);
    poor.has_float_target = false;
    film half = gl_fixture_render(f, &poor);
    image_difference d = gl_fixture_compare(&rich, &bottom_up, 0.02f);
    assert_true(d.mean < 0.01 && d.share < 0.1); /* edges: other samples */
    d = gl_fixture_compare(&bottom_up, &half, 1e-2f);
    assert_true(d.mean < 1e-3 && d.share < 1e-3);
    film_destroy(&rich);
    film_destroy(&bottom_up);
    film_destroy(&half);
}

static void drivers_without_extensions_draw_the_same(void **state)
{
    (void)state;
    on_each(check_poor_driver);
}

/* ---- depth ---- */

/* Two quads 1 mm apart at 1 km, seen past an object at 1 cm: the nearer one is visible. */
static void check_depth(fixture *f, gl_context *context)
{
    fixture g = fixture_create();
    (void)f;
    uint32_t red = fixture_add_material(&g, gl_fixture_unlit(1.0f, 0.0f, 0.0f, 1.0f));
    uint32_t green = fixture_add_material(&g, gl_fixture_unlit(0.0f, 1.0f, 0.0f, 1.0f));
    fixture_place(&g, fixture_add_quad(&g, red), 0.0f, 0.0f, -0.001f, 1.0f);
    fixture_place(&g, fixture_add_quad(&g, green), 0.0f, 0.0f, 0.0f, 1.0f);
    fixture_place(&g, fixture_add_quad(&g, red), 0.0f, 0.006f, 999.99f, 1e-3f);
    g.camera = (facet_camera){.eye = {0.0f, 0.0f, 1000.0f}, .fov_y_rad = 0.0022f};
    film image = gl_fixture_render(&g, context);
    size_t seen = 0;
    for (uint32_t y = 0; y < 64; y++)
        for (uint32_t x = 0; x < 64; x++) {
            const float *p = fixture_pixel(&image, "", x, y);
            seen += p[3] > 0.99f && p[1] > 0.99f && p[0] < 0.01f;
        }
    if (context->has_clip_control)
        assert_true(seen > 50 * 50);
    film_destroy(&image);
    fixture_destroy(&g);
}

static void distant_surfaces_do_not_z_fight(void **state)
{
    (void)state;
    on_each(check_depth);
}

/* ---- drafts ---- */

enum { FLOOR_WIDTH = 96, FLOOR_HEIGHT = 64 };

/* A floor that runs away from the eye, with fine stripes across the short axis of its footprints. */
static fixture make_floor(void)
{
    enum { EDGE = 128 };
    static unsigned char stripes[EDGE][EDGE][4];
    for (int y = 0; y < EDGE; y++)
        for (int x = 0; x < EDGE; x++)
            memset(stripes[y][x], x / 4 % 2 ? 160 : 120, 4);
    fixture f = fixture_create();
    scene_material m = gl_fixture_unlit(1.0f, 1.0f, 1.0f, 1.0f);
    m.textures[SCENE_BASE_COLOR_TEXTURE].texture = fixture_add_texture(&f, EDGE, EDGE, &stripes[0][0][0]);
    m.is_double_sided = true;
    gl_fixture_turn(
        fixture_place(&f, fixture_add_quad(&f, fixture_add_material(&f, m)), 0.0f, 0.0f, 0.0f, 1.0f), -0.66f,
        0.0f, 0.0f, 0.75f);
    f.camera = (facet_camera){.eye = {0.0f, 0.0f, 4.0f}, .fov_y_rad = 0.5f};
    f.desc.width = FLOOR_WIDTH;
    f.desc.height = FLOOR_HEIGHT;
    f.desc.samples = 4;
    return f;
}

/* Presents the fixture's image in a window of its own; returns the mean of its red values. */
static double present_alone(fixture *f, gl_renderer *renderer, facet_quality quality, unsigned char *rgba)
{
    GLuint texture, framebuffer;
    facet_render_stats stats;
    GLsizei width = (GLsizei)f->desc.width, height = (GLsizei)f->desc.height;
    glGenTextures(1, &texture);
    glBindTexture(GL_TEXTURE_2D, texture);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, width, height, 0, GL_RGBA, GL_UNSIGNED_BYTE, NULL);
    glGenFramebuffers(1, &framebuffer);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, texture, 0);
    glClearColor(1.0f, 1.0f, 1.0f, 1.0f);
    glClear(GL_COLOR_BUFFER_BIT);
    f->desc.camera = &f->camera;
    f->desc.quality = quality;
    assert_int_equal(gl_renderer_present(renderer, &f->desc, framebuffer, 0, 0, &stats, NULL), FACET_OK);
    glReadPixels(0, 0, width, height, GL_RGBA, GL_UNSIGNED_BYTE, rgba);
    glDeleteFramebuffers(1, &framebuffer);
    glDeleteTextures(1, &texture);
    double sum = 0.0;
    for (GLsizei i = 0; i < width * height; i++)
        sum += rgba[4 * i];
    return sum / (width * height);
}

/* One probe blurs, but changes neither coverage nor the mean; and frames at rest stay as they are. */
static void check_draft(fixture *ignored, gl_context *context)
{
    (void)ignored;
    enum { PIXELS = FLOOR_WIDTH * FLOOR_HEIGHT };
    static unsigned char whole[4 * PIXELS], draft[4 * PIXELS], again[4 * PIXELS];
    fixture f = make_floor();
    gl_renderer *renderer = gl_fixture_renderer(&f, context);
    assert_int_equal(gl_context_make_current(context, NULL), FACET_OK);
    double mean = present_alone(&f, renderer, FACET_QUALITY_NORMAL, whole);
    double mean_of_draft = present_alone(&f, renderer, FACET_QUALITY_DRAFT, draft);
    present_alone(&f, renderer, FACET_QUALITY_NORMAL, again);
    assert_memory_equal(whole, again, sizeof whole);
    assert_true(fabs(mean_of_draft - mean) < 0.02 * mean);
    int blurred = 0;
    for (int i = 0; i < PIXELS; i++) {
        assert_int_equal(whole[4 * i + 3], draft[4 * i + 3]);
        blurred += abs(whole[4 * i] - draft[4 * i]) > 3;
    }
    assert_true(blurred > PIXELS / 50);
    gl_renderer_destroy(renderer);
    gl_context_release(context);
    fixture_destroy(&f);
}

static void a_draft_blurs_textures_only(void **state)
{
    (void)state;
    on_each(check_draft);
}

/* Only the rectangle around the model is resolved and tone-mapped where nothing else is in the image: all of the
 * model is in it, and what was in the window is gone. */
static void check_area(fixture *ignored, gl_context *context)
{
    (void)ignored;
    enum { PIXELS = FLOOR_WIDTH * FLOOR_HEIGHT };
    static unsigned char alone[4 * PIXELS], over_black[4 * PIXELS];
    /* A canvas resolves 8-bit samples, which SwiftShader rounds in another way for all of an image than for a part. */
    int rounding = context->is_canvas ? 1 : 0;
    fixture f = make_floor();
    gl_renderer *renderer = gl_fixture_renderer(&f, context);
    assert_int_equal(gl_context_make_current(context, NULL), FACET_OK);
    for (int place = 0; place < 5; place++) {
        f.camera.eye[0] = 0.4f * (float)(place - 2);
        f.camera.eye[1] = 0.3f * (float)(place % 3);
        f.desc.background = FACET_BACKGROUND_TRANSPARENT;
        present_alone(&f, renderer, FACET_QUALITY_NORMAL, alone);
        f.desc.background = FACET_BACKGROUND_COLOR;
        present_alone(&f, renderer, FACET_QUALITY_NORMAL, over_black);
        int full = 0, empty = 0;
        for (int i = 0; i < 4 * PIXELS; i += 4) {
            full += alone[i + 3] == 255;
            empty += alone[i + 3] == 0;
            for (int k = 0; k < 3 && alone[i + 3] % 255 == 0; k++)
                assert_true(abs(alone[i + k] - over_black[i + k]) <= rounding);
        }
        assert_true(full > PIXELS / 20 && empty > PIXELS / 20);
    }
    gl_renderer_destroy(renderer);
    gl_context_release(context);
    fixture_destroy(&f);
}

static void a_window_is_empty_around_the_model(void **state)
{
    (void)state;
    on_each(check_area);
}

/* A page's canvas takes premultiplied values. What is drawn as displayed equals a window's image but at edges, which are
 * antialiased after tone mapping. */
static void check_canvas(fixture *ignored, gl_context *context)
{
    (void)ignored;
    enum { PIXELS = FLOOR_WIDTH * FLOOR_HEIGHT };
    static unsigned char window[4 * PIXELS], canvas[4 * PIXELS];
    static bool is_edge[PIXELS];
    fixture f = make_floor();
    gl_context page = *context;
    page.is_canvas = true;
    gl_renderer *renderer = gl_fixture_renderer(&f, context), *of_page = gl_fixture_renderer(&f, &page);
    assert_int_equal(gl_context_make_current(context, NULL), FACET_OK);
    f.desc.tonemap = FACET_TONEMAP_ACES;
    f.desc.background_color[1] = 0.4f;
    for (int is_behind = 0; is_behind < 2; is_behind++) {
        f.desc.background = is_behind ? FACET_BACKGROUND_COLOR : FACET_BACKGROUND_TRANSPARENT;
        present_alone(&f, renderer, FACET_QUALITY_NORMAL, window);
        present_alone(&f, of_page, FACET_QUALITY_NORMAL, canvas);
        int edges = 0;
        for (int i = 0; i < PIXELS; i++) {
            const unsigned char *a = &window[4 * i], *b = &canvas[4 * i];
            if (!is_behind)
                is_edge[i] = a[3] % 255 != 0 || b[3] % 255 != 0;
            edges += is_edge[i];
            for (int c = 0; c < 4; c++) {
                assert_true(b[c] <= b[3]);
                assert_true(is_edge[i] || abs(a[c] - b[c]) <= 1);
            }
        }
        assert_in_range(edges, 1, PIXELS / 20);
    }
    gl_renderer_destroy(of_page);
    gl_renderer_destroy(renderer);
    gl_context_release(context);
    fixture_destroy(&f);
}

static void a_canvas_shows_what_windows_show(void **state)
{
    (void)state;
    on_each(check_canvas);
}

/* ---- windows ---- */

/* A window's pixels equal those of a file: sRGB, straight alpha, upright, in place. */
static void check_window(fixture *f, gl_context *context)
{
    enum { W = 96, H = 64, LEFT = 5, BELOW = 3 };
    gl_renderer *renderer = gl_fixture_renderer(f, context);
    GLuint texture, framebuffer;
    assert_int_equal(gl_context_make_current(context, NULL), FACET_OK);
    glGenTextures(1, &texture);
    glBindTexture(GL_TEXTURE_2D, texture);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, W + LEFT, H + BELOW, 0, GL_RGBA, GL_UNSIGNED_BYTE, NULL);
    glGenFramebuffers(1, &framebuffer);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, texture, 0);
    facet_render_stats stats;
    f->desc.camera = &f->camera;
    f->desc.environment = f->environment;
    f->desc.tonemap = FACET_TONEMAP_NEUTRAL;
    f->desc.background = FACET_BACKGROUND_COLOR;
    f->desc.background_color[2] = 0.25f;
    assert_int_equal(gl_renderer_present(renderer, &f->desc, framebuffer, LEFT, BELOW, &stats, NULL),
                     FACET_OK);
    static unsigned char window[H][W][4];
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    glReadPixels(LEFT, BELOW, W, H, GL_RGBA, GL_UNSIGNED_BYTE, window);
    film image = gl_fixture_draw(f, renderer);
    film_tone_map(&image, FACET_TONEMAP_NEUTRAL, f->desc.background_color, 1);
    size_t different = 0;
    for (uint32_t y = 0; y < H; y++)
        for (uint32_t x = 0; x < W; x++)
            for (int c = 0; c < 3; c++) {
                double linear = (double)fixture_pixel(&image, "", x, y)[c];
                double wanted =
                    linear <= 0.0031308 ? 12.92 * linear : 1.055 * pow(fmin(linear, 1.0), 1.0 / 2.4) - 0.055;
                different += fabs(255.0 * wanted - (double)window[H - 1 - y][x][c]) > 1.01;
            }
    assert_int_equal(different, 0);
    assert_int_equal(gl_context_make_current(context, NULL), FACET_OK);
    f->desc.width = 0;
    assert_int_equal(gl_renderer_present(renderer, &f->desc, framebuffer, 0, 0, &stats, NULL), FACET_OK);
    glDeleteFramebuffers(1, &framebuffer);
    glDeleteTextures(1, &texture);
    assert_int_equal(glGetError(), GL_NO_ERROR);
    gl_renderer_destroy(renderer);
    gl_context_release(context);
    film_destroy(&image);
}

static void a_window_presents_the_tone_mapped_image(void **state)
{
    (void)state;
    on_each(check_window);
}

/* ---- times ---- */

static void check_times(fixture *f, gl_context *context)
{
    gl_renderer *renderer = gl_fixture_renderer(f, context);
    film image = gl_fixture_draw(f, renderer);
    gl_times times = gl_renderer_get_times(renderer);
    assert_int_equal(times.is_known, context->has_timer_query);
    if (times.is_known) {
        assert_true(times.ms[GL_TIMER_OPAQUE] > 0.0);
        assert_true(times.ms[GL_TIMER_OPAQUE] < 60e3);
        assert_true(times.ms[GL_TIMER_LAYERS] <= 0.0);
    }
    for (int i = 0; i < GL_TIMER_COUNT; i++)
        assert_true(strlen(gl_timer_name((gl_timer)i)) > 3);
    assert_int_equal(gl_context_make_current(context, NULL), FACET_OK);
    gl_renderer_destroy(renderer);
    gl_context_release(context);
    film_destroy(&image);
}

static void passes_are_timed(void **state)
{
    (void)state;
    on_each(check_times);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(images_match_the_preview),
                                       cmocka_unit_test(aovs_match_the_preview),
                                       cmocka_unit_test(a_crop_equals_its_part_of_the_image),
                                       cmocka_unit_test(tiles_render_the_same_image),
                                       cmocka_unit_test(every_sample_count_is_met),
                                       cmocka_unit_test(more_samples_reduce_the_error),
                                       cmocka_unit_test(drivers_without_extensions_draw_the_same),
                                       cmocka_unit_test(distant_surfaces_do_not_z_fight),
                                       cmocka_unit_test(a_draft_blurs_textures_only),
                                       cmocka_unit_test(a_window_is_empty_around_the_model),
                                       cmocka_unit_test(a_canvas_shows_what_windows_show),
                                       cmocka_unit_test(a_window_presents_the_tone_mapped_image),
                                       cmocka_unit_test(passes_are_timed)};
    if (!gl_fixture_open(&contexts))
        return 77;
    int failed = cmocka_run_group_tests(tests, NULL, NULL);
    gl_fixture_close(&contexts);
    return failed;
}
