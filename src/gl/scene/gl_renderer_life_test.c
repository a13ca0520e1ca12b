/* gl_renderer_life_test.c - leaks, failures, and renderers in several threads. Exits with 77 where there
 * is no OpenGL. */
#include <epoxy/gl.h>
#include <pthread.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <string.h>

#include <cmocka.h>

#include "tests/support/support.h"
#include "gl/scene/gl_fixture_test.h"

static gl_fixture_contexts contexts;

static void on_each(void (*check)(fixture *f, gl_context *context))
{
    for (int i = 0; i < contexts.count; i++) {
        fixture f = gl_fixture_scene();
        check(&f, &contexts.items[i]);
        fixture_destroy(&f);
    }
}

/* ---- leaks ---- */

enum { KINDS = 8, MAX_NAMES = 20000 };

/* Number of objects of each kind; released names may not be reused at once. */
static void count_objects(int counts[KINDS])
{
    GLboolean (*const is_there[KINDS])(GLuint) = {glIsTexture,      glIsBuffer,      glIsFramebuffer,
                                                  glIsRenderbuffer, glIsVertexArray, glIsQuery,
                                                  glIsProgram,      glIsShader};
    for (int kind = 0; kind < KINDS; kind++) {
        counts[kind] = 0;
        for (GLuint name = 1; name < MAX_NAMES; name++)
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
    GLuint name; /* the test detects a leak */
    glGenTextures(1, &name);
    assert_true(name < MAX_NAMES);
    glDeleteTextures(1, &name);
    for (int kind = 0; kind < KINDS; kind++)
        if (after[kind] != before[kind])
            fail_msg("%d objects of kind %d are left", after[kind] - before[kind], kind);
    gl_context_release(context);
}

static void destroyed_renderers_leave_no_objects(void **state)
{
    (void)state;
    on_each(check_leaks);
}

/* Running out of memory anywhere is reported; the renderer remains usable. */
static void running_out_of_memory_is_reported(void **state)
{
    (void)state;
    gl_context *context = &contexts.items[0];
    fixture f = gl_fixture_scene();
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

static void two_renderers_do_not_interfere(void **state)
{
    (void)state;
    fixture f = gl_fixture_scene(), g = gl_fixture_scene();
    g.scene->materials[0].base_color[0] = 0.1f;
    gl_renderer *a = own_renderer(&f), *b = own_renderer(&g);
    film a1 = gl_fixture_draw(&f, a), b1 = gl_fixture_draw(&g, b);
    film a2 = gl_fixture_draw(&f, a);
    gl_renderer_destroy(a);
    film b2 = gl_fixture_draw(&g, b);
    gl_renderer_destroy(b);
    gl_fixture_assert_same(&a1, &a2);
    gl_fixture_assert_same(&b1, &b2);
    assert_true(gl_fixture_compare(&a1, &b1, 0.01f).share > 0.05);
    film_destroy(&a1), film_destroy(&a2), film_destroy(&b1), film_destroy(&b2);
    fixture_destroy(&f), fixture_destroy(&g);
}

typedef struct errand {
    const fixture *f;
    gl_renderer *renderer;
    film image;
} errand;

static void *draw_elsewhere(void *context)
{
    errand *e = context;
    e->image = gl_fixture_draw(e->f, e->renderer);
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

static void any_thread_can_draw(void **state)
{
    (void)state;
    fixture f = gl_fixture_scene();
    errand e = {.f = &f, .renderer = own_renderer(&f)};
    film here = gl_fixture_draw(&f, e.renderer);
    run_thread(draw_elsewhere, &e);
    gl_fixture_assert_same(&here, &e.image);
    film_destroy(&e.image);
    run_thread(draw_elsewhere, &e);
    gl_fixture_assert_same(&here, &e.image);
    run_thread(destroy_elsewhere, &e);
    film_destroy(&here);
    film_destroy(&e.image);
    fixture_destroy(&f);
}

static unsigned is_reset(void)
{
    return GL_UNKNOWN_CONTEXT_RESET;
}

static void a_lost_context_is_replaced(void **state)
{
    (void)state;
    fixture f = gl_fixture_scene();
    gl_renderer *renderer = own_renderer(&f);
    facet_error error;
    film before = gl_fixture_draw(&f, renderer);
    gl_renderer_get_context(renderer)->reset_status = is_reset;
    assert_int_equal(gl_fixture_try_draw(&f, renderer, &error), FACET_ERROR_SYSTEM);
    assert_non_null(strstr(error.message, "the driver was reset"));
    film after = gl_fixture_draw(&f, renderer);
    gl_fixture_assert_same(&before, &after);
    gl_renderer_destroy(renderer);
    film_destroy(&before);
    film_destroy(&after);
    fixture_destroy(&f);
}

/* The caller's context stays current. */
static void the_callers_context_is_restored(void **state)
{
    (void)state;
    fixture f = gl_fixture_scene();
    gl_context *mine = &contexts.items[0];
    assert_int_equal(gl_context_make_current(mine, NULL), FACET_OK);
    GLuint name;
    glGenTextures(1, &name);
    glBindTexture(GL_TEXTURE_2D, name);
    gl_renderer *renderer = own_renderer(&f);
    film image = gl_fixture_draw(&f, renderer);
    GLint bound = 0;
    glGetIntegerv(GL_TEXTURE_BINDING_2D, &bound);
    assert_int_equal(bound, name);
    gl_renderer_destroy(renderer);
    glGetIntegerv(GL_TEXTURE_BINDING_2D, &bound);
    assert_int_equal(bound, name);
    glDeleteTextures(1, &name);
    gl_context_release(mine);
    film_destroy(&image);
    fixture_destroy(&f);
}

/* ---- limits ---- */

static bool stop_at_once(void *user, const char *stage, double fraction)
{
    (void)stage, (void)fraction;
    return --*(int *)user > 0;
}

static void images_can_be_cancelled(void **state)
{
    (void)state;
    fixture f = gl_fixture_scene();
    gl_renderer *renderer = own_renderer(&f);
    f.desc.samples = 64;
    int calls = 1000000;
    f.desc.progress = (facet_progress){.user = &calls, .report = stop_at_once};
    assert_int_equal(gl_fixture_try_draw(&f, renderer, NULL), FACET_OK);
    int all = 1000000 - calls;
    assert_in_range(all, 4, 100);
    for (int most = 1; most <= all; most++) {
        calls = most;
        assert_int_equal(gl_fixture_try_draw(&f, renderer, NULL), FACET_ERROR_CANCELLED);
    }
    f.desc.progress = (facet_progress){0};
    f.desc.time_limit_s = 1e-9;
    facet_error error;
    assert_int_equal(gl_fixture_try_draw(&f, renderer, &error), FACET_ERROR_LIMIT);
    assert_non_null(strstr(error.message, "the time limit was reached"));
    f.desc.time_limit_s = 60.0;
    assert_int_equal(gl_fixture_try_draw(&f, renderer, NULL), FACET_OK);
    gl_renderer_destroy(renderer);
    fixture_destroy(&f);
}

static void count_warning(void *user, facet_log_level level, const char *said)
{
    (void)level;
    *(int *)user += strncmp(said, "the image is black", 18) == 0;
}

static void scenes_without_light_are_reported(void **state)
{
    (void)state;
    fixture f = fixture_create();
    fixture_place(&f, fixture_add_quad(&f, fixture_add_material(&f, scene_material_default())), 0, 0, 0, 1);
    int count = 0;
    f.desc.log = (facet_log){.user = &count, .message = count_warning};
    gl_renderer *renderer = own_renderer(&f);
    assert_int_equal(gl_fixture_try_draw(&f, renderer, NULL), FACET_OK);
    assert_int_equal(count, 0);
    facet_environment_destroy(f.environment);
    f.environment = NULL;
    assert_int_equal(gl_fixture_try_draw(&f, renderer, NULL), FACET_OK);
    assert_int_equal(count, 1);
    gl_renderer_destroy(renderer);
    fixture_destroy(&f);
}

static GLenum next_error;

static GLenum fake_error(void)
{
    GLenum error = next_error;
    next_error = GL_NO_ERROR;
    return error;
}

/* Browsers have an error code of their own. */
static void both_codes_of_a_lost_context_count(void **state)
{
    (void)state;
    static const GLenum codes[] = {GL_CONTEXT_LOST, 0x9242, GL_INVALID_ENUM};
    GLenum (*const get_error)(void) = epoxy_glGetError;
    for (int i = 0; i < 3; i++) {
        gl_context context = {.name = "none"};
        next_error = codes[i];
        epoxy_glGetError = fake_error;
        facet_result result = gl_context_check(&context, "a test", NULL);
        epoxy_glGetError = get_error;
        assert_int_equal(result, FACET_ERROR_SYSTEM);
        assert_int_equal(context.is_lost, i < 2);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(destroyed_renderers_leave_no_objects),
                                       cmocka_unit_test(running_out_of_memory_is_reported),
                                       cmocka_unit_test(two_renderers_do_not_interfere),
                                       cmocka_unit_test(any_thread_can_draw),
                                       cmocka_unit_test(a_lost_context_is_replaced),
                                       cmocka_unit_test(both_codes_of_a_lost_context_count),
                                       cmocka_unit_test(the_callers_context_is_restored),
                                       cmocka_unit_test(images_can_be_cancelled),
                                       cmocka_unit_test(scenes_without_light_are_reported)};
    if (!gl_fixture_open(&contexts))
        return 77;
    int failed = cmocka_run_group_tests(tests, NULL, NULL);
    gl_fixture_close(&contexts);
    return failed;
}
