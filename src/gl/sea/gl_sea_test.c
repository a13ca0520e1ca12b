/* gl_sea_test.c - the sea by OpenGL against the preview, compared as people see both: after tone mapping, in
 * 255ths of a display. */
#include "water/water_fixture.h" /* cmocka, and seas */

#include <epoxy/egl.h>
#include <string.h>

#include "tests/support/support.h"
#include "cpu/preview_fixture.h"
#include "gl/sea/gl_sea.h"
#include "film/meter.h"
#include "water/water_frame.h"

enum { WIDTH = 160, HEIGHT = 96 };

static facet_sea_desc small(float wind_mps)
{
    facet_sea_desc desc = sea_default();
    desc.wind_mps = wind_mps;
    desc.resolution = 128;
    desc.thread_count = 2;
    return desc;
}

/* One for all tests of an API: programs take long to compile. */
static gl_sea *renderers[3];

static gl_sea *renderer_of(gl_api api)
{
    facet_error error;
    if (!renderers[api] && gl_sea_create_api(api, NULL, &renderers[api], &error) != FACET_OK) {
        print_message("%s: skipped\n", error.message);
        skip();
    }
    return renderers[api];
}

static int destroy_renderers(void **state)
{
    (void)state;
    for (int i = 0; i < 3; i++)
        gl_sea_destroy(renderers[i]);
    return 0;
}

static void expose(shot *s)
{
    s->desc.exposure_ev = (float)meter_exposure_ev(13.3); /* a sun 22 degrees high */
}

/* A display value: Reinhard's operator, gamma 2.2; legacy styles are for displays already. */
static double shown(float x, bool is_light)
{
    double y = is_light ? (double)(x / (1.0f + x)) : fmin((double)x, 1.0);
    return 255.0 * pow(fmax(y, 0.0), 1.0 / 2.2);
}

/* Draws the shot by OpenGL into another film. */
static void draw_gl(gl_sea *renderer, const facet_sea *sea, const shot *s, film *out)
{
    facet_render_desc desc = s->desc;
    facet_render_stats stats = {.total_s = 0.0};
    facet_error error;
    water_cache cache = {.sea_serial = 0};
    water_frame *frame;
    desc.sea = sea;
    desc.renderer = FACET_RENDERER_KIND_GL;
    desc.crop[2] = WIDTH;
    desc.crop[3] = HEIGHT;
    *out = (film){.width = 0};
    assert_int_equal(film_create(&desc.allocator, WIDTH, HEIGHT, 0, out, &error), FACET_OK);
    if (water_frame_create(&cache, s->scene, &desc, &frame, &stats, &error) != FACET_OK)
        fail_msg("%s", error.message);
    if (gl_sea_draw(renderer, frame, out, &stats, &error) != FACET_OK)
        fail_msg("%s", error.message);
    water_frame_destroy(frame);
    water_cache_clear(&cache);
}

/* Mean difference of both in 255ths; *contrast: mean distance of a value of the preview from the one below
 * it. */
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

/* Difference between the preview with the model and OpenGL without it: what a comparison would find if the
 * model were not drawn. */
static double without_model(gl_sea *renderer, const facet_sea *sea, shot *s)
{
    film gl;
    double contrast;
    const facet_scene *scene = s->scene;
    draw_shot(sea, s);
    s->scene = NULL;
    draw_gl(renderer, sea, s, &gl);
    s->scene = scene;
    double apart = difference(s, &gl, true, &contrast);
    film_destroy(&gl);
    film_destroy(&s->film);
    return apart;
}

/* Draws both and reports their difference; checks that a sea that is not flat shows waves. */
static double compare(gl_sea *renderer, const facet_sea *sea, shot *s, const char *name)
{
    film gl;
    double contrast;
    bool is_light = s->desc.sea_shading.style == FACET_SEA_STYLE_PHYSICAL;
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
    gl_sea *renderer = renderer_of(api);
    facet_sea_desc desc = small(10.0f);
    facet_sea *sea = make_sea(&desc);
    shot s;
    make_shot(&s, WIDTH, HEIGHT, 3.0f, 0.1f);
    expose(&s);
    assert_true(compare(renderer, sea, &s, "10 m/s") < 0.5);
    if (api == GL_API_ANY) {
        s.desc.sea_shading.style = FACET_SEA_STYLE_LEGACY_INTENDED;
        assert_true(compare(renderer, sea, &s, "before") < 0.3);
    }
    sea_destroy(sea);
}

static void opengl_draws_what_the_preview_does(void **state)
{
    (void)state;
    compare_breeze(GL_API_ANY);
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
    gl_sea *renderer = renderer_of(GL_API_ANY);
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
}

/* From in the water, and a crop with several samples: the same places, whatever the crop. */
static void parts_and_depths(void **state)
{
    (void)state;
    if (IS_SLOW)
        skip();
    gl_sea *renderer = renderer_of(GL_API_ANY);
    facet_sea_desc desc = small(5.0f);
    facet_sea *sea = make_sea(&desc);
    shot s;
    make_shot(&s, WIDTH, HEIGHT, -3.0f, -0.6f);
    expose(&s);
    assert_true(compare(renderer, sea, &s, "from below") < 0.2);
    make_shot(&s, 2 * WIDTH, 2 * HEIGHT, 3.0f, 0.2f);
    expose(&s);
    s.desc.samples = 2;
    s.desc.crop[0] = WIDTH / 2;
    s.desc.crop[1] = HEIGHT;
    s.desc.crop[2] = WIDTH;
    s.desc.crop[3] = HEIGHT;
    assert_true(compare(renderer, sea, &s, "a part") < 1.5);
    make_shot(&s, WIDTH, HEIGHT, 3.0f, 0.2f);
    expose(&s);
    s.camera.far_m = 25.0f;
    assert_true(compare(renderer, sea, &s, "no farther than 25 m") < 0.4);
    sea_destroy(sea);
}

/* GGX with Schlick's masking and reflectance, in contrast to the default microfacets. */
static void other_facets(void **state)
{
    (void)state;
    if (IS_SLOW)
        skip();
    gl_sea *renderer = renderer_of(GL_API_ANY);
    facet_sea_desc desc = small(10.0f);
    facet_sea *sea = make_sea(&desc);
    shot s;
    film gl;
    double contrast;
    make_shot(&s, WIDTH, HEIGHT, 3.0f, 0.1f);
    expose(&s);
    s.desc.camera = &s.camera;
    draw_gl(renderer, sea, &s, &gl);
    s.desc.sea_shading.normals = FACET_SEA_NORMALS_GGX;
    s.desc.sea_shading.masking = FACET_SEA_MASKING_SCHLICK_KARIS;
    s.desc.sea_shading.has_schlick_fresnel = true;
    draw_shot(sea, &s);
    double without = difference(&s, &gl, true, &contrast);
    film_destroy(&gl);
    film_destroy(&s.film);
    print_message("default facets: %.3f of 255\n", without);
    assert_true(compare(renderer, sea, &s, "GGX, Schlick") < 0.5);
    assert_true(without > 4.0 * 0.5);
    sea_destroy(sea);
}

/* An image as the sky, turned, with a sun in addition. */
static void environments(void **state)
{
    (void)state;
    if (IS_SLOW)
        skip();
    gl_sea *renderer = renderer_of(GL_API_ANY);
    facet_sea_desc desc = small(3.0f);
    facet_sea *sea = make_sea(&desc);
    facet_environment *studio;
    assert_int_equal(facet_environment_create_studio(NULL, &studio, NULL), FACET_OK);
    shot s;
    make_shot(&s, WIDTH, HEIGHT, 3.0f, 0.1f);
    s.desc.environment = studio;
    s.desc.environment_rotation_rad = 1.9f;
    s.desc.environment_ev = 13.0f;
    s.desc.sun = (facet_sun){
        .azimuth_rad = 2.9f, .elevation_rad = 0.3f, .illuminance_lux = {60000.0f, 50000.0f, 40000.0f}};
    expose(&s);
    assert_true(compare(renderer, sea, &s, "an image") < 0.3);
    facet_environment_destroy(studio);
    sea_destroy(sea);
}

/* Spheres of radius 1: one floats between the eye and the sun, one lies on the right below the surface,
 * one hangs over it on the left. */
static fixture spheres(void)
{
    fixture f = fixture_create();
    scene_material material = scene_material_default();
    material.base_color[1] = material.base_color[2] = 0.1f;
    material.metallic = 0.0f;
    uint32_t sphere = fixture_add_sphere(&f, 48, fixture_add_material(&f, material));
    fixture_place(&f, sphere, 0.0f, 0.2f, -7.0f, 1.0f);
    fixture_place(&f, sphere, 2.0f, -1.3f, -6.0f, 1.0f);
    fixture_place(&f, sphere, -2.5f, 1.5f, -8.0f, 1.0f);
    return f;
}

static void compare_model(gl_sea *renderer, float wind_mps, float eye_m, float down_rad, float bed_m,
                          double bound)
{
    facet_sea_desc desc = small(wind_mps);
    desc.bed = (facet_sea_bed){.depth_m = bed_m, .albedo = {0.4f, 0.4f, 0.3f}};
    facet_sea *sea = make_sea(&desc);
    fixture f = spheres();
    shot s;
    make_shot(&s, WIDTH, HEIGHT, eye_m, down_rad);
    s.desc.sky.sun_azimuth_rad = 2.6f;
    s.scene = f.scene;
    s.desc.sea_shading.omits_glints =
        true; /* which glints are drawn depends on single bits of the resting positions */
    expose(&s);
    assert_true(compare(renderer, sea, &s, eye_m > 0.0f ? "spheres" : "spheres from below") < bound);
    double without = without_model(renderer, sea, &s);
    print_message("without them %.2f\n", without);
    assert_true(without > 4.0 * bound);
    sea_destroy(sea);
    fixture_destroy(&f);
}

/* Reflections and refractions of a model do not depend on another one 80 m away: in one bounding sphere they
 * were 1.4 apart. */
static void models_far_from_each_other(void **state)
{
    (void)state;
    if (IS_SLOW)
        skip();
    gl_sea *renderer = renderer_of(GL_API_ANY);
    facet_sea_desc desc = small(2.0f);
    facet_sea *sea = make_sea(&desc);
    fixture f = spheres();
    fixture_place(&f, 0, 60.0f, 0.0f, -50.0f, 1.0f);
    shot s;
    make_shot(&s, WIDTH, HEIGHT, 3.0f, 0.35f);
    s.scene = f.scene;
    s.desc.sea_shading.omits_glints = true;
    expose(&s);
    assert_true(compare(renderer, sea, &s, "spheres far from each other") < 0.9);
    sea_destroy(sea);
    fixture_destroy(&f);
}

/* Materials have samplers, with which the textures of the sea in the same units would be incomplete. */
static void a_model_with_many_textures(void **state)
{
    (void)state;
    if (IS_SLOW)
        skip();
    gl_sea *renderer = renderer_of(GL_API_ANY);
    static const unsigned char white[4] = {255, 255, 255, 255};
    static const scene_texture_slot slots[] = {
        SCENE_BASE_COLOR_TEXTURE, SCENE_METALLIC_ROUGHNESS_TEXTURE,  SCENE_EMISSIVE_TEXTURE,
        SCENE_CLEARCOAT_TEXTURE,  SCENE_CLEARCOAT_ROUGHNESS_TEXTURE, SCENE_SPECULAR_TEXTURE,
        SCENE_SHEEN_COLOR_TEXTURE};
    facet_sea_desc desc = small(5.0f);
    facet_sea *sea = make_sea(&desc);
    fixture f = fixture_create();
    scene_material material = scene_material_default();
    material.extensions = SCENE_CLEARCOAT | SCENE_SPECULAR | SCENE_SHEEN;
    material.clearcoat = 0.5f;
    material.sheen_color[0] = 0.2f;
    material.emissive[0] = 1.0f;
    for (size_t i = 0; i < sizeof slots / sizeof *slots; i++)
        material.textures[slots[i]].texture = fixture_add_texture(&f, 1, 1, white);
    fixture_place(&f, fixture_add_sphere(&f, 48, fixture_add_material(&f, material)), 0.0f, 0.4f, -9.0f,
                  1.0f);
    shot s;
    make_shot(&s, WIDTH, HEIGHT, 3.0f, 0.2f);
    s.scene = f.scene;
    s.desc.sea_shading.omits_glints = true;
    expose(&s);
    assert_true(compare(renderer, sea, &s, "a sphere with seven textures") < 0.8);
    sea_destroy(sea);
    fixture_destroy(&f);
}

/* An eye in the water sees a floating sphere through the window from where waves begin, in troughs as well. */
static void a_hull_in_waves(void **state)
{
    (void)state;
    if (IS_SLOW)
        skip();
    gl_sea *renderer = renderer_of(GL_API_ANY);
    facet_sea_desc desc = small(6.0f);
    facet_sea *sea = make_sea(&desc);
    fixture f = fixture_create();
    fixture_place(&f, fixture_add_sphere(&f, 48, fixture_add_material(&f, scene_material_default())), 0.0f,
                  0.4f, -3.6f, 1.6f);
    shot s;
    make_shot(&s, WIDTH, HEIGHT, -3.0f, -0.85f);
    s.camera.fov_y_rad = 0.9f;
    s.scene = f.scene;
    s.desc.sea_shading.omits_glints = true;
    expose(&s);
    assert_true(compare(renderer, sea, &s, "a hull in waves") < 0.28);
    sea_destroy(sea);
    fixture_destroy(&f);
}

static void models(void **state)
{
    (void)state;
    if (IS_SLOW)
        skip();
    gl_sea *renderer = renderer_of(GL_API_ANY);
    compare_model(renderer, 2.0f, 3.0f, 0.35f, 0.0f, 0.6);
    compare_model(renderer, 0.0f, -2.0f, -0.2f, 0.0f, 0.1);
    compare_model(renderer, 2.0f, -2.0f, -0.2f, 0.0f, 0.2);  /* mirrored in the surface from below */
    compare_model(renderer, 0.0f, -2.0f, -0.65f, 0.0f, 0.2); /* and through Snell's window */
    compare_model(renderer, 2.0f, -2.0f, -0.65f, 0.0f, 0.35);
    compare_model(renderer, 2.0f, 8.0f, 0.9f, 3.0f, 0.6); /* with shadows on the bed */
    compare_model(renderer, 0.0f, 8.0f, 0.9f, 3.0f, 0.5); /* below still water */
}

/* The model is lit as in the physical style. */
static void a_model_in_the_legacy_style(void **state)
{
    (void)state;
    gl_sea *renderer = renderer_of(GL_API_ANY);
    facet_sea_desc desc = small(2.0f);
    facet_sea *sea = make_sea(&desc);
    fixture f = spheres();
    shot s;
    make_shot(&s, WIDTH, HEIGHT, 3.0f, 0.35f);
    s.scene = f.scene;
    s.desc.sea_shading = (facet_sea_shading){.style = FACET_SEA_STYLE_LEGACY_INTENDED, .omits_glints = true};
    expose(&s);
    assert_true(compare(renderer, sea, &s, "spheres in the legacy style") < 0.5);
    assert_true(without_model(renderer, sea, &s) > 2.0);
    sea_destroy(sea);
    fixture_destroy(&f);
}

static void a_model_from_below_in_opengl_es(void **state)
{
    (void)state;
    if (IS_SLOW)
        skip();
    compare_model(renderer_of(GL_API_ES), 0.0f, -2.0f, -0.65f, 0.0f, 0.2);
}

/* The same as a still image of its time, whatever was drawn before. */
static void frames_are_stills(void **state)
{
    (void)state;
    facet_sea_desc desc = small(12.0f);
    facet_sea *sea = make_sea(&desc);
    gl_sea *renderer = renderer_of(GL_API_ANY);
    shot s;
    film frame, still;
    make_shot(&s, WIDTH, HEIGHT, 3.0f, 0.1f);
    s.desc.camera = &s.camera;
    expose(&s);
    for (int i = 0; i < 3; i++) {
        waves_set_time(&sea->waves, 0.7 * i);
        draw_gl(renderer, sea, &s, &frame);
        if (i < 2)
            film_destroy(&frame);
    }
    facet_sea *again = make_sea(&desc);
    waves_set_time(&again->waves, 1.4);
    draw_gl(renderer, again, &s, &still);
    assert_memory_equal(frame.layers[0].pixels, still.layers[0].pixels, WIDTH * HEIGHT * 4 * sizeof(float));
    film_destroy(&frame);
    film_destroy(&still);
    sea_destroy(sea);
    sea_destroy(again);
}

static EGLBoolean (*make_current)(EGLDisplay, EGLSurface, EGLSurface, EGLContext);
static int refusals;

static EGLBoolean refuse_once(EGLDisplay display, EGLSurface draw, EGLSurface read, EGLContext context)
{
    return context && refusals++ == 0 ? EGL_FALSE : make_current(display, draw, read, context);
}

static void a_context_that_cannot_be_current_leaves_no_memory(void **state)
{
    (void)state;
    renderer_of(GL_API_ANY);
    failing_allocator counted = {.fail_at = -1};
    facet_allocator allocator = failing_allocator_get(&counted);
    gl_sea *renderer;
    assert_int_equal(gl_sea_create_api(GL_API_ANY, &allocator, &renderer, NULL), FACET_OK);
    assert_true(atomic_load(&counted.blocks) > 1);
    make_current = epoxy_eglMakeCurrent;
    epoxy_eglMakeCurrent = refuse_once;
    gl_sea_destroy(renderer);
    epoxy_eglMakeCurrent = make_current;
    assert_true(refusals > 1);
    assert_int_equal(atomic_load(&counted.blocks), 0);
}

static void unsupported_cameras_are_reported(void **state)
{
    (void)state;
    gl_sea *renderer = renderer_of(GL_API_ANY);
    facet_sea_desc desc = small(0.0f);
    facet_sea *sea = make_sea(&desc);
    shot s;
    facet_error error;
    facet_render_stats stats = {.total_s = 0.0};
    water_frame *frame;
    make_shot(&s, WIDTH, HEIGHT, 3.0f, 0.5f);
    s.camera.fov_y_rad = 0.0f;
    s.camera.ortho_height = 10.0f;
    s.desc.camera = &s.camera;
    s.desc.crop[2] = WIDTH;
    s.desc.crop[3] = HEIGHT;
    s.desc.renderer = FACET_RENDERER_KIND_GL;
    assert_int_equal(film_create(&s.desc.allocator, WIDTH, HEIGHT, 0, &s.film, &error), FACET_OK);
    assert_int_equal(water_frame_create(shot_in(sea, &s), NULL, &s.desc, &frame, &stats, &error), FACET_OK);
    assert_int_equal(gl_sea_draw(renderer, frame, &s.film, &stats, &error), FACET_ERROR_UNSUPPORTED);
    assert_true(strlen(error.message) > 10);
    water_frame_destroy(frame);
    water_cache_clear(&s.cache);
    film_destroy(&s.film);
    sea_destroy(sea);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(opengl_draws_what_the_preview_does),
                                       cmocka_unit_test(opengl_es_draws_what_the_preview_does),
                                       cmocka_unit_test(still_and_shallow_water),
                                       cmocka_unit_test(parts_and_depths),
                                       cmocka_unit_test(other_facets),
                                       cmocka_unit_test(environments),
                                       cmocka_unit_test(models),
                                       cmocka_unit_test(models_far_from_each_other),
                                       cmocka_unit_test(a_model_with_many_textures),
                                       cmocka_unit_test(a_hull_in_waves),
                                       cmocka_unit_test(a_model_in_the_legacy_style),
                                       cmocka_unit_test(a_model_from_below_in_opengl_es),
                                       cmocka_unit_test(frames_are_stills),
                                       cmocka_unit_test(a_context_that_cannot_be_current_leaves_no_memory),
                                       cmocka_unit_test(unsupported_cameras_are_reported)};
    return cmocka_run_group_tests(tests, NULL, destroy_renderers);
}
