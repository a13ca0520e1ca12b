/* gl_renderer_test.c - pictures of gl_renderer.h: parts, tiles, samples, layers as the preview's; what is left behind, what
 * breaks, who draws from where. Exits with 77 where there is no OpenGL. */
#include <epoxy/gl.h>
#include <math.h>
#include <pthread.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "base/failing_allocator.h"
#include "gl/gl_fixture_test.h"
#include "gl/gl_sampling.h"

static gl_fixture_contexts contexts;

/* A rough sphere before a tilted quad with a texture, and half a quad that is blended, on the right. */
static fixture make_scene(void)
{
    static const unsigned char checks[16] = {250, 40, 30,  255, 40,  220, 60, 255,
                                             40,  60, 230, 255, 240, 230, 40, 255};
    fixture f = fixture_create();
    scene_material m = scene_material_default();
    m.perceptual_roughness = 0.5f;
    m.metallic = 0.0f;
    uint32_t plain = fixture_add_material(&f, m);
    m.textures[SCENE_BASE_COLOR_TEXTURE].texture = fixture_add_texture(&f, 2, 2, checks);
    m.is_double_sided = true;
    uint32_t checked = fixture_add_material(&f, m);
    uint32_t faint = fixture_add_material(&f, gl_fixture_unlit(0.2f, 0.9f, 0.4f, 0.5f));
    fixture_place(&f, fixture_add_sphere(&f, 24, plain), -0.3f, 0.1f, 0.5f, 0.5f);
    gl_fixture_turn(fixture_place(&f, fixture_add_quad(&f, checked), 0.1f, -0.1f, -0.5f, 0.7f), 0.1f, 0.2f,
                    0.1f, 0.9695f);
    fixture_place(&f, fixture_add_quad(&f, faint), 0.6f, 0.2f, 1.0f, 0.3f);
    f.camera = (facet_camera){.eye = {0.4f, 0.6f, 4.0f}, .fov_y_rad = 0.6f};
    f.desc.width = 96;
    f.desc.height = 64;
    return f;
}

static void on_each(void (*check)(fixture *f, gl_context *context))
{
    for (int i = 0; i < contexts.count; i++) {
        fixture f = make_scene();
        check(&f, &contexts.items[i]);
        fixture_destroy(&f);
    }
}

static void assert_same(const film *a, const film *b)
{
    size_t size = (size_t)a->width * a->height * 4 * sizeof(float);
    assert_int_equal(a->width, b->width);
    assert_int_equal(a->height, b->height);
    assert_memory_equal(a->layers[0].pixels, b->layers[0].pixels, size);
}

/* ---- the preview ---- */

static void check_preview(fixture *f, gl_context *context)
{
    static const uint32_t samples[] = {1, 4};
    for (int i = 0; i < 2; i++) {
        f->desc.samples = samples[i];
        film ours = gl_fixture_render(f, context), theirs = fixture_render(f);
        picture_difference d = gl_fixture_compare(&ours, &theirs, 0.02f);
        if (d.mean > 0.002 || d.share > 0.02)
            fail_msg("%u samples: mean difference %g, %g of the pixels by more than 0.02", samples[i], d.mean,
                     d.share);
        size_t different = 0; /* the very same samples; some lie within 1 / 256 of an edge */
        for (size_t k = 0; k < 96 * 64; k++)
            different += fabsf(ours.layers[0].pixels[4 * k + 3] - theirs.layers[0].pixels[4 * k + 3]) > 1e-5f;
        if (context->has_clip_control)
            assert_in_range(different, 0, 6);
        film_destroy(&ours);
        film_destroy(&theirs);
    }
}

static void pictures_are_the_previews(void **state)
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
            float tolerance = strcmp(a->name, "albedo") == 0 ? 0.05f : 2e-3f; /* a texture's filter */
            bool is_equal = a->pixels[i] == b->pixels[i] || fabsf(a->pixels[i] - b->pixels[i]) < tolerance;
            different += !is_equal;
            shown += strcmp(a->name, "depth") == 0 && isfinite(a->pixels[i]);
        }
        if (different > count / 100) /* an edge goes through a pixel's middle here and there */
            fail_msg("layer %s: %zu of %zu numbers differ", a->name, different, count);
    }
    assert_in_range(shown, 1000, 3900);
    film_destroy(&ours);
    film_destroy(&theirs);
}

static void layers_are_the_previews(void **state)
{
    (void)state;
    on_each(check_layers);
}

/* ---- parts ---- */

/* A part of a picture is that part: as far as vertices fall on the same 256ths of a pixel. */
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

static void a_crop_is_a_part_of_the_picture(void **state)
{
    (void)state;
    on_each(check_crop);
}

/* As if OpenGL had no textures above 40 texels: nine tiles, or 30 of twice as many pixels. */
static void check_tiles(fixture *f, gl_context *context)
{
    for (int is_final = 0; is_final < 2; is_final++) {
        f->desc.quality = is_final ? FACET_QUALITY_FINAL : FACET_QUALITY_NORMAL;
        f->desc.samples = is_final ? 16 : 4;
        film whole = gl_fixture_render(f, context);
        gl_context small = *context;
        small.max_texture_size = 40;
        film tiled = gl_fixture_render(f, &small);
        picture_difference d = gl_fixture_compare(&whole, &tiled, 2e-3f);
        assert_true(d.share < 0.01);
        film_destroy(&whole);
        film_destroy(&tiled);
    }
}

static void tiles_make_the_same_picture(void **state)
{
    (void)state;
    on_each(check_tiles);
}

/* ---- samples ---- */

static void samples_are_as_many_as_asked_for(void **state)
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

/* More samples come closer to what the preview finds with very many. */
static void check_samples(fixture *f, gl_context *context)
{
    f->desc.samples = 256;
    film truth = fixture_render(f);
    double before = 1.0;
    static const uint32_t samples[] = {1, 4, 64};
    for (int i = 0; i < 3; i++) {
        f->desc.samples = samples[i];
        film ours = gl_fixture_render(f, context);
        double sum = 0.0; /* coverage alone: shading is elsewhere */
        for (size_t k = 0; k < 96 * 64; k++)
            sum += (double)fabsf(ours.layers[0].pixels[4 * k + 3] - truth.layers[0].pixels[4 * k + 3]);
        assert_true(sum < 0.6 * before || i == 0);
        before = sum;
        film_destroy(&ours);
    }
    film_destroy(&truth);
}

static void more_samples_are_closer(void **state)
{
    (void)state;
    on_each(check_samples);
}

/* ---- drivers that have less ---- */

static void check_poor_driver(fixture *f, gl_context *context)
{
    film rich = gl_fixture_render(f, context);
    gl_context poor = *context;
    poor.has_clip_control = false; /* rows from the bottom, depth between planes that follow the scene */
    film bottom_up = gl_fixture_render(f, &poor);
    poor.has_float_target = false;
    film half = gl_fixture_render(f, &poor);
    picture_difference d = gl_fixture_compare(&rich, &bottom_up, 0.02f);
    assert_true(d.mean < 0.01 && d.share < 0.1); /* edges: other samples */
    d = gl_fixture_compare(&bottom_up, &half, 1e-2f);
    assert_true(d.mean < 1e-3 && d.share < 1e-3);
    film_destroy(&rich);
    film_destroy(&bottom_up);
    film_destroy(&half);
}

static void drivers_that_have_less_draw_the_same(void **state)
{
    (void)state;
    on_each(check_poor_driver);
}

/* ---- depth ---- */

/* Two quads 1 mm apart, 1 km away, seen by an eye that has something 1 cm before it: the nearer one is seen. */
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
    film picture = gl_fixture_render(&g, context);
    size_t seen = 0;
    for (uint32_t y = 0; y < 64; y++)
        for (uint32_t x = 0; x < 64; x++) {
            const float *p = fixture_pixel(&picture, "", x, y);
            seen += p[3] > 0.99f && p[1] > 0.99f && p[0] < 0.01f;
        }
    if (context->has_clip_control)
        assert_true(seen > 50 * 50);
    film_destroy(&picture);
    fixture_destroy(&g);
}

static void nothing_flickers_far_away(void **state)
{
    (void)state;
    on_each(check_depth);
}

/* ---- what is left behind ---- */

enum { KINDS = 8, MOST_NAMES = 20000 };

/* How many objects of each kind there are; names that were released may not be given again for a while. */
static void count_objects(int counts[KINDS])
{
    GLboolean (*const is_there[KINDS])(GLuint) = {glIsTexture,      glIsBuffer,      glIsFramebuffer,
                                                  glIsRenderbuffer, glIsVertexArray, glIsQuery,
                                                  glIsProgram,      glIsShader};
    for (int kind = 0; kind < KINDS; kind++) {
        counts[kind] = 0;
        for (GLuint name = 1; name < MOST_NAMES; name++)
            counts[kind] += is_there[kind](name) == GL_TRUE;
    }
}

static void check_leaks(fixture *f, gl_context *context)
{
    failing_allocator counting = {.fail_at = -1};
    facet_allocator allocator = failing_allocator_get(&counting);
    int before[KINDS], after[KINDS];
    f->desc.width = f->desc.height = 8;
    f->desc.aovs = FACET_AOV_DEPTH;
    f->desc.camera = &f->camera;
    f->desc.crop[2] = f->desc.crop[3] = 8;
    assert_int_equal(gl_context_make_current(context, NULL), FACET_OK);
    count_objects(before);
    for (int i = 0; i < 100; i++) {
        gl_renderer *renderer;
        film out;
        facet_render_stats stats;
        assert_int_equal(gl_renderer_create(f->scene, context, &allocator, &renderer, NULL), FACET_OK);
        assert_int_equal(film_create(NULL, 8, 8, f->desc.aovs, &out, NULL), FACET_OK);
        if (i % 25 == 0)
            assert_int_equal(gl_renderer_render(renderer, &f->desc, &out, &stats, NULL), FACET_OK);
        assert_int_equal(gl_context_make_current(context, NULL), FACET_OK);
        gl_renderer_destroy(renderer);
        film_destroy(&out);
        assert_int_equal(gl_context_make_current(context, NULL), FACET_OK);
    }
    assert_int_equal(atomic_load(&counting.blocks), 0);
    count_objects(after);
    GLuint name; /* the test sees what it looks for */
    glGenTextures(1, &name);
    assert_true(name < MOST_NAMES);
    glDeleteTextures(1, &name);
    for (int kind = 0; kind < KINDS; kind++)
        if (after[kind] != before[kind])
            fail_msg("%d objects of kind %d are left", after[kind] - before[kind], kind);
    gl_context_release(context);
}

static void a_hundred_renderers_leave_nothing(void **state)
{
    (void)state;
    on_each(check_leaks);
}

/* Memory that runs out anywhere is a result; the renderer can be used on. */
static void memory_may_run_out(void **state)
{
    (void)state;
    gl_context *context = &contexts.items[0];
    fixture f = make_scene();
    f.desc.width = f.desc.height = f.desc.crop[2] = f.desc.crop[3] = 16;
    f.desc.camera = &f.camera;
    long step = 1;
    for (long fail_at = 0; fail_at < 100000; fail_at += step, step = 1 + fail_at / 8) {
        failing_allocator failing = {.fail_at = fail_at};
        facet_allocator allocator = failing_allocator_get(&failing);
        gl_renderer *renderer = NULL;
        film out = {0};
        facet_render_stats stats;
        assert_int_equal(gl_context_make_current(context, NULL), FACET_OK);
        facet_result result = gl_renderer_create(f.scene, context, &allocator, &renderer, NULL);
        assert_int_equal(film_create(NULL, 16, 16, 0, &out, NULL), FACET_OK);
        f.desc.allocator = allocator;
        if (result == FACET_OK)
            result = gl_renderer_render(renderer, &f.desc, &out, &stats, NULL);
        if (result != FACET_OK)
            assert_int_equal(result, FACET_ERROR_MEMORY);
        if (renderer && result != FACET_OK)
            assert_int_equal(gl_renderer_render(renderer, &f.desc, &out, &stats, NULL), FACET_OK);
        assert_int_equal(gl_context_make_current(context, NULL), FACET_OK);
        gl_renderer_destroy(renderer);
        film_destroy(&out);
        gl_context_release(context);
        assert_int_equal(atomic_load(&failing.blocks), 0);
        if (atomic_load(&failing.calls) <= fail_at)
            break;
        assert_true(fail_at < 90000);
    }
    fixture_destroy(&f);
}

/* ---- contexts ---- */

static gl_renderer *own_renderer(const fixture *f)
{
    gl_renderer *renderer;
    facet_error error;
    if (gl_renderer_create(f->scene, NULL, NULL, &renderer, &error) != FACET_OK)
        fail_msg("%s", error.message);
    return renderer;
}

static void two_renderers_do_not_meet(void **state)
{
    (void)state;
    fixture f = make_scene(), g = make_scene();
    g.scene->materials[0].base_color[0] = 0.1f;
    gl_renderer *a = own_renderer(&f), *b = own_renderer(&g);
    film a1 = gl_fixture_draw(&f, a), b1 = gl_fixture_draw(&g, b);
    film a2 = gl_fixture_draw(&f, a);
    gl_renderer_destroy(a);
    film b2 = gl_fixture_draw(&g, b);
    gl_renderer_destroy(b);
    assert_same(&a1, &a2);
    assert_same(&b1, &b2);
    assert_true(gl_fixture_compare(&a1, &b1, 0.01f).share > 0.05);
    film_destroy(&a1), film_destroy(&a2), film_destroy(&b1), film_destroy(&b2);
    fixture_destroy(&f), fixture_destroy(&g);
}

typedef struct errand {
    const fixture *f;
    gl_renderer *renderer;
    film picture;
} errand;

static void *draw_elsewhere(void *context)
{
    errand *e = context;
    e->picture = gl_fixture_draw(e->f, e->renderer);
    return NULL;
}

static void *destroy_elsewhere(void *context)
{
    gl_renderer_destroy(((errand *)context)->renderer);
    return NULL;
}

static void run_thread(void *(*body)(void *), errand *e)
{
    pthread_t thread;
    assert_int_equal(pthread_create(&thread, NULL, body, e), 0);
    assert_int_equal(pthread_join(thread, NULL), 0);
}

static void any_thread_may_draw(void **state)
{
    (void)state;
    fixture f = make_scene();
    errand e = {.f = &f, .renderer = own_renderer(&f)};
    film here = gl_fixture_draw(&f, e.renderer);
    run_thread(draw_elsewhere, &e);
    assert_same(&here, &e.picture);
    film_destroy(&e.picture);
    run_thread(draw_elsewhere, &e);
    assert_same(&here, &e.picture);
    run_thread(destroy_elsewhere, &e);
    film_destroy(&here);
    film_destroy(&e.picture);
    fixture_destroy(&f);
}

static unsigned is_reset(void)
{
    return GL_UNKNOWN_CONTEXT_RESET;
}

static facet_result try_draw(const fixture *f, gl_renderer *renderer, facet_error *error)
{
    film out;
    facet_render_stats stats;
    facet_render_desc desc = f->desc;
    desc.camera = &f->camera;
    desc.environment = f->environment;
    desc.crop[2] = desc.width;
    desc.crop[3] = desc.height;
    assert_int_equal(film_create(NULL, desc.width, desc.height, 0, &out, NULL), FACET_OK);
    facet_result result = gl_renderer_render(renderer, &desc, &out, &stats, error);
    film_destroy(&out);
    return result;
}

static void a_lost_context_is_followed_by_a_new_one(void **state)
{
    (void)state;
    fixture f = make_scene();
    gl_renderer *renderer = own_renderer(&f);
    facet_error error;
    film before = gl_fixture_draw(&f, renderer);
    gl_renderer_get_context(renderer)->reset_status = is_reset;
    assert_int_equal(try_draw(&f, renderer, &error), FACET_ERROR_ENVIRONMENT);
    assert_non_null(strstr(error.message, "the driver was reset"));
    film after = gl_fixture_draw(&f, renderer);
    assert_same(&before, &after);
    gl_renderer_destroy(renderer);
    film_destroy(&before);
    film_destroy(&after);
    fixture_destroy(&f);
}

/* What was current stays current for the caller. */
static void the_callers_context_comes_back(void **state)
{
    (void)state;
    fixture f = make_scene();
    gl_context *mine = &contexts.items[0];
    assert_int_equal(gl_context_make_current(mine, NULL), FACET_OK);
    GLuint name;
    glGenTextures(1, &name);
    glBindTexture(GL_TEXTURE_2D, name);
    gl_renderer *renderer = own_renderer(&f);
    film picture = gl_fixture_draw(&f, renderer);
    GLint bound = 0;
    glGetIntegerv(GL_TEXTURE_BINDING_2D, &bound);
    assert_int_equal(bound, name);
    gl_renderer_destroy(renderer);
    glGetIntegerv(GL_TEXTURE_BINDING_2D, &bound);
    assert_int_equal(bound, name);
    glDeleteTextures(1, &name);
    gl_context_release(mine);
    film_destroy(&picture);
    fixture_destroy(&f);
}

/* ---- limits ---- */

static bool stop_at_once(void *user, const char *stage, double fraction)
{
    (void)stage, (void)fraction;
    return --*(int *)user > 0;
}

static void a_picture_may_be_cancelled(void **state)
{
    (void)state;
    fixture f = make_scene();
    gl_renderer *renderer = own_renderer(&f);
    f.desc.samples = 64;
    int calls = 1000000;
    f.desc.progress = (facet_progress){.user = &calls, .report = stop_at_once};
    assert_int_equal(try_draw(&f, renderer, NULL), FACET_OK);
    int all = 1000000 - calls;
    assert_in_range(all, 4, 100);
    for (int most = 1; most <= all; most++) {
        calls = most;
        assert_int_equal(try_draw(&f, renderer, NULL), FACET_ERROR_CANCELLED);
    }
    f.desc.progress = (facet_progress){0};
    f.desc.time_limit_s = 1e-9;
    facet_error error;
    assert_int_equal(try_draw(&f, renderer, &error), FACET_ERROR_LIMIT);
    assert_non_null(strstr(error.message, "the time limit was reached"));
    f.desc.time_limit_s = 60.0;
    assert_int_equal(try_draw(&f, renderer, NULL), FACET_OK);
    gl_renderer_destroy(renderer);
    fixture_destroy(&f);
}

static void count_warning(void *user, facet_log_level level, const char *said)
{
    (void)level;
    *(int *)user += strncmp(said, "the picture is black", 20) == 0;
}

static void the_dark_is_told(void **state)
{
    (void)state;
    fixture f = fixture_create();
    fixture_place(&f, fixture_add_quad(&f, fixture_add_material(&f, scene_material_default())), 0, 0, 0, 1);
    int count = 0;
    f.desc.log = (facet_log){.user = &count, .message = count_warning};
    gl_renderer *renderer = own_renderer(&f);
    assert_int_equal(try_draw(&f, renderer, NULL), FACET_OK);
    assert_int_equal(count, 0);
    facet_environment_destroy(f.environment);
    f.environment = NULL;
    assert_int_equal(try_draw(&f, renderer, NULL), FACET_OK);
    assert_int_equal(count, 1);
    gl_renderer_destroy(renderer);
    fixture_destroy(&f);
}

/* ---- windows ---- */

/* Numbers of a window are those that a file of the picture has: sRGB, straight; upright, in its place. */
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
    film picture = gl_fixture_draw(f, renderer);
    film_develop(&picture, FACET_TONEMAP_NEUTRAL, f->desc.background_color, 1);
    size_t different = 0;
    for (uint32_t y = 0; y < H; y++)
        for (uint32_t x = 0; x < W; x++)
            for (int c = 0; c < 3; c++) {
                double linear = (double)fixture_pixel(&picture, "", x, y)[c];
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
    film_destroy(&picture);
}

static void a_window_shows_the_picture(void **state)
{
    (void)state;
    on_each(check_window);
}

/* ---- times ---- */

static void check_times(fixture *f, gl_context *context)
{
    gl_renderer *renderer = gl_fixture_renderer(f, context);
    film picture = gl_fixture_draw(f, renderer);
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
    film_destroy(&picture);
}

static void passes_are_timed(void **state)
{
    (void)state;
    on_each(check_times);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(pictures_are_the_previews),
                                       cmocka_unit_test(layers_are_the_previews),
                                       cmocka_unit_test(a_crop_is_a_part_of_the_picture),
                                       cmocka_unit_test(tiles_make_the_same_picture),
                                       cmocka_unit_test(samples_are_as_many_as_asked_for),
                                       cmocka_unit_test(more_samples_are_closer),
                                       cmocka_unit_test(drivers_that_have_less_draw_the_same),
                                       cmocka_unit_test(nothing_flickers_far_away),
                                       cmocka_unit_test(a_hundred_renderers_leave_nothing),
                                       cmocka_unit_test(memory_may_run_out),
                                       cmocka_unit_test(two_renderers_do_not_meet),
                                       cmocka_unit_test(any_thread_may_draw),
                                       cmocka_unit_test(a_lost_context_is_followed_by_a_new_one),
                                       cmocka_unit_test(the_callers_context_comes_back),
                                       cmocka_unit_test(a_picture_may_be_cancelled),
                                       cmocka_unit_test(the_dark_is_told),
                                       cmocka_unit_test(a_window_shows_the_picture),
                                       cmocka_unit_test(passes_are_timed)};
    if (!gl_fixture_open(&contexts))
        return 77;
    int failed = cmocka_run_group_tests(tests, NULL, NULL);
    gl_fixture_close(&contexts);
    return failed;
}
