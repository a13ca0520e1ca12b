/* gl_context_web_test.c - what browsers do and desktop drivers do not: contexts that are lost at any time, and
 * the strict rules of OpenGL ES 3.0 for the levels of textures that are drawn into. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <string.h>

#include <cmocka.h>
#include <epoxy/gl.h>

#include "gl/core/gl_texture.h"
#include "gl/scene/gl_fixture_test.h"
#include "gl_tests.h"

enum { CONTEXT_LOST_WEBGL = 0x9242 };

static gl_fixture_contexts contexts;

static void renew(void)
{
    assert_true(gl_tests_renew_context());
    assert_int_equal(gl_fixture_open(&contexts), 1);
}

/* ---- strict rules ---- */

static unsigned status_of_level(unsigned texture, int level)
{
    GLuint framebuffer;
    glGenFramebuffers(1, &framebuffer);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, texture, level);
    unsigned status = glCheckFramebufferStatus(GL_FRAMEBUFFER);
    glDeleteFramebuffers(1, &framebuffer);
    return status;
}

/* Otherwise this run would find no more than one on a desktop. */
static void this_driver_is_strict(void **state)
{
    (void)state;
    GLuint texture;
    glGenTextures(1, &texture);
    glBindTexture(GL_TEXTURE_2D, texture);
    for (int level = 0; level < 3; level++)
        glTexImage2D(GL_TEXTURE_2D, level, GL_RGBA8, 4 >> level, 4 >> level, 0, GL_RGBA, GL_UNSIGNED_BYTE,
                     NULL);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAX_LEVEL, 0);
    assert_int_not_equal(status_of_level(texture, 1), GL_FRAMEBUFFER_COMPLETE);
    glDeleteTextures(1, &texture);
}

static void levels_outside_of_the_range_that_is_read_can_be_drawn_into(void **state)
{
    (void)state;
    static const unsigned formats[] = {GL_RGBA8, GL_SRGB8_ALPHA8, GL_RGBA16F};
    const gl_context *context = &contexts.items[0];
    assert_true(context->has_texture_storage);
    for (int i = 0; i < 3; i++) {
        GLuint texture;
        GLint is_immutable = 0;
        glGenTextures(1, &texture);
        glBindTexture(GL_TEXTURE_2D, texture);
        gl_texture_allocate(context, 3, formats[i], 4, 4);
        glGetTexParameteriv(GL_TEXTURE_2D, GL_TEXTURE_IMMUTABLE_FORMAT, &is_immutable);
        assert_true(is_immutable);
        glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAX_LEVEL, 0);
        for (int level = 0; level < 3; level++)
            assert_int_equal(status_of_level(texture, level), GL_FRAMEBUFFER_COMPLETE);
        glDeleteTextures(1, &texture);
    }
    assert_int_equal(glGetError(), GL_NO_ERROR);
}

/* Glass reads the levels of the opaque surfaces while it is drawn. */
static void glass_before_a_lamp_is_drawn_without_errors(void **state)
{
    (void)state;
    fixture f = fixture_create();
    scene_material glass = scene_material_default(), lamp = gl_fixture_unlit(0.9f, 0.5f, 0.1f, 1.0f);
    glass.extensions |= SCENE_TRANSMISSION;
    glass.transmission = 1.0f;
    glass.perceptual_roughness = 0.3f;
    glass.metallic = 0.0f;
    fixture_place(&f, fixture_add_quad(&f, fixture_add_material(&f, lamp)), 0.0f, 0.0f, -1.0f, 1.0f);
    fixture_place(&f, fixture_add_sphere(&f, 24, fixture_add_material(&f, glass)), 0.0f, 0.0f, 0.5f, 0.5f);
    f.desc.gl.bloom = 0.2f;
    film image = gl_fixture_render(&f, &contexts.items[0]);
    assert_true(fixture_pixel(&image, "", 32, 32)[0] > 0.3f);
    assert_int_equal(glGetError(), GL_NO_ERROR);
    film_destroy(&image);
    fixture_destroy(&f);
}

/* ---- lost contexts ---- */

static void a_lost_context_is_reported_and_the_next_one_draws_the_same(void **state)
{
    (void)state;
    fixture f = gl_fixture_scene();
    gl_renderer *renderer = gl_fixture_renderer(&f, &contexts.items[0]);
    film before = gl_fixture_draw(&f, renderer);
    gl_tests_lose_context();
    facet_error error = {0};
    for (int i = 0; i < 2; i++) {
        assert_int_equal(gl_fixture_try_draw(&f, renderer, &error), FACET_ERROR_SYSTEM);
        assert_non_null(strstr(error.message, "the driver was reset"));
    }
    assert_true(contexts.items[0].is_lost);
    gl_renderer_destroy(renderer);
    renew();
    film after = gl_fixture_render(&f, &contexts.items[0]);
    gl_fixture_assert_same(&before, &after);
    film_destroy(&before);
    film_destroy(&after);
    fixture_destroy(&f);
}

static void the_browsers_code_of_a_lost_context_counts(void **state)
{
    (void)state;
    gl_context *context = &contexts.items[0];
    context->reset_status = NULL; /* the code alone */
    gl_tests_lose_context();
    assert_int_equal(gl_context_check(context, "a test", NULL), FACET_ERROR_SYSTEM);
    assert_true(context->is_lost);
    renew();
    gl_tests_lose_context();
    assert_int_equal(glGetError(), CONTEXT_LOST_WEBGL);
    renew();
    assert_int_equal(gl_context_check(&contexts.items[0], "a test", NULL), FACET_OK);
}

/* Renderers are released while the context is lost: a page must not keep objects of a context that is gone. */
static void renderers_of_a_lost_context_can_be_destroyed(void **state)
{
    (void)state;
    fixture f = gl_fixture_scene();
    gl_renderer *renderer = gl_fixture_renderer(&f, &contexts.items[0]);
    film image = gl_fixture_draw(&f, renderer);
    gl_tests_lose_context();
    gl_renderer_destroy(renderer);
    renew();
    film_destroy(&image);
    fixture_destroy(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(this_driver_is_strict),
        cmocka_unit_test(levels_outside_of_the_range_that_is_read_can_be_drawn_into),
        cmocka_unit_test(glass_before_a_lamp_is_drawn_without_errors),
        cmocka_unit_test(a_lost_context_is_reported_and_the_next_one_draws_the_same),
        cmocka_unit_test(the_browsers_code_of_a_lost_context_counts),
        cmocka_unit_test(renderers_of_a_lost_context_can_be_destroyed)};
    if (!gl_fixture_open(&contexts))
        return 77;
    int failed = cmocka_run_group_tests(tests, NULL, NULL);
    gl_fixture_close(&contexts);
    return failed;
}
