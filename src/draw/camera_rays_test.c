/* Tests of camera_rays.h, with sample_pattern(). */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#include "draw/camera_rays.h"

static void directions_have_unit_depth(void **state)
{
    (void)state;
    facet_camera camera = {.eye = {1, 2, 3}, .target = {4, -1, 0}, .fov_y_rad = 0.7f};
    camera_rays rays;
    assert_int_equal(camera_rays_create(&camera, 320, 200, &rays, NULL), FACET_OK);
    double forward = 1.0 / sqrt(27.0);
    for (int i = 0; i <= 10; i++) {
        float origin[3];
        float d[3];
        camera_rays_at(&rays, 32.0f * (float)i, 20.0f * (float)(10 - i), origin, d);
        double depth = (3.0 * (double)d[0] - 3.0 * (double)d[1] - 3.0 * (double)d[2]) * forward;
        assert_true(fabs(depth - 1.0) < 1e-6);
        assert_true(origin[0] == 1.0f && origin[1] == 2.0f && origin[2] == 3.0f);
    }
    /* The top edge is half the field of view above the axis. */
    float origin[3];
    float d[3];
    camera_rays_at(&rays, 160.0f, 0.0f, origin, d);
    double length2 = (double)(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
    assert_true(fabs(acos(1.0 / sqrt(length2)) - 0.35) < 1e-5);
    assert_true(d[1] > rays.direction[1]);
}

static void up_is_made_where_it_is_missing(void **state)
{
    (void)state;
    facet_camera down = {.eye = {0, 5, 0}, .fov_y_rad = 1.0f};
    camera_rays rays;
    assert_int_equal(camera_rays_create(&down, 10, 10, &rays, NULL), FACET_OK);
    assert_true(rays.direction[1] == -1.0f && rays.direction_dx[0] > 0.0f && rays.direction_dy[2] > 0.0f);
    down.up[1] = 1.0f;
    assert_int_equal(camera_rays_create(&down, 10, 10, &rays, NULL), FACET_ERROR_ARGUMENT);
    facet_camera flat = {.eye = {0, 0, 5}};
    assert_int_equal(camera_rays_create(&flat, 10, 10, &rays, NULL), FACET_ERROR_ARGUMENT);
}

/* Embree aborts the process for rays beyond 1.8e18. */
static void what_is_out_of_reach_is_refused(void **state)
{
    (void)state;
    const facet_camera cameras[] = {
        {.eye = {1e38f, 0, 0}, .fov_y_rad = 1.0f},
        {.eye = {NAN, 0, 0}, .fov_y_rad = 1.0f},
        {.eye = {0, 0, 5}, .ortho_height = 1e30f},
        {.eye = {0, 0, 5}, .fov_y_rad = 1.0f, .aspect = 1e30f},
    };
    camera_rays rays;
    for (size_t i = 0; i < sizeof cameras / sizeof *cameras; i++)
        assert_int_equal(camera_rays_create(&cameras[i], 10, 10, &rays, NULL), FACET_ERROR_ARGUMENT);
}

/* Each column and each row of the pixel holds one sample; none are close together. */
static void patterns_are_stratified(void **state)
{
    (void)state;
    static float points[2 * 4096];
    static unsigned char columns[4096];
    static unsigned char rows[4096];
    static const uint32_t counts[] = {1, 2, 3, 4, 5, 8, 9, 16, 25, 31, 64, 100, 257, 4096};
    for (size_t k = 0; k < sizeof counts / sizeof *counts; k++) {
        uint32_t n = counts[k];
        sample_pattern(n, points);
        for (uint32_t i = 0; i < n; i++)
            columns[i] = rows[i] = 0;
        for (uint32_t i = 0; i < n; i++) {
            columns[(uint32_t)(points[2 * i] * (float)n)]++;
            rows[(uint32_t)(points[2 * i + 1] * (float)n)]++;
        }
        double nearest = 1.0;
        for (uint32_t i = 0; i < n; i++) {
            assert_true(columns[i] == 1 && rows[i] == 1);
            for (uint32_t j = 0; n <= 257 && j < i; j++) {
                double dx = fabs((double)(points[2 * i] - points[2 * j]));
                double dy = fabs((double)(points[2 * i + 1] - points[2 * j + 1]));
                dx = dx > 0.5 ? 1.0 - dx : dx;
                dy = dy > 0.5 ? 1.0 - dy : dy;
                nearest = fmin(nearest, sqrt(dx * dx + dy * dy));
            }
        }
        /* The densest packing of n points has 1.07 / sqrt(n). */
        if (n > 4 && n <= 257)
            assert_true(nearest * sqrt((double)n) > 0.7);
    }
    sample_pattern(1, points);
    assert_true(points[0] == 0.5f && points[1] == 0.5f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(directions_have_unit_depth),
        cmocka_unit_test(up_is_made_where_it_is_missing),
        cmocka_unit_test(what_is_out_of_reach_is_refused),
        cmocka_unit_test(patterns_are_stratified),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
