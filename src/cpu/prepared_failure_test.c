/* prepared_failure_test.c - prepared scenes after failures: cancelled images, wrong arguments, no memory. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "tests/support/support.h"
#include "base/memory.h"
#include "cpu/prepared_fixture.h"

static bool refuse(void *user, const char *stage, double fraction)
{
    (void)stage;
    (void)fraction;
    int *left = user;
    return (*left)-- > 0;
}

static void a_cancelled_image_can_be_drawn_again(void **state)
{
    (void)state;
    fixture f = prepared_still_scene();
    prepared_scene p;
    prepared_scene_init(&p, f.scene, NULL);
    for (int calls = 0; calls < 6; calls++) {
        prepared_orbit(&f, (float)calls, 5.0f);
        film rendered;
        facet_render_stats stats;
        facet_error error;
        int left = calls;
        f.desc.progress = (facet_progress){.user = &left, .report = refuse};
        assert_int_equal(prepared_try(&f, &p, &rendered, &stats, &error), FACET_ERROR_CANCELLED);
        film_destroy(&rendered);
        f.desc.progress = (facet_progress){0};
        f.desc.time_limit_s = 1e-9;
        assert_int_equal(prepared_try(&f, &p, &rendered, &stats, &error), FACET_ERROR_LIMIT);
        film_destroy(&rendered);
        f.desc.time_limit_s = 0.0;
        if (calls % 2)
            prepared_compare(&f, &p);
    }
    prepared_scene_clear(&p);
    fixture_destroy(&f);
}

static void wrong_arguments_keep_the_prepared_scene_valid(void **state)
{
    (void)state;
    fixture f = prepared_still_scene();
    prepared_scene p;
    prepared_scene_init(&p, f.scene, NULL);
    for (int i = 0; i < 4; i++) {
        film rendered;
        facet_render_stats stats;
        facet_error error;
        if (i)
            prepared_compare(&f, &p);
        f.desc.pose = (facet_pose_desc){.has_scene_index = true, .scene_index = 7};
        assert_int_equal(prepared_try(&f, &p, &rendered, &stats, &error), FACET_ERROR_ARGUMENT);
        film_destroy(&rendered);
        f.desc.pose = (facet_pose_desc){0};
        facet_camera camera = f.camera;
        memcpy(f.camera.eye, f.camera.target, sizeof f.camera.eye);
        assert_int_equal(prepared_try(&f, &p, &rendered, &stats, &error), FACET_ERROR_ARGUMENT);
        film_destroy(&rendered);
        f.camera = camera;
    }
    prepared_scene_clear(&p);
    fixture_destroy(&f);
}

/* Refuses each allocation of the second frame in turn. After releasing the kept data there is enough
 * memory. */
static void out_of_memory_it_starts_again(void **state)
{
    (void)state;
    fixture f = prepared_moving_scene();
    prepared_animate(&f, prepared_rotation_of(1));
    f.desc.width = f.desc.height = 24;
    f.desc.thread_count = 1;
    f.desc.pose.time_s = 1.0;
    film expected = fixture_render(&f);
    failing_allocator memory = {.fail_at = -1};
    facet_allocator allocator = failing_allocator_get(&memory);
    for (long at = 0;; at = next_failure(at)) {
        memory = (failing_allocator){.fail_at = -1};
        prepared_scene p;
        prepared_scene_init(&p, f.scene, &allocator);
        film rendered;
        facet_render_stats stats;
        facet_error error;
        f.desc.pose.time_s = 0.0;
        assert_int_equal(prepared_try(&f, &p, &rendered, &stats, &error), FACET_OK);
        film_destroy(&rendered);
        f.desc.pose.time_s = 1.0;
        memory.fail_at = atomic_load(&memory.calls) + at;
        assert_int_equal(prepared_try(&f, &p, &rendered, &stats, &error), FACET_OK);
        bool was_refused = atomic_load(&memory.calls) > memory.fail_at;
        fixture_assert_same(&rendered, &expected);
        film_destroy(&rendered);
        prepared_scene_clear(&p);
        assert_int_equal(memory.blocks, 0);
        if (!was_refused) {
            assert_true(at > 10);
            break;
        }
    }
    film_destroy(&expected);
    fixture_destroy(&f);
}

/* Every budget is respected: images fail or are correct, and a renderer that failed works with more
 * memory. */
static void memory_budgets_are_respected(void **state)
{
    (void)state;
    fixture f = prepared_moving_scene();
    prepared_animate(&f, prepared_rotation_of(1));
    bool has_failed = false;
    bool has_worked = false;
    for (uint64_t limit = 1 << 16; limit < 64 << 20; limit += limit / 2) {
        facet_budget *budget;
        assert_int_equal(facet_budget_create(limit, &budget, NULL), FACET_OK);
        facet_allocator allocator = facet_budget_allocator(budget);
        prepared_scene p;
        prepared_scene_init(&p, f.scene, &allocator);
        for (int i = 0; i < 3; i++) {
            film rendered = {0};
            facet_render_stats stats;
            facet_error error;
            f.desc.pose.time_s = 0.7 * i;
            facet_result result = prepared_try(&f, &p, &rendered, &stats, &error);
            assert_true(result == FACET_OK || result == FACET_ERROR_MEMORY);
            has_failed = has_failed || result != FACET_OK;
            has_worked = has_worked || result == FACET_OK;
            assert_true(result != FACET_ERROR_MEMORY || facet_budget_used_bytes(budget) == 0);
            film_destroy(&rendered);
        }
        prepared_scene_clear(&p);
        assert_int_equal(facet_budget_used_bytes(budget), 0);
        facet_budget_destroy(budget);
    }
    assert_true(has_failed && has_worked);
    fixture_destroy(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_cancelled_image_can_be_drawn_again),
        cmocka_unit_test(wrong_arguments_keep_the_prepared_scene_valid),
        cmocka_unit_test(out_of_memory_it_starts_again),
        cmocka_unit_test(memory_budgets_are_respected),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
