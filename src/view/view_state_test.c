/* view_state_test.c - view_state.h: how keys and the pointer change what is shown, without a window. */
#include "view/view_state.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <string.h>

#include <cmocka.h>

#include "scene/scene.h"

static facet_scene *scene;

static int make_scene(void **state)
{
    (void)state;
    return scene_create_builtin(&(facet_scene_desc){0}, &scene, NULL) == FACET_OK ? 0 : 1;
}

static int drop_scene(void **state)
{
    (void)state;
    scene_destroy(scene);
    return 0;
}

static void begin(view_state *s)
{
    static const float low[3] = {-1.0f, -1.0f, -1.0f};
    static const float high[3] = {1.0f, 1.0f, 1.0f};
    view_state_create(
        s, &(facet_view_desc){.render = {.renderer = FACET_RENDERER_KIND_GL, .width = 100, .height = 50},
                              .path_samples = 16});
    view_state_set_model(s, &(facet_view_model){.scene = scene, .orbit = scene_orbit_default()}, low, high,
                         false);
    s->orbit.radius = 5.0f;
    s->needs_framing = false;
    s->width = 100;
    s->height = 50;
}

static void press(view_state *s, const char *name)
{
    uint32_t key;
    unsigned modifiers;
    assert_true(view_key_parse(name, &key, &modifiers));
    const view_binding *b = view_binding_find(key, modifiers);
    assert_non_null(b);
    assert_true(view_state_apply(s, b->action, b->amount));
}

/* Keys that step wrap around, and reverse steps return to the start. */
static void keys_cycle_through_their_values(void **state)
{
    (void)state;
    view_state s;
    begin(&s);
    for (int i = 0; i < FACET_CHANNEL_COUNT; i++)
        press(&s, "n");
    assert_int_equal(s.render.gl.channel, FACET_CHANNEL_LIGHT);
    press(&s, "Shift+n");
    assert_int_equal(s.render.gl.channel, FACET_CHANNEL_FURNACE);
    press(&s, "0");
    assert_int_equal(s.render.gl.channel, FACET_CHANNEL_LIGHT);
    for (int i = 0; i < 8; i++)
        press(&s, "t");
    assert_int_equal(s.render.tonemap, FACET_TONEMAP_NONE);
    for (int i = 0; i < 3; i++)
        press(&s, "+");
    assert_true(fabsf(s.render.exposure_ev - 1.0f) < 1e-6f);
    for (int i = 0; i < 24; i++)
        press(&s, "Ctrl+Right");
    assert_true(fabsf(s.render.environment_rotation_rad) < 1e-4f);
    press(&s, "f");
    press(&s, "f");
    press(&s, "f");
    assert_int_equal(s.render.gl.brdf, FACET_BRDF_ENERGY);
}

/* Missing features of a model are reported, and change nothing. */
static void absent_things_are_reported(void **state)
{
    (void)state;
    static const char *const keys[] = {"v", "c", "w", "Space"};
    view_state s;
    begin(&s);
    for (size_t i = 0; i < sizeof keys / sizeof *keys; i++) {
        press(&s, keys[i]);
        assert_non_null(strstr(s.message, "The model has no"));
    }
    assert_false(s.is_playing);
    assert_false(s.pose.has_variant);
    assert_int_equal(s.camera, VIEW_NO_CAMERA);
}

/* Before a model is loaded, keys about it do nothing. */
static void keys_without_a_model_do_nothing(void **state)
{
    (void)state;
    view_state s;
    view_state_create(&s, &(facet_view_desc){.render = {.renderer = FACET_RENDERER_KIND_GL}});
    for (uint32_t i = 0; i < view_binding_count; i++)
        view_state_apply(&s, view_bindings[i].action, view_bindings[i].amount);
    assert_false(view_state_point(&s, &(view_event){.kind = VIEW_SCROLL, .y = 1.0}));
    view_state_point(&s, &(view_event){.kind = VIEW_PRESS});
    assert_false(view_state_point(&s, &(view_event){.kind = VIEW_MOVE, .x = 10.0}));
}

static void keys_without_effect_say_why(void **state)
{
    (void)state;
    view_state s;
    begin(&s);
    s.counts.lights = 0;
    s.counts.image_lights = 0;
    press(&s, "k");
    assert_non_null(strstr(s.message, "it has none"));
    press(&s, "s");
    assert_non_null(strstr(s.message, "there is no light"));
    s.render.sun.illuminance_lux[1] = 1.0f;
    press(&s, "s");
    assert_null(strstr(s.message, "there is no light"));
}

/* H shows one page after the other, as many as the window made, and then hides the help. */
static void help_has_pages(void **state)
{
    (void)state;
    view_state s;
    begin(&s);
    press(&s, "h");
    assert_int_equal(s.help_page, 1);
    s.help_pages = 3;
    press(&s, "h");
    press(&s, "h");
    assert_int_equal(s.help_page, 3);
    press(&s, "h");
    assert_int_equal(s.help_page, 0);
}

/* Whole labels, within the window, wherever the border is. */
static void labels_stay_within_the_window(void **state)
{
    (void)state;
    const int widths[2] = {150, 120};
    for (int border = 0; border <= 480; border++) {
        int x[2];
        bool is_narrow = view_divider_labels(border, 480, 12, widths, x);
        assert_true(x[0] >= 12 && x[0] + widths[0] <= 468 && x[1] >= 12 && x[1] + widths[1] <= 468);
        assert_true(is_narrow || x[0] + widths[0] < x[1]);
        assert_true(is_narrow == (border < 174 || border > 336));
    }
}

static void channels_and_path_tracing_exclude_each_other(void **state)
{
    (void)state;
    view_state s;
    begin(&s);
    press(&s, "r");
    assert_int_equal(s.render.renderer, FACET_RENDERER_KIND_PATH);
    press(&s, "n");
    assert_int_equal(s.render.renderer, FACET_RENDERER_KIND_GL);
    press(&s, "r");
    assert_int_equal(s.render.gl.channel, FACET_CHANNEL_LIGHT);
}

static void dragging_orbits_and_pans(void **state)
{
    (void)state;
    view_state s;
    begin(&s);
    float azimuth = s.orbit.azimuth_rad;
    assert_false(view_state_point(&s, &(view_event){.kind = VIEW_MOVE, .x = 10.0, .y = 10.0}));
    assert_true(s.orbit.azimuth_rad == azimuth);
    view_state_point(&s, &(view_event){.kind = VIEW_PRESS, .button = VIEW_LEFT_BUTTON, .x = 10.0, .y = 10.0});
    assert_true(view_state_point(&s, &(view_event){.kind = VIEW_MOVE, .x = 20.0, .y = 10.0}));
    assert_true(s.orbit.azimuth_rad < azimuth);
    view_state_point(&s,
                     &(view_event){.kind = VIEW_RELEASE, .button = VIEW_LEFT_BUTTON, .x = 20.0, .y = 10.0});
    azimuth = s.orbit.azimuth_rad;
    assert_false(view_state_point(&s, &(view_event){.kind = VIEW_MOVE, .x = 40.0, .y = 10.0}));
    assert_true(s.orbit.azimuth_rad == azimuth);
    float x = s.orbit.target[0];
    view_state_point(&s,
                     &(view_event){.kind = VIEW_PRESS, .button = VIEW_RIGHT_BUTTON, .x = 10.0, .y = 10.0});
    view_state_point(&s, &(view_event){.kind = VIEW_MOVE, .x = 20.0, .y = 10.0});
    assert_true(s.orbit.azimuth_rad == azimuth && s.orbit.target[0] != x);
}

static void the_divider_is_dragged_by_its_border(void **state)
{
    (void)state;
    view_state s;
    begin(&s);
    press(&s, "Tab");
    assert_int_equal(s.divider.comparison, VIEW_COMPARE_MASKING);
    facet_orbit orbit = s.orbit;
    view_state_point(&s, &(view_event){.kind = VIEW_PRESS, .x = 52.0, .y = 10.0});
    view_state_point(&s, &(view_event){.kind = VIEW_MOVE, .x = 80.0, .y = 10.0});
    assert_true(fabs(s.divider.position - 0.8) < 1e-9);
    assert_memory_equal(&orbit, &s.orbit, sizeof orbit);
    view_state_point(&s, &(view_event){.kind = VIEW_MOVE, .x = -500.0, .y = 10.0});
    assert_true(s.divider.position > 0.0);
    view_state_point(&s, &(view_event){.kind = VIEW_RELEASE, .x = 30.0, .y = 10.0});
    view_state_point(&s, &(view_event){.kind = VIEW_PRESS, .x = 50.0, .y = 10.0});
    view_state_point(&s, &(view_event){.kind = VIEW_MOVE, .x = 60.0, .y = 10.0});
    assert_true(orbit.azimuth_rad != s.orbit.azimuth_rad);
}

/* Keys for views use the distance that frames the model from there, whatever was before. */
static void views_show_the_whole_model(void **state)
{
    (void)state;
    static const char *const keys[] = {"1", "Ctrl+1", "3", "Ctrl+3", "7", "Ctrl+7", "9", "Enter"};
    for (size_t i = 0; i < sizeof keys / sizeof *keys; i++) {
        view_state s;
        facet_camera fitted;
        begin(&s);
        press(&s, keys[i]);
        assert_int_equal(view_state_frame(&s, 2.0f, NULL), FACET_OK);
        facet_orbit wanted = scene_orbit_default();
        wanted.azimuth_rad = s.orbit.azimuth_rad;
        wanted.polar_rad = s.orbit.polar_rad;
        assert_int_equal(scene_fit_orbit(scene, &s.pose, &wanted, 2.0f, &fitted, NULL), FACET_OK);
        double distance2 = 0.0;
        for (int k = 0; k < 3; k++)
            distance2 += pow((double)fitted.eye[k] - (double)fitted.target[k], 2.0);
        assert_true(fabs((double)s.orbit.radius - sqrt(distance2)) < 1e-5);
        view_state_point(&s, &(view_event){.kind = VIEW_SCROLL, .y = 1.0});
        float nearer = s.orbit.radius;
        view_state_follow_motion(&s); /* an orbit moved by hand stays */
        assert_int_equal(view_state_frame(&s, 2.0f, NULL), FACET_OK);
        assert_true(s.orbit.radius == nearer);
    }
}

/* The two sides differ in the compared setting, and in nothing else. */
static void sides_differ_in_the_compared_setting_only(void **state)
{
    (void)state;
    const facet_render_desc base = {.renderer = FACET_RENDERER_KIND_GL, .tonemap = FACET_TONEMAP_AGX};
    for (int i = 0; i < VIEW_COMPARISON_COUNT; i++) {
        facet_render_desc sides[2];
        const char *labels[2];
        view_divider_sides(&(view_divider){.comparison = (view_comparison)i}, &base, sides, labels);
        const bool differ[VIEW_COMPARISON_COUNT] = {
            false,
            sides[0].gl.brdf != sides[1].gl.brdf,
            sides[0].energy != sides[1].energy,
            sides[0].renderer != sides[1].renderer,
            sides[0].tonemap != sides[1].tonemap,
            sides[0].pose.has_variant != sides[1].pose.has_variant,
        };
        for (int k = 0; k < VIEW_COMPARISON_COUNT; k++)
            assert_int_equal(differ[k], k == i && i != VIEW_COMPARE_NOTHING);
        assert_true((labels[0][0] != 0) == (i != VIEW_COMPARE_NOTHING));
    }
}

/* A divider leaves path tracing on, and skips comparisons that only OpenGL has. */
static void comparisons_keep_path_tracing(void **state)
{
    (void)state;
    view_state s;
    begin(&s);
    press(&s, "r");
    assert_int_equal(s.render.renderer, FACET_RENDERER_KIND_PATH);
    for (int i = 0; i < 2 * VIEW_COMPARISON_COUNT; i++) {
        facet_render_desc sides[2];
        const char *labels[2];
        press(&s, i < VIEW_COMPARISON_COUNT ? "Tab" : "Shift+Tab");
        assert_int_not_equal(s.divider.comparison, VIEW_COMPARE_MASKING);
        view_divider_sides(&s.divider, &s.render, sides, labels);
        assert_int_equal(sides[1].renderer, FACET_RENDERER_KIND_PATH);
        bool is_both =
            s.divider.comparison != VIEW_COMPARE_NOTHING && s.divider.comparison != VIEW_COMPARE_RENDERER;
        assert_int_equal(view_state_accumulating_sides(&s), VIEW_SIDE_RIGHT | (is_both ? VIEW_SIDE_LEFT : 0));
        assert_int_equal(sides[0].renderer, s.divider.comparison == VIEW_COMPARE_RENDERER
                                                ? FACET_RENDERER_KIND_GL
                                                : FACET_RENDERER_KIND_PATH);
    }
    /* conversely: path tracing ends comparisons that only OpenGL has */
    press(&s, "0");
    press(&s, "r");
    press(&s, "Tab");
    assert_int_equal(s.divider.comparison, VIEW_COMPARE_MASKING);
    assert_int_equal(view_state_accumulating_sides(&s), 0);
    press(&s, "r");
    assert_int_equal(s.divider.comparison, VIEW_COMPARE_NOTHING);
}

/* ---- resolution while the camera moves ---- */

static void still_images_have_full_resolution(void **state)
{
    (void)state;
    assert_int_equal(view_pace_divisor(&(view_pace){.full_s = 100.0}, false), 1);
    assert_int_equal(view_pace_divisor(&(view_pace){.full_s = 0.0}, true), 1);
    assert_int_equal(view_pace_divisor(&(view_pace){.full_s = 0.04}, true), 1);
}

/* Draft frames are faster, but the motion goes on with them. */
static void slow_motions_have_draft_frames(void **state)
{
    (void)state;
    view_pace p = {.full_s = 0.0};
    assert_false(view_pace_drafts(&p, true));
    view_pace_measure(&p, 1, 0.017);
    assert_false(view_pace_drafts(&p, true));
    view_pace_measure(&p, 1, 0.03);
    assert_true(view_pace_drafts(&p, true));
    view_pace_measure(&p, 1, 0.015);
    assert_true(view_pace_drafts(&p, true));
    assert_false(view_pace_drafts(&p, false));
    assert_false(view_pace_drafts(&p, true));
}

static void slower_frames_are_coarser(void **state)
{
    (void)state;
    assert_int_equal(view_pace_divisor(&(view_pace){.full_s = 0.1}, true), 2);
    assert_int_equal(view_pace_divisor(&(view_pace){.full_s = 0.3}, true), 4);
}

/* After a first frame of a second, in which a driver compiled, one coarse frame shows how fast it is. */
static void one_coarse_frame_corrects_a_slow_first_frame(void **state)
{
    (void)state;
    view_pace p = {.full_s = 0.0};
    view_pace_measure(&p, 1, 1.0);
    assert_int_equal(view_pace_divisor(&p, true), 4);
    view_pace_measure(&p, 4, 0.001);
    assert_int_equal(view_pace_divisor(&p, true), 1);
    view_pace_measure(&p, 1, 0.02);
    view_pace_measure(&p, 1, 0.4); /* a change of the light, for example */
    assert_int_equal(view_pace_divisor(&p, true), 4);
    view_pace_measure(&p, 4, 0.05); /* limited by its vertices, not its pixels */
    assert_int_equal(view_pace_divisor(&p, true), 4);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(still_images_have_full_resolution),
                                       cmocka_unit_test(slow_motions_have_draft_frames),
                                       cmocka_unit_test(slower_frames_are_coarser),
                                       cmocka_unit_test(one_coarse_frame_corrects_a_slow_first_frame),
                                       cmocka_unit_test(keys_cycle_through_their_values),
                                       cmocka_unit_test(comparisons_keep_path_tracing),
                                       cmocka_unit_test(absent_things_are_reported),
                                       cmocka_unit_test(keys_without_a_model_do_nothing),
                                       cmocka_unit_test(keys_without_effect_say_why),
                                       cmocka_unit_test(help_has_pages),
                                       cmocka_unit_test(labels_stay_within_the_window),
                                       cmocka_unit_test(channels_and_path_tracing_exclude_each_other),
                                       cmocka_unit_test(dragging_orbits_and_pans),
                                       cmocka_unit_test(the_divider_is_dragged_by_its_border),
                                       cmocka_unit_test(views_show_the_whole_model),
                                       cmocka_unit_test(sides_differ_in_the_compared_setting_only)};
    return cmocka_run_group_tests(tests, make_scene, drop_scene);
}
