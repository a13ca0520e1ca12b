/* gl_fixture_test.c - see gl_fixture_test.h. */
#include "gl/scene/gl_fixture_test.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>

#include <cmocka.h>

int gl_fixture_open(gl_fixture_contexts *contexts)
{
    static const gl_api apis[GL_FIXTURE_APIS] = {GL_API_CORE, GL_API_ES};
    facet_error error = {0};
    contexts->count = 0;
    for (int i = 0; i < GL_FIXTURE_APIS; i++) {
        gl_context *c = &contexts->items[contexts->count];
        if (gl_context_create_api(c, apis[i], &error) != FACET_OK)
            continue;
        gl_context_release(c);
        contexts->count++;
    }
    if (contexts->count == 0)
        printf("skipped: %s\n", error.message);
    return contexts->count;
}

void gl_fixture_close(gl_fixture_contexts *contexts)
{
    for (int i = 0; i < contexts->count; i++)
        gl_context_destroy(&contexts->items[i]);
    contexts->count = 0;
}

gl_renderer *gl_fixture_renderer(const fixture *f, gl_context *context)
{
    gl_renderer *renderer = NULL;
    facet_error error = {0};
    if (gl_context_make_current(context, &error) != FACET_OK ||
        gl_renderer_create(f->scene, context, NULL, &renderer, &error) != FACET_OK)
        fail_msg("%s", error.message);
    return renderer;
}

film gl_fixture_draw(const fixture *f, gl_renderer *renderer)
{
    film out;
    facet_render_stats stats;
    facet_error error = {0};
    facet_render_desc desc = fixture_desc(f);
    if (film_create(&desc.allocator, desc.crop[2], desc.crop[3], desc.aovs, &out, &error) != FACET_OK ||
        gl_renderer_render(renderer, &desc, &out, &stats, &error) != FACET_OK)
        fail_msg("%s", error.message);
    return out;
}

facet_result gl_fixture_try_draw(const fixture *f, gl_renderer *renderer, facet_error *error)
{
    film out;
    facet_render_stats stats;
    const facet_render_desc desc = fixture_desc(f);
    assert_int_equal(film_create(NULL, desc.width, desc.height, 0, &out, NULL), FACET_OK);
    facet_result result = gl_renderer_render(renderer, &desc, &out, &stats, error);
    film_destroy(&out);
    return result;
}

film gl_fixture_render(const fixture *f, gl_context *context)
{
    gl_renderer *renderer = gl_fixture_renderer(f, context);
    film out = gl_fixture_draw(f, renderer);
    gl_renderer_destroy(renderer);
    return out;
}

image_difference gl_fixture_compare(const film *a, const film *b, float most)
{
    image_difference d = {0.0, 0.0};
    size_t shown = 0;
    assert_int_equal(a->width, b->width);
    assert_int_equal(a->height, b->height);
    for (size_t i = 0; i < (size_t)a->width * a->height; i++) {
        const float *p = a->layers[0].pixels + 4 * i, *q = b->layers[0].pixels + 4 * i;
        float largest = 0.0f;
        for (int c = 0; c < 4; c++) {
            float difference = fabsf(p[c] - q[c]);
            assert_true(isfinite(difference));
            d.mean += (double)difference / 4.0;
            largest = fmaxf(largest, difference);
        }
        shown += p[3] > 0.0f || q[3] > 0.0f;
        d.share += largest > most;
    }
    assert_true(shown > 0);
    d.mean /= (double)shown;
    d.share /= (double)shown;
    return d;
}

void gl_fixture_assert_pixel(const film *image, uint32_t x, uint32_t y, const float rgba[4], float tolerance)
{
    const float *p = fixture_pixel(image, "", x, y);
    for (int c = 0; c < 4; c++)
        if (!(fabsf(p[c] - rgba[c]) <= tolerance))
            fail_msg("pixel %u, %u is %g %g %g %g in place of %g %g %g %g", x, y, (double)p[0], (double)p[1],
                     (double)p[2], (double)p[3], (double)rgba[0], (double)rgba[1], (double)rgba[2],
                     (double)rgba[3]);
}

void gl_fixture_turn(scene_node *node, float x, float y, float z, float w)
{
    const float rotation[4] = {x, y, z, w};
    for (int i = 0; i < 4; i++)
        node->rotation[i] = rotation[i];
}

scene_material gl_fixture_unlit(float r, float g, float b, float alpha)
{
    scene_material m = scene_material_default();
    const float color[4] = {r, g, b, alpha};
    for (int i = 0; i < 4; i++)
        m.base_color[i] = color[i];
    m.extensions = SCENE_UNLIT;
    if (alpha < 1.0f)
        m.alpha_mode = SCENE_ALPHA_BLEND;
    return m;
}

fixture gl_fixture_scene(void)
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

void gl_fixture_assert_same(const film *a, const film *b)
{
    size_t size = (size_t)a->width * a->height * 4 * sizeof(float);
    assert_int_equal(a->width, b->width);
    assert_int_equal(a->height, b->height);
    assert_memory_equal(a->layers[0].pixels, b->layers[0].pixels, size);
}
