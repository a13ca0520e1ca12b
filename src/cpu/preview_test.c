/* Tests of the preview renderer's geometry: silhouettes, depth, cameras, culling, sprites, crops, threads,
 * limits. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "cpu/preview_fixture.h"
#include "tests/support/support.h"

static double coverage(const film *rendered)
{
    double sum = 0.0;
    for (uint32_t i = 0; i < rendered->width * rendered->height; i++)
        sum += (double)rendered->layers[0].pixels[4 * i + 3];
    return sum;
}

/* ---- silhouettes and depth ---- */

static void a_sphere_covers_its_disc(void **state)
{
    (void)state;
    static const uint32_t samples[] = {1, 4, 7, 16};
    for (int i = 0; i < 4; i++) {
        fixture f = fixture_create();
        f.camera.ortho_height = 2.5f;
        f.desc.width = f.desc.height = 100;
        f.desc.samples = samples[i];
        fixture_place(&f, fixture_add_sphere(&f, 256, SCENE_NONE), 0.0f, 0.0f, 0.0f, 1.0f);
        film rendered = fixture_render(&f);
        double disc = 3.14159265 * 40.0 * 40.0;
        assert_true(fabs(coverage(&rendered) - disc) < (samples[i] == 1 ? 0.005 : 0.002) * disc);
        film_destroy(&rendered);
        fixture_destroy(&f);
    }
}

static void depth_is_along_the_axis(void **state)
{
    (void)state;
    for (int is_perspective = 0; is_perspective < 2; is_perspective++) {
        fixture f = fixture_create();
        f.camera.fov_y_rad = is_perspective ? 1.0f : 0.0f;
        f.desc.aovs = FACET_AOV_DEPTH | FACET_AOV_NORMAL | FACET_AOV_UV;
        fixture_place(&f, fixture_add_quad(&f, SCENE_NONE), 0.0f, 0.0f, 0.0f, 20.0f);
        film rendered = fixture_render(&f);
        for (uint32_t y = 0; y < 64; y += 9)
            for (uint32_t x = 0; x < 64; x += 9) {
                assert_true(fabsf(*fixture_pixel(&rendered, "depth", x, y) - 10.0f) < 1e-5f);
                const float *N = fixture_pixel(&rendered, "normal", x, y);
                assert_true(fabsf(N[0]) < 1e-6f && fabsf(N[1]) < 1e-6f && fabsf(N[2] - 1.0f) < 1e-6f);
                /* The image is as wide as 2 m or 20 tan(0.5) m of a quad of 40 m. */
                float width = is_perspective ? 20.0f * tanf(0.5f) : 2.0f;
                const float *uv = fixture_pixel(&rendered, "uv", x, y);
                assert_true(fabsf(uv[0] - 0.5f - ((float)x + 0.5f - 32.0f) / 64.0f * width / 40.0f) < 1e-5f);
                assert_true(fabsf(uv[1] - 0.5f - ((float)y + 0.5f - 32.0f) / 64.0f * width / 40.0f) < 1e-5f);
            }
        film_destroy(&rendered);
        fixture_destroy(&f);
    }
}

static void depth_of_a_sphere(void **state)
{
    (void)state;
    fixture f = fixture_create();
    f.desc.aovs = FACET_AOV_DEPTH;
    fixture_place(&f, fixture_add_sphere(&f, 512, SCENE_NONE), 0.0f, 0.0f, 0.0f, 1.0f);
    film rendered = fixture_render(&f);
    for (uint32_t y = 8; y < 56; y += 3)
        for (uint32_t x = 8; x < 56; x += 3) {
            double px = (x + 0.5 - 32.0) / 32.0;
            double py = (y + 0.5 - 32.0) / 32.0;
            if (px * px + py * py > 0.81)
                continue;
            double depth = 10.0 - sqrt(1.0 - px * px - py * py);
            assert_true(fabs((double)*fixture_pixel(&rendered, "depth", x, y) - depth) < 2e-4);
        }
    film_destroy(&rendered);
    fixture_destroy(&f);
}

static void clipping_planes_clip(void **state)
{
    (void)state;
    fixture f = fixture_create();
    uint32_t mesh = fixture_add_quad(&f, SCENE_NONE);
    fixture_place(&f, mesh, 0.0f, 0.0f, 2.0f, 2.0f);
    fixture_place(&f, mesh, 0.0f, 0.0f, 0.0f, 2.0f);
    f.desc.aovs = FACET_AOV_DEPTH;
    f.camera.near_m = 9.0f; /* the first quad is at 8 m */
    film rendered = fixture_render(&f);
    assert_true(fabsf(*fixture_pixel(&rendered, "depth", 32, 32) - 10.0f) < 1e-5f);
    film_destroy(&rendered);
    f.camera.far_m = 9.5f;
    rendered = fixture_render(&f);
    assert_true(isinf(*fixture_pixel(&rendered, "depth", 32, 32)));
    assert_true(coverage(&rendered) == 0.0);
    film_destroy(&rendered);
    fixture_destroy(&f);
}

/* A camera made for a square shows the whole square in wide and in tall images. */
static void images_show_what_the_camera_was_made_for(void **state)
{
    (void)state;
    static const uint32_t sizes[3][2] = {{64, 64}, {128, 64}, {64, 128}};
    for (int i = 0; i < 3; i++) {
        fixture f = fixture_create();
        f.camera.aspect = 1.0f;
        f.desc.width = sizes[i][0];
        f.desc.height = sizes[i][1];
        fixture_place(&f, fixture_add_quad(&f, SCENE_NONE), 0.0f, 0.0f, 0.0f, 1.0f);
        film rendered = fixture_render(&f);
        assert_true(fabs(coverage(&rendered) - 64.0 * 64.0) < 1.0);
        film_destroy(&rendered);
        fixture_destroy(&f);
    }
}

static void a_camera_that_looks_nowhere_is_an_error(void **state)
{
    (void)state;
    fixture f = fixture_create();
    film rendered;
    facet_render_stats stats;
    facet_error error;
    f.camera.eye[2] = 0.0f;
    assert_int_equal(fixture_try_render(&f, &rendered, &stats, &error), FACET_ERROR_ARGUMENT);
    film_destroy(&rendered);
    fixture_destroy(&f);
}

/* ---- sides ---- */

static double coverage_of_quad(bool is_double_sided, bool is_mirrored, bool from_behind)
{
    fixture f = fixture_create();
    scene_material material = scene_material_default();
    material.is_double_sided = is_double_sided;
    scene_node *node =
        fixture_place(&f, fixture_add_quad(&f, fixture_add_material(&f, material)), 0, 0, 0, 0.5f);
    if (is_mirrored)
        node->scale[0] = -0.5f;
    if (from_behind)
        f.camera.eye[2] = -10.0f;
    film rendered = fixture_render(&f);
    double sum = coverage(&rendered);
    film_destroy(&rendered);
    fixture_destroy(&f);
    return sum;
}

static void backs_are_culled_unless_double_sided(void **state)
{
    (void)state;
    for (int is_mirrored = 0; is_mirrored < 2; is_mirrored++) {
        assert_true(fabs(coverage_of_quad(false, is_mirrored, false) - 1024.0) < 1.0);
        assert_true(coverage_of_quad(false, is_mirrored, true) == 0.0);
        assert_true(fabs(coverage_of_quad(true, is_mirrored, false) - 1024.0) < 1.0);
        assert_true(fabs(coverage_of_quad(true, is_mirrored, true) - 1024.0) < 1.0);
    }
}

static void normals_face_the_eye(void **state)
{
    (void)state;
    for (int variant = 0; variant < 4; variant++) {
        fixture f = fixture_create();
        scene_material material = scene_material_default();
        material.is_double_sided = true;
        scene_node *node =
            fixture_place(&f, fixture_add_quad(&f, fixture_add_material(&f, material)), 0, 0, 0, 1.0f);
        node->scale[0] = variant & 1 ? -1.0f : 1.0f;
        f.camera.eye[2] = variant & 2 ? -10.0f : 10.0f;
        f.desc.aovs = FACET_AOV_NORMAL;
        film rendered = fixture_render(&f);
        assert_true(fabsf(fixture_pixel(&rendered, "normal", 20, 40)[2] - (variant & 2 ? -1.0f : 1.0f)) <
                    1e-6f);
        film_destroy(&rendered);
        fixture_destroy(&f);
    }
}

/* Two single-sided quads at the same place, back to back: each side shows its own. */
static void coincident_backs_hide_nothing(void **state)
{
    (void)state;
    for (int side = 0; side < 2; side++) {
        fixture f = fixture_create();
        for (int i = 0; i < 2; i++) {
            scene_material material = scene_material_default();
            material.extensions = SCENE_UNLIT;
            material.base_color[0] = (float)i;
            scene_node *node =
                fixture_place(&f, fixture_add_quad(&f, fixture_add_material(&f, material)), 0, 0, 0, 1.0f);
            if (i) { /* half a turn around y */
                node->rotation[1] = 1.0f;
                node->rotation[3] = 0.0f;
            }
        }
        f.camera.eye[2] = side ? -10.0f : 10.0f;
        film rendered = fixture_render(&f);
        for (uint32_t i = 0; i < 64; i++) {
            const float *pixel = fixture_pixel(&rendered, "", i, 63 - i);
            assert_true(fabsf(pixel[0] - (float)side) < 1e-6f && pixel[3] == 1.0f);
        }
        film_destroy(&rendered);
        fixture_destroy(&f);
    }
}

/* ---- points and lines ---- */

static void points_and_lines_are_a_pixel_wide(void **state)
{
    (void)state;
    static const float point[3] = {0.3f, -0.2f, 0.0f};
    static const float line[6] = {-0.8f, -0.5f, 0.0f, 0.8f, 0.3f, -3.0f};
    for (int variant = 0; variant < 8; variant++) {
        bool is_line = variant & 1;
        fixture f = fixture_create();
        f.camera.fov_y_rad = variant & 2 ? 0.25f : 0.0f;
        f.desc.samples = variant & 4 ? 16 : 1;
        fixture_place(&f,
                      fixture_add_sprites(&f, is_line ? SCENE_LINES : SCENE_POINTS, is_line ? line : point,
                                          is_line ? 2 : 1, SCENE_NONE),
                      0, 0, 0, 1.0f);
        film rendered = fixture_render(&f);
        if (!is_line) {
            assert_true(coverage(&rendered) >= 0.9 && coverage(&rendered) <= 4.0);
        } else {
            for (uint32_t x = 14; x < 46; x++) {
                double column = 0.0;
                for (uint32_t y = 0; y < 64; y++)
                    column += (double)fixture_pixel(&rendered, "", x, y)[3];
                assert_true(column >= 0.9 && column <= 2.5);
            }
        }
        film_destroy(&rendered);
        fixture_destroy(&f);
    }
}

/* ---- sameness ---- */

/* Everything at once: overlapping, coincident, transparent, textured, sprites, a light. */
static fixture busy_scene(void)
{
    fixture f = fixture_create();
    f.desc.width = 150;
    f.desc.height = 110;
    f.camera.fov_y_rad = 0.3f;
    f.desc.aovs = FACET_AOV_DEPTH | FACET_AOV_NORMAL | FACET_AOV_MATERIAL_ID;
    unsigned char texels[4 * 64];
    for (uint32_t i = 0; i < sizeof texels; i++)
        texels[i] = (unsigned char)(i * 37 % 251);
    uint32_t texture = fixture_add_texture(&f, 8, 8, texels);
    scene_material glass = scene_material_default();
    glass.alpha_mode = SCENE_ALPHA_BLEND;
    glass.base_color[3] = 0.4f;
    glass.textures[SCENE_BASE_COLOR_TEXTURE].texture = texture;
    scene_material leaf = scene_material_default();
    leaf.alpha_mode = SCENE_ALPHA_MASK;
    leaf.alpha_cutoff = 0.5f;
    leaf.textures[SCENE_BASE_COLOR_TEXTURE].texture = texture;
    scene_material solid = scene_material_default();
    solid.metallic = 0.0f;
    solid.base_color[1] = 0.3f;
    uint32_t meshes[4] = {fixture_add_quad(&f, fixture_add_material(&f, glass)),
                          fixture_add_quad(&f, fixture_add_material(&f, leaf)),
                          fixture_add_quad(&f, fixture_add_material(&f, solid)),
                          fixture_add_sphere(&f, 96, SCENE_NONE)};
    for (int i = 0; i < 24; i++)
        fixture_place(&f, meshes[i % 4], (float)(i % 5 - 2) * 0.4f, (float)(i % 7 - 3) * 0.3f, (float)(i / 8),
                      0.5f);
    for (int i = 0; i < 6; i++) /* all in one place */
        fixture_place(&f, meshes[i % 3], 0.6f, 0.5f, 3.0f, 0.4f);
    scene_light light = {.name = "", .type = SCENE_LIGHT_POINT, .color = {1, 1, 1}, .intensity = 30.0f};
    fixture_add_light(&f, light, 1.0f, 2.0f, 5.0f);
    return f;
}

static void assert_same_for_all_threads(fixture *f)
{
    static const uint32_t threads[] = {2, 3, 8, 2};
    f->desc.thread_count = 1;
    film first = fixture_render(f);
    for (int i = 0; i < 4; i++) {
        f->desc.thread_count = threads[i];
        film rendered = fixture_render(f);
        fixture_assert_same(&first, &rendered);
        film_destroy(&rendered);
    }
    film_destroy(&first);
}

static void images_do_not_depend_on_threads(void **state)
{
    (void)state;
    fixture f = busy_scene();
    assert_same_for_all_threads(&f);
    fixture_destroy(&f);
}

/* Built another way: see choose_quality() of embree_scene.c. Thirty triangles in each place, that shade
 * alike but for rounding. */
static void large_meshes_do_not_depend_on_threads(void **state)
{
    (void)state;
    fixture f = fixture_create();
    f.desc.width = f.desc.height = 100;
    f.desc.aovs = FACET_AOV_NORMAL;
    uint32_t mesh = fixture_add_sphere(&f, 300, SCENE_NONE);
    scene_primitive *primitive = &f.scene->meshes[mesh].primitives[0];
    uint32_t *indices = (uint32_t *)(uintptr_t)primitive->indices;
    for (size_t i = 0; i < primitive->index_count / 3; i++)
        for (size_t k = 0; k < 3; k++)
            indices[3 * i + k] = indices[3 * (i / 30 * 30) + (k + i) % 3];
    fixture_place(&f, mesh, 0, 0, 0, 1.0f);
    assert_same_for_all_threads(&f);
    fixture_destroy(&f);
}

static void a_crop_is_a_part_of_the_whole(void **state)
{
    (void)state;
    static const uint32_t crops[3][4] = {{0, 0, 1, 1}, {37, 21, 62, 50}, {149, 109, 1, 1}};
    fixture f = busy_scene();
    film whole = fixture_render(&f);
    for (int i = 0; i < 3; i++) {
        memcpy(f.desc.crop, crops[i], sizeof f.desc.crop);
        film part = fixture_render(&f);
        for (uint32_t layer = 0; layer < whole.layer_count; layer++) {
            uint32_t channels = whole.layers[layer].channel_count;
            for (uint32_t y = 0; y < crops[i][3]; y++)
                assert_memory_equal(part.layers[layer].pixels + (size_t)y * crops[i][2] * channels,
                                    whole.layers[layer].pixels +
                                        ((size_t)(y + crops[i][1]) * whole.width + crops[i][0]) * channels,
                                    crops[i][2] * channels * sizeof(float));
        }
        film_destroy(&part);
    }
    film_destroy(&whole);
    fixture_destroy(&f);
}

/* ---- limits ---- */

typedef struct reports {
    double last;
    int calls, cancel_at;
    bool is_ordered;
} reports;

static bool tell(void *user, const char *stage, double fraction)
{
    reports *t = user;
    if (strcmp(stage, "shade") == 0) {
        t->is_ordered = t->is_ordered && fraction >= t->last && fraction <= 1.0;
        t->last = fraction;
    }
    return ++t->calls != t->cancel_at;
}

static void progress_is_reported_in_order_and_cancels(void **state)
{
    (void)state;
    fixture f = busy_scene();
    for (int cancel_at = 0; cancel_at < 6; cancel_at++) {
        reports t = {.cancel_at = cancel_at, .is_ordered = true};
        f.desc.progress = (facet_progress){.user = &t, .report = tell};
        film rendered;
        facet_render_stats stats;
        facet_error error;
        facet_result result = fixture_try_render(&f, &rendered, &stats, &error);
        assert_int_equal(result, cancel_at ? FACET_ERROR_CANCELLED : FACET_OK);
        assert_true(t.is_ordered);
        if (!cancel_at)
            assert_true(t.last == 1.0 && t.calls > 5);
        film_destroy(&rendered);
    }
    fixture_destroy(&f);
}

static void a_time_limit_is_kept(void **state)
{
    (void)state;
    fixture f = busy_scene();
    f.desc.time_limit_s = 1e-9;
    film rendered;
    facet_render_stats stats;
    facet_error error;
    assert_int_equal(fixture_try_render(&f, &rendered, &stats, &error), FACET_ERROR_LIMIT);
    assert_non_null(strstr(error.message, "time limit"));
    film_destroy(&rendered);
    f.desc.time_limit_s = 100.0;
    assert_int_equal(fixture_try_render(&f, &rendered, &stats, &error), FACET_OK);
    assert_true(stats.rays >= 150 * 110 * 5 && stats.shades > 0);
    film_destroy(&rendered);
    fixture_destroy(&f);
}

static void running_out_of_memory_leaks_nothing(void **state)
{
    (void)state;
    fixture f = busy_scene();
    f.desc.width = f.desc.height = 40;
    f.desc.thread_count = 1;
    for (long fail_at = 0;; fail_at++) {
        failing_allocator memory = {.fail_at = fail_at};
        f.desc.allocator = failing_allocator_get(&memory);
        film rendered = {0};
        facet_render_stats stats;
        facet_error error;
        facet_result result = fixture_try_render(&f, &rendered, &stats, &error);
        film_destroy(&rendered);
        assert_int_equal(memory.blocks, 0);
        assert_true(result == FACET_OK || result == FACET_ERROR_MEMORY);
        if (memory.calls <= fail_at) {
            assert_int_equal(result, FACET_OK);
            break;
        }
    }
    fixture_destroy(&f);
}

static void a_budget_is_kept(void **state)
{
    (void)state;
    fixture f = fixture_create();
    fixture_place(&f, fixture_add_sphere(&f, 512, SCENE_NONE), 0, 0, 0, 1.0f);
    static const uint64_t limits[] = {100000, 1000000, 16000000, 100000000, 0};
    for (int i = 0; i < 5; i++) {
        facet_budget *budget;
        assert_int_equal(facet_budget_create(limits[i], &budget, NULL), FACET_OK);
        f.desc.allocator = facet_budget_allocator(budget);
        film rendered = {0};
        facet_render_stats stats;
        facet_error error;
        facet_result result = fixture_try_render(&f, &rendered, &stats, &error);
        assert_int_equal(result, limits[i] && limits[i] < 50000000 ? FACET_ERROR_MEMORY : FACET_OK);
        film_destroy(&rendered);
        assert_int_equal(facet_budget_used_bytes(budget), 0);
        facet_budget_destroy(budget);
    }
    fixture_destroy(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_sphere_covers_its_disc),
        cmocka_unit_test(depth_is_along_the_axis),
        cmocka_unit_test(depth_of_a_sphere),
        cmocka_unit_test(clipping_planes_clip),
        cmocka_unit_test(images_show_what_the_camera_was_made_for),
        cmocka_unit_test(a_camera_that_looks_nowhere_is_an_error),
        cmocka_unit_test(backs_are_culled_unless_double_sided),
        cmocka_unit_test(normals_face_the_eye),
        cmocka_unit_test(coincident_backs_hide_nothing),
        cmocka_unit_test(points_and_lines_are_a_pixel_wide),
        cmocka_unit_test(images_do_not_depend_on_threads),
        cmocka_unit_test(large_meshes_do_not_depend_on_threads),
        cmocka_unit_test(a_crop_is_a_part_of_the_whole),
        cmocka_unit_test(progress_is_reported_in_order_and_cancels),
        cmocka_unit_test(a_time_limit_is_kept),
        cmocka_unit_test(running_out_of_memory_leaks_nothing),
        cmocka_unit_test(a_budget_is_kept),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
