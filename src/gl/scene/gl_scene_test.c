/* gl_scene_test.c - caching from image to image changes no pixel: frames of an animation equal those of fresh
 * renderers to the last bit. Exits with 77 where there is no OpenGL. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "tests/support/support.h"

#include "gl/scene/gl_fixture_test.h"
#include "gl/scene/gl_scene.h"

static gl_fixture_contexts contexts;

/* A moving sphere, a quad bent by a morph target, a quad at rest; with normal maps, so that all have
 * tangents. */
static const float times[3] = {0.0f, 0.5f, 1.0f};
static const float places[9] = {-0.5f, 0.0f, 0.0f, 0.0f, 0.5f, 0.0f, 0.5f, 0.0f, 0.3f};
static const float weights[3] = {0.0f, 1.0f, 0.25f}, rest[1] = {0.0f};
static const float moves[12] = {0.0f, 0.0f, 0.4f, 0.1f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.4f};
static const scene_morph_target target = {.positions = moves};
static const scene_sampler samplers[2] = {
    {.interpolation = SCENE_LINEAR, .key_count = 3, .times = times, .width = 3, .values = places},
    {.interpolation = SCENE_LINEAR, .key_count = 3, .times = times, .width = 1, .values = weights}};
static const scene_channel channels[2] = {
    {.kind = SCENE_TARGET_NODE, .index = 0, .offset = offsetof(scene_node, translation), .scale = 1.0f},
    {.kind = SCENE_TARGET_WEIGHTS, .index = 1, .scale = 1.0f, .sampler = 1}};
static scene_animation animation = {.name = "",
                                    .channel_count = 2,
                                    .sampler_count = 2,
                                    .channels = channels,
                                    .samplers = samplers,
                                    .end_s = 1.0f};
static const uint32_t first_animation = 0;

static fixture animated_fixture(void)
{
    static const unsigned char bumps[16] = {128, 128, 255, 255, 190, 128, 220, 255,
                                            128, 190, 220, 255, 66,  128, 220, 255};
    fixture f = fixture_create();
    scene_material m = scene_material_default();
    m.textures[SCENE_NORMAL_TEXTURE].texture = fixture_add_texture(&f, 2, 2, bumps);
    m.perceptual_roughness = 0.4f;
    m.is_double_sided = true;
    uint32_t material = fixture_add_material(&f, m);
    fixture_place(&f, fixture_add_sphere(&f, 16, material), 0.0f, 0.0f, 0.0f, 0.3f);
    for (int i = 0; i < 2; i++) {
        uint32_t quad = fixture_add_quad(&f, material);
        scene_primitive *p = fixture_primitive(&f, quad);
        fixture_place(&f, quad, i ? 0.5f : -0.5f, -0.5f, 0.0f, 0.4f);
        if (i)
            continue;
        p->target_count = 1;
        p->targets = &target;
        f.scene->meshes[quad].weight_count = 1;
        f.scene->meshes[quad].weights = rest;
    }
    f.scene->animations = &animation;
    f.scene->animation_count = 1;
    f.desc.pose = (facet_pose_desc){.animation_count = 1, .animations = &first_animation};
    return f;
}

static void update(gl_scene *s, const fixture *f)
{
    facet_error error = {0};
    if (gl_scene_update(s, &f->desc, &error) != FACET_OK)
        fail_msg("%s", error.message);
}

static void an_unchanged_pose_is_kept(void **state)
{
    (void)state;
    fixture f = animated_fixture();
    gl_scene s;
    gl_scene_init(&s, f.scene, NULL);
    assert_int_equal(s.revision, 0);
    update(&s, &f);
    uint64_t revision = s.revision;
    const scene_instance *instances = s.pose.instances;
    const float *sphere = s.geometries.items[0].tangents, *bent = s.geometries.items[1].positions;
    assert_non_null(sphere);
    assert_ptr_equal(bent, f.scene->meshes[1].primitives->positions); /* not bent yet */
    update(&s, &f);
    f.desc.width = 99; /* another camera */
    update(&s, &f);
    assert_int_equal(s.revision, revision);
    assert_ptr_equal(s.pose.instances, instances);

    f.desc.pose.time_s = 0.4;
    update(&s, &f);
    assert_true(s.revision > revision);
    assert_ptr_equal(s.geometries.items[0].tangents, sphere); /* only its transform changes */
    assert_ptr_not_equal(s.geometries.items[1].positions, bent);
    assert_true(s.geometries.items[1].has_corner_tangents);
    assert_ptr_equal(s.geometries.items[0].world, &s.pose.instances[0].world);
    assert_int_equal(s.generation, 0);
    gl_scene_clear(&s);
    assert_int_equal(s.generation, 1);
    assert_null(s.pose.instances);
    fixture_destroy(&f);
}

static void frames_match_fresh_renderers(void **state)
{
    (void)state;
    for (int c = 0; c < contexts.count; c++) {
        fixture f = animated_fixture();
        f.desc.width = f.desc.height = 48;
        gl_renderer *kept = gl_fixture_renderer(&f, &contexts.items[c]);
        static const double at[5] = {0.0, 0.3, 0.3, 0.9, 0.0};
        for (int frame = 0; frame < 5; frame++) {
            f.desc.pose.time_s = at[frame];
            f.camera.eye[0] = frame == 2 ? 1.0f : 0.0f;
            film image = gl_fixture_draw(&f, kept), fresh = gl_fixture_render(&f, &contexts.items[c]);
            assert_memory_equal(image.layers[0].pixels, fresh.layers[0].pixels, 4 * sizeof(float) * 48 * 48);
            if (c == 0) {
                film preview = fixture_render(&f);
                assert_true(gl_fixture_compare(&image, &preview, 0.1f).share < 0.05);
                film_destroy(&preview);
            }
            film_destroy(&image);
            film_destroy(&fresh);
        }
        gl_renderer_destroy(kept);
        fixture_destroy(&f);
    }
}

/* ---- memory ---- */

static void running_out_of_memory_is_reported(void **state)
{
    (void)state;
    fixture f = animated_fixture();
    failing_allocator p = {.fail_at = -1};
    facet_allocator allocator = failing_allocator_get(&p);
    f.desc.thread_count = 1;
    int refused = 0;
    for (int calls = 0;; calls++) {
        gl_scene s;
        gl_scene_init(&s, f.scene, &allocator);
        f.desc.pose.time_s = 0.2;
        assert_int_equal(gl_scene_update(&s, &f.desc, NULL), FACET_OK);
        f.desc.pose.time_s = 0.7; /* memory runs out in the second frame */
        p.fail_at = p.calls + calls;
        facet_result result = gl_scene_update(&s, &f.desc, NULL);
        bool has_all = p.calls <= p.fail_at;
        if (result != FACET_OK) {
            refused++;
            assert_int_equal(result, FACET_ERROR_MEMORY);
            assert_null(s.pose.instances);
            assert_null(s.geometries.items);
        }
        p.fail_at = -1;
        assert_int_equal(gl_scene_update(&s, &f.desc, NULL), FACET_OK); /* and it remains usable */
        assert_int_equal(s.geometries.count, 3);
        gl_scene_clear(&s);
        assert_int_equal(p.blocks, 0);
        if (has_all)
            break;
    }
    assert_true(refused > 5);
    fixture_destroy(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(an_unchanged_pose_is_kept),
        cmocka_unit_test(frames_match_fresh_renderers),
        cmocka_unit_test(running_out_of_memory_is_reported),
    };
    if (!gl_fixture_open(&contexts))
        return 77;
    int failed = cmocka_run_group_tests(tests, NULL, NULL);
    gl_fixture_close(&contexts);
    return failed;
}
