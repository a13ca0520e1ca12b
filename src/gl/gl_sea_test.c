/* gl_sea_test.c - the sea by OpenGL beside the preview's, as people see both: after tone mapping, in 255ths of a display. */
#include "water/water_fixture.h" /* cmocka, and seas */

#include <string.h>

#include "base/test_effort.h"
#include "gl/gl_sea.h"
#include "water/water_exposure.h"
#include "water/water_picture.h"

enum { WIDTH = 160, HEIGHT = 96 };

static facet_sea_desc small(float wind_mps)
{
    facet_sea_desc desc = sea_default();
    desc.wind_mps = wind_mps;
    desc.resolution = 128;
    desc.thread_count = 2;
    return desc;
}

static gl_sea *make_renderer(gl_api api)
{
    gl_sea *renderer;
    facet_error error;
    if (gl_sea_create_api(api, NULL, &renderer, &error) != FACET_OK) {
        print_message("%s: skipped\n", error.message);
        skip();
    }
    return renderer;
}

static void expose(shot *s)
{
    s->desc.render.exposure_ev = (float)water_exposure_ev(13.3); /* a sun 22 degrees high */
}

/* A display's number: Reinhard's operator, gamma 2.2; looks of before are for displays already. */
static double shown(float x, bool is_light)
{
    double y = is_light ? (double)(x / (1.0f + x)) : fmin((double)x, 1.0);
    return 255.0 * pow(fmax(y, 0.0), 1.0 / 2.2);
}

/* Draws the shot's picture by OpenGL into another film. */
static void draw_gl(gl_sea *renderer, const facet_sea *sea, const shot *s, film *out)
{
    facet_sea_render_desc desc = s->desc;
    facet_render_stats stats = {.total_s = 0.0};
    facet_error error;
    water_picture *picture;
    desc.render.integrator = FACET_INTEGRATOR_GL;
    desc.render.crop[2] = WIDTH;
    desc.render.crop[3] = HEIGHT;
    *out = (film){.width = 0};
    assert_int_equal(film_create(&desc.render.allocator, WIDTH, HEIGHT, 0, out, &error), FACET_OK);
    if (water_picture_create(sea, &desc, &picture, &stats, &error) != FACET_OK)
        fail_msg("%s", error.message);
    if (gl_sea_draw(renderer, water_picture_get(picture), out, &stats, &error) != FACET_OK)
        fail_msg("%s", error.message);
    water_picture_destroy(picture);
}

/* Mean difference of both in 255ths; *contrast: mean distance of a number of the preview's from the one below it. */
static double difference(const shot *s, const film *gl, bool is_light, double *contrast)
{
    double sum = 0.0, steps = 0.0;
    const float *a = s->film.layers[0].pixels, *b = gl->layers[0].pixels;
    for (uint32_t i = 0; i < WIDTH * (HEIGHT - 1); i++)
        for (uint32_t k = 0; k < 3; k++) {
            double x = shown(a[4 * i + k], is_light);
            sum += fabs(x - shown(b[4 * i + k], is_light));
            steps += fabs(x - shown(a[4 * (i + WIDTH) + k], is_light));
        }
    *contrast = steps / (3.0 * WIDTH * (HEIGHT - 1));
    return sum / (3.0 * WIDTH * (HEIGHT - 1));
}

/* Draws both and says how far they are apart; a sea that is not flat shows waves. */
static double compare(gl_sea *renderer, const facet_sea *sea, shot *s, const char *name)
{
    film gl;
    double contrast;
    bool is_light = s->desc.look.before == FACET_SEA_PHYSICAL;
    draw_shot(sea, s);
    draw_gl(renderer, sea, s, &gl);
    double apart = difference(s, &gl, is_light, &contrast);
    print_message("%s: %.3f of 255 apart, %.2f from row to row\n", name, apart, contrast);
    assert_true(contrast > 0.2);
    film_destroy(&gl);
    film_destroy(&s->film);
    return apart;
}

static void compare_breeze(gl_api api)
{
    gl_sea *renderer = make_renderer(api);
    facet_sea_desc desc = small(10.0f);
    facet_sea *sea = make_sea(&desc);
    shot s;
    make_shot(&s, WIDTH, HEIGHT, 3.0f, 0.1f);
    expose(&s);
    assert_true(compare(renderer, sea, &s, "10 m/s") < 0.5);
    if (api == GL_API_CORE) {
        s.desc.look.before = FACET_SEA_BEFORE_INTENDED;
        assert_true(compare(renderer, sea, &s, "before") < 0.3);
    }
    sea_destroy(sea);
    gl_sea_destroy(renderer);
}

static void opengl_draws_what_the_preview_does(void **state)
{
    (void)state;
    compare_breeze(GL_API_CORE);
}

static void opengl_es_draws_what_the_preview_does(void **state)
{
    (void)state;
    if (IS_SLOW)
        skip();
    compare_breeze(GL_API_ES);
}

static void still_and_shallow_water(void **state)
{
    (void)state;
    if (IS_SLOW)
        skip();
    gl_sea *renderer = make_renderer(GL_API_ANY);
    facet_sea_desc calm = small(0.0f), shallow = small(3.0f);
    shallow.bed = (facet_sea_bed){
        .depth_m = 3.0f, .slope = 0.05f, .direction_rad = -1.2f, .albedo = {0.5f, 0.45f, 0.35f}};
    facet_sea *seas[] = {make_sea(&calm), make_sea(&shallow)};
    shot s;
    make_shot(&s, WIDTH, HEIGHT, 3.0f, 0.1f);
    expose(&s);
    assert_true(compare(renderer, seas[0], &s, "calm") < 0.05);
    make_shot(&s, WIDTH, HEIGHT, 8.0f, 0.5f);
    expose(&s);
    assert_true(compare(renderer, seas[1], &s, "bed") < 0.2);
    for (int i = 0; i < 2; i++)
        sea_destroy(seas[i]);
    gl_sea_destroy(renderer);
}

/* From in the water, and a part of a picture with several samples: the same places, whatever the part. */
static void parts_and_depths(void **state)
{
    (void)state;
    if (IS_SLOW)
        skip();
    gl_sea *renderer = make_renderer(GL_API_ANY);
    facet_sea_desc desc = small(5.0f);
    facet_sea *sea = make_sea(&desc);
    shot s;
    make_shot(&s, WIDTH, HEIGHT, -3.0f, -0.6f);
    expose(&s);
    assert_true(compare(renderer, sea, &s, "from below") < 0.2);
    make_shot(&s, 2 * WIDTH, 2 * HEIGHT, 3.0f, 0.2f);
    expose(&s);
    s.desc.render.samples = 2;
    s.desc.render.crop[0] = WIDTH / 2;
    s.desc.render.crop[1] = HEIGHT;
    s.desc.render.crop[2] = WIDTH;
    s.desc.render.crop[3] = HEIGHT;
    assert_true(compare(renderer, sea, &s, "a part") < 1.5);
    sea_destroy(sea);
    gl_sea_destroy(renderer);
}

static void what_cannot_be_drawn_is_said(void **state)
{
    (void)state;
    gl_sea *renderer = make_renderer(GL_API_ANY);
    facet_sea_desc desc = small(0.0f);
    facet_sea *sea = make_sea(&desc);
    shot s;
    facet_error error;
    facet_render_stats stats = {.total_s = 0.0};
    water_picture *picture;
    make_shot(&s, WIDTH, HEIGHT, 3.0f, 0.5f);
    s.camera.fov_y_rad = 0.0f;
    s.camera.ortho_height = 10.0f;
    s.desc.render.camera = &s.camera;
    s.desc.render.crop[2] = WIDTH;
    s.desc.render.crop[3] = HEIGHT;
    s.desc.render.integrator = FACET_INTEGRATOR_GL;
    assert_int_equal(film_create(&s.desc.render.allocator, WIDTH, HEIGHT, 0, &s.film, &error), FACET_OK);
    assert_int_equal(water_picture_create(sea, &s.desc, &picture, &stats, &error), FACET_OK);
    assert_int_equal(gl_sea_draw(renderer, water_picture_get(picture), &s.film, &stats, &error),
                     FACET_ERROR_UNSUPPORTED);
    assert_true(strlen(error.message) > 10);
    water_picture_destroy(picture);
    film_destroy(&s.film);
    sea_destroy(sea);
    gl_sea_destroy(renderer);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(opengl_draws_what_the_preview_does),
        cmocka_unit_test(opengl_es_draws_what_the_preview_does), cmocka_unit_test(still_and_shallow_water),
        cmocka_unit_test(parts_and_depths), cmocka_unit_test(what_cannot_be_drawn_is_said)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
