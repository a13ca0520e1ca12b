/* without_embree_test.c - the table of renderers in a build without Embree. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <string.h>

#include <cmocka.h>

#include "render/renderer.h"

static void missing_renderers_are_refused_by_name(void **state)
{
    (void)state;
    static const char *const messages[] = {"the preview: this facet was built without it (Embree)",
                                           "path tracing: this facet was built without it (Embree)"};
    facet_render_desc resolved;
    facet_error error;
    for (int kind = FACET_RENDERER_KIND_PREVIEW; kind <= FACET_RENDERER_KIND_PATH; kind++) {
        const facet_render_desc desc = {.renderer = (facet_renderer_kind)kind, .ground = FACET_GROUND_SHADOW};
        assert_int_equal(render_desc_resolve(&desc, &resolved, &error), FACET_ERROR_SYSTEM);
        assert_string_equal(error.message, messages[kind]);
        assert_non_null(renderer_get((facet_renderer_kind)kind)->info.name);
        assert_null(renderer_get((facet_renderer_kind)kind)->draw);
    }
}

static void opengl_resolves_its_desc(void **state)
{
    (void)state;
    facet_render_desc resolved, desc = {.renderer = FACET_RENDERER_KIND_GL};
    assert_int_equal(render_desc_resolve(&desc, &resolved, NULL), FACET_OK);
    assert_int_equal(resolved.width, 1024);
    assert_int_equal(resolved.samples, 4);
    desc.gl.bloom = 2.0f;
    assert_int_equal(render_desc_resolve(&desc, &resolved, NULL), FACET_ERROR_ARGUMENT);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(missing_renderers_are_refused_by_name),
                                       cmocka_unit_test(opengl_resolves_its_desc)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
