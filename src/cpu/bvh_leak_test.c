/* bvh_leak_test.c - no ray leaves a closed surface, where it is aimed at edges and corners as anywhere else. Compiled with
 * fused multiply-adds, too (CMakeLists.txt): they break the symmetry by which both triangles at an edge compute the same
 * number for it, and shaders cannot forbid them. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "tests/support/support.h"
#include "cpu/bvh_fixture.h"

enum { EDGES = 900000, CORNERS = 100000 };

static float uniform(uint32_t *state)
{
    *state = *state * 747796405u + 2891336453u;
    uint32_t word = ((*state >> ((*state >> 28) + 4)) ^ *state) * 277803737u;
    return (float)(((word >> 22) ^ word) >> 8) * (1.0f / 16777216.0f);
}

static uint32_t count_leaks(const bvh_fixture *f, uint32_t rays, bool is_at_corners)
{
    const render_geometry *g = &f->set.items[0];
    const uint32_t triangles = g->primitive->index_count / 3;
    uint32_t state = 17, leaks = 0;
    for (uint32_t i = 0; i < rays; i++) {
        ray_segment ray = {.far_t = INFINITY};
        const uint32_t *corners =
            render_geometry_triangle(g, (uint32_t)(uniform(&state) * (float)triangles) % triangles);
        const uint32_t first = (uint32_t)(uniform(&state) * 3.0f) % 3;
        const float *a = g->vertices + 3 * (size_t)corners[first];
        const float *b = g->vertices + 3 * (size_t)corners[(first + 1) % 3];
        const float share = is_at_corners ? 0.0f : uniform(&state);
        for (int k = 0; k < 3; k++) {
            ray.origin[k] = 1.1f * (uniform(&state) - 0.5f); /* well inside */
            ray.direction[k] = a[k] + share * (b[k] - a[k]) - ray.origin[k];
        }
        visibility_hit hit;
        const bool has_hit = f->own.tracer->nearest(f->own.bvh, &ray, &hit);
        leaks += !has_hit || !f->own.tracer->occluded(f->own.bvh, &ray);
    }
    return leaks;
}

static void no_ray_leaves_a_sphere(void **state)
{
    (void)state;
    bvh_fixture f;
    bvh_fixture_create(&f, BVH_SPHERE, 2);
    assert_int_equal(count_leaks(&f, EDGES, false), 0);
    assert_int_equal(count_leaks(&f, CORNERS, true), 0);
    bvh_fixture_destroy(&f);
}

int main(void)
{
#if defined(__FMA__)
    if (!__builtin_cpu_supports("fma")) {
        print_message("skipped: this processor has no fused multiply-adds\n");
        return 77;
    }
#endif
    const struct CMUnitTest tests[] = {cmocka_unit_test(no_ray_leaves_a_sphere)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
