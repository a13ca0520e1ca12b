/* Tests of texture_need.h: a texture of 256 x 256 texels on a quad of 2 x 2 m, in an image of 64 x 64
 * pixels. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <string.h>

#include <cmocka.h>

#include "cpu/preview_fixture.h"
#include "cpu/texture_need.h"

typedef struct setup {
    fixture f;
    scene_node *node;
    scene_material *material;
} setup;

static setup setup_create(void)
{
    static const unsigned char texels[4 * 256 * 256];
    setup s = {.f = fixture_create()};
    scene_material material = scene_material_default();
    material.textures[SCENE_BASE_COLOR_TEXTURE].texture = fixture_add_texture(&s.f, 256, 256, texels);
    uint32_t index = fixture_add_material(&s.f, material);
    s.node = fixture_place(&s.f, fixture_add_quad(&s.f, index), 0, 0, 0, 1.0f);
    s.material = &s.f.scene->materials[index];
    return s;
}

static float find_lod(setup *s, float footprint, bool keeps_all_texels)
{
    facet_allocator allocator = {0};
    scene_pose pose;
    camera_rays camera;
    render_geometry_set set;
    texture_use use;
    texture_need_desc desc = {.width = 64,
                              .height = 64,
                              .footprint = footprint,
                              .opacity_footprint = footprint,
                              .keeps_all_texels = keeps_all_texels,
                              .thread_count = 2};
    assert_int_equal(scene_pose_create(s->f.scene, NULL, &allocator, 1, &pose, NULL), FACET_OK);
    assert_int_equal(camera_rays_create(&s->f.camera, 64, 64, &camera, NULL), FACET_OK);
    assert_int_equal(render_geometry_create(s->f.scene, &pose, &allocator, &set, NULL), FACET_OK);
    assert_int_equal(render_geometry_transform(&set, &pose, &camera, &allocator, 1, NULL), FACET_OK);
    assert_int_equal(texture_need(s->f.scene, &set, &camera, &desc, &allocator, &use, NULL), FACET_OK);
    assert_true(use.is_read_as_color && !use.is_read_as_data);
    render_geometry_destroy(&set);
    scene_pose_destroy(&pose);
    return use.min_lod;
}

static float lod_of(setup *s, float footprint)
{
    return find_lod(s, footprint, false);
}

/* A bound, in steps of a quarter. */
static void assert_lod(setup *s, float lod)
{
    float found = lod_of(s, 1.0f);
    if (found > lod + 1e-3f || found < lod - 0.26f)
        fail_msg("lod %g instead of %g", (double)found, (double)lod);
}

static void the_lod_is_that_of_the_pixel(void **state)
{
    (void)state;
    setup s = setup_create();
    assert_lod(&s, 2.0f); /* 4 texels a pixel */
    assert_true(fabsf(lod_of(&s, 0.5f) - 1.0f) < 0.26f);
    s.f.camera.ortho_height = 8.0f;
    assert_lod(&s, 4.0f);
    s.material->textures[SCENE_BASE_COLOR_TEXTURE].has_transform = true; /* twice as many repeats */
    memcpy(s.material->textures[SCENE_BASE_COLOR_TEXTURE].transform, (float[6]){2, 0, 0, 0, 2, 0},
           6 * sizeof(float));
    assert_lod(&s, 5.0f);
    fixture_destroy(&s.f);
}

/* Foreshortening lengthens a footprint: anisotropic filtering reads as finely as head on. */
static void slanted_surfaces_are_read_as_finely(void **state)
{
    (void)state;
    setup s = setup_create();
    s.node->rotation[1] = sinf(0.6f);
    s.node->rotation[3] = cosf(0.6f);
    assert_lod(&s, 2.0f);
    fixture_destroy(&s.f);
}

static void the_nearest_vertex_counts(void **state)
{
    (void)state;
    setup s = setup_create();
    s.f.camera.fov_y_rad = 2.0f * atanf(0.1f); /* 2 m high at 10 m */
    assert_lod(&s, 2.0f);
    s.node->translation[2] = 5.0;
    assert_lod(&s, 1.0f);
    s.node->rotation[0] = sinf(0.75f); /* lies nearly flat, from behind the camera to far away */
    s.node->rotation[3] = cosf(0.75f);
    s.node->scale[0] = s.node->scale[1] = s.node->scale[2] = 20.0f;
    s.node->translation[1] = -1.0;
    s.material->is_double_sided = true;
    assert_true(lod_of(&s, 1.0f) <= 0.0f);
    fixture_destroy(&s.f);
}

/* A spot of 2 % of the pixels that needs a finer mip: not where its error vanishes in the whole, but for coverage and
 * where all texels are kept. */
static void a_spot_may_be_less_sharp(void **state)
{
    (void)state;
    setup s = setup_create();
    scene_material close = *s.material;
    uint32_t index = fixture_add_material(&s.f, close);
    fixture_place(&s.f, fixture_add_quad(&s.f, index), 0.3f, 0.3f, 1.0f, 0.15f); /* 9.6 pixels */
    s.material = &s.f.scene->materials[0];
    scene_texture_ref *ref = &s.f.scene->materials[index].textures[SCENE_BASE_COLOR_TEXTURE];
    ref->scale[0] = ref->scale[1] = 0.135f; /* 3.6 texels a pixel: lod 1.85 */
    scene_texture_ref_update(ref);
    assert_true(lod_of(&s, 1.0f) >= 2.0f);
    assert_true(find_lod(&s, 1.0f, true) < 2.0f);
    s.f.scene->materials[index].alpha_mode = SCENE_ALPHA_MASK;
    assert_true(lod_of(&s, 1.0f) < 2.0f);
    s.f.scene->materials[index].alpha_mode = SCENE_ALPHA_OPAQUE;
    ref->scale[0] = ref->scale[1] = 0.05f; /* 1.3 texels a pixel: lod 0.4 */
    scene_texture_ref_update(ref);
    assert_true(lod_of(&s, 1.0f) < 1.0f);
    fixture_destroy(&s.f);
}

static void what_cannot_be_seen_needs_nothing(void **state)
{
    (void)state;
    setup s = setup_create();
    s.node->translation[0] = 5.0;
    assert_true(lod_of(&s, 1.0f) > 8.0f);
    s.node->translation[0] = 0.0;
    s.node->rotation[1] = 1.0f; /* its back */
    s.node->rotation[3] = 0.0f;
    assert_true(lod_of(&s, 1.0f) > 8.0f);
    s.material->is_double_sided = true;
    assert_lod(&s, 2.0f);
    fixture_destroy(&s.f);
}

static void samplers_without_mips_read_all(void **state)
{
    (void)state;
    setup s = setup_create();
    s.f.scene->textures[0].mip_filter = SCENE_MIP_NONE;
    assert_true(lod_of(&s, 1.0f) <= 0.0f);
    fixture_destroy(&s.f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_lod_is_that_of_the_pixel),
        cmocka_unit_test(slanted_surfaces_are_read_as_finely),
        cmocka_unit_test(the_nearest_vertex_counts),
        cmocka_unit_test(a_spot_may_be_less_sharp),
        cmocka_unit_test(what_cannot_be_seen_needs_nothing),
        cmocka_unit_test(samplers_without_mips_read_all),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
