/* Tests of report.h: the contents of the page, and its spheres. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "image/image.h"
#include "io/model_file.h"
#include "legacy/convert.h"
#include "report/html.h"
#include "report/report.h"
#include "report/spheres.h"

/* rgl's parameters: a matte and a shiny material, and a hostile name. */
static const char PARAMETERS[] =
    "{\"facet\":\"ogl1\",\"version\":1,\"materials\":["
    "{\"name\":\"matte\",\"color\":[0.8,0.4,0.2],\"specular\":\"black\",\"shininess\":10},"
    "{\"name\":\"shiny\",\"color\":[0.5,0.5,0.5],\"specular\":[0.5,0.5,0.5],\"shininess\":40},"
    "{\"name\":\"<script>alert('x')</script> & "
    "\\\"quotes\\\"\",\"color\":\"white\",\"specular\":\"black\"}]}";

static facet_scene *make_scene(void)
{
    facet_scene *scene = NULL;
    facet_error error;
    const facet_scene_desc desc = {.legacy = {.target = FACET_LEGACY_TARGET_LINEAR}};
    const facet_log silent = {0};
    assert_int_equal(
        model_file_load_memory(PARAMETERS, sizeof PARAMETERS - 1, "test.json", &desc, &scene, &error),
        FACET_OK);
    assert_int_equal(
        legacy_convert(scene, FACET_MATERIAL_MODEL_METALLIC_ROUGHNESS, &desc.legacy, &silent, &error),
        FACET_OK);
    return scene;
}

static char *make_page(const facet_scene *scene)
{
    text page = {0};
    facet_error error;
    assert_int_equal(report_html(scene, &page, &error), FACET_OK);
    assert_false(page.has_failed);
    return page.data;
}

static size_t count(const char *page, const char *what)
{
    size_t n = 0;
    for (const char *at = page; (at = strstr(at, what)); at += strlen(what))
        n++;
    return n;
}

static void every_material_is_listed(void **state)
{
    (void)state;
    facet_scene *scene = make_scene();
    char *page = make_page(scene);
    assert_int_equal(count(page, "<section"), 3);
    assert_int_equal(count(page, "</section>"), 3);
    assert_int_equal(count(page, "data:image/png"), 3 * SPHERE_STYLE_COUNT);
    assert_int_equal(count(page, "<table"), count(page, "</table>"));
    assert_int_equal(count(page, "<div"), count(page, "</div>"));
    assert_int_equal(count(page, "<tr"), count(page, "</tr>"));
    assert_non_null(strstr(page, "<h2>matte"));
    assert_int_equal(count(page, "<script"), 0); /* not from a name either */
    assert_non_null(strstr(page, "&lt;script&gt;"));
    /* worst first: the shiny one before the matte one, which is exact */
    assert_true(strstr(page, "<h2>shiny") < strstr(page, "<h2>matte"));
    mem_free(page);
    scene_destroy(scene);
}

static void pages_are_repeatable(void **state)
{
    (void)state;
    facet_scene *scene = make_scene();
    scene->thread_count = 1;
    char *one = make_page(scene);
    scene->thread_count = 3;
    char *two = make_page(scene);
    assert_string_equal(one, two);
    mem_free(one);
    mem_free(two);
    scene_destroy(scene);
}

static void draw(sphere_stage *stage, uint32_t material, sphere_style look, image *out)
{
    unsigned char *bytes;
    size_t size;
    facet_error error;
    const image_decode_desc desc = {.channel_count = 4};
    assert_int_equal(sphere_draw(stage, material, look, 64, &bytes, &size, &error), FACET_OK);
    assert_int_equal(image_decode(bytes, size, "sphere", &desc, out, &error), FACET_OK);
    mem_free(bytes);
}

/* Largest difference of two images, in codes. */
static int difference(const image *a, const image *b)
{
    const unsigned char *x = a->pixels;
    const unsigned char *y = b->pixels;
    int most = 0;
    for (size_t i = 0; i < image_row_size(a) * a->height; i++)
        most = abs(x[i] - y[i]) > most ? abs(x[i] - y[i]) : most;
    return most;
}

/* Without a highlight both models are Lambert's and the spheres are equal; with one they differ. */
static void matte_balls_are_equal(void **state)
{
    (void)state;
    facet_scene *scene = make_scene();
    sphere_stage *stage;
    facet_error error;
    image old = {0};
    image new = {0};
    assert_int_equal(sphere_stage_create(scene, &stage, &error), FACET_OK);
    draw(stage, 0, SPHERE_OGL1_LINEAR, &old);
    draw(stage, 0, SPHERE_PBR, &new);
    assert_in_range(difference(&old, &new), 0, 1);
    image_destroy(&old);
    image_destroy(&new);
    draw(stage, 1, SPHERE_OGL1_LINEAR, &old);
    draw(stage, 1, SPHERE_PBR, &new);
    assert_in_range(difference(&old, &new), 2, 120);
    image_destroy(&old);
    image_destroy(&new);
    sphere_stage_destroy(stage);
    scene_destroy(scene);
}

static void text_is_escaped(void **state)
{
    (void)state;
    text t = {0};
    html_image(&t, "image/png", (const unsigned char *)"Man", 3, 1, 1, "");
    assert_non_null(strstr(t.data, "base64,TWFu\""));
    text_destroy(&t);
    html_image(&t, "image/png", (const unsigned char *)"Ma", 2, 1, 1, "");
    assert_non_null(strstr(t.data, "base64,TWE=\""));
    text_destroy(&t);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(text_is_escaped),
        cmocka_unit_test(every_material_is_listed),
        cmocka_unit_test(pages_are_repeatable),
        cmocka_unit_test(matte_balls_are_equal),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
