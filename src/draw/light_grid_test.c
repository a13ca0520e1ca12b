/* Tests of the grid of lights: all that reach a point are found, in order, and few others. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#include "base/memory.h"
#include "draw/light_grid.h"

#include "shade/shade.h"
#include "tests/support/support.h"

static uint32_t random_state = 1;
static float uniform_number(float low, float high)
{
    lcg_next(&random_state);
    return low + (high - low) * (float)(random_state >> 8) * 0x1p-24f;
}

static vec3 random_point(float extent)
{
    float x = uniform_number(-extent, extent);
    float y = uniform_number(-extent, extent);
    return vec3(x, y, uniform_number(-extent, extent));
}

static Light *make_lights(uint32_t count, float extent, float range, float share_without)
{
    Light *lights = mem_alloc(NULL, count, sizeof *lights);
    assert_non_null(lights);
    for (uint32_t i = 0; i < count; i++) {
        float own = uniform_number(0.1f, 1.0f) * range;
        if (uniform_number(0.0f, 1.0f) < share_without)
            own = 0.0f;
        lights[i] = light_point(random_point(extent), vec3(uniform_number(0.0f, 5.0f)), own);
        if (i % 7 == 3)
            lights[i] =
                light_spot(random_point(extent), vec3(0.0f, -1.0f, 0.0f), vec3(3.0f), own, 0.2f, 1.0f);
        if (i % 11 == 5 && share_without > 0.0f)
            lights[i] = light_directional(vec3(0.0f, -1.0f, 0.0f), vec3(0.1f));
    }
    return lights;
}

static vec3 shaded(const Light *light, vec3 P)
{
    Surface s = surface_from_metallic_roughness(vec3(0.0f, 1.0f, 0.0f), vec3(0.8f), 0.2f, 0.5f);
    return shade_punctual(s, P, normalize(vec3(0.3f, 1.0f, 0.2f)), *light, ENERGY_GLTF, vec2(0.0f));
}

/* The sum over the grid's lights equals that over all, to the last bit; returns the mean number of lights
 * visited. */
static double compare_with_loop(uint32_t count, float extent, float range, float share_without)
{
    enum { POINTS = 300 };
    Light *lights = make_lights(count, extent, range, share_without);
    light_grid grid;
    assert_int_equal(light_grid_create(lights, count, NULL, &grid, NULL), FACET_OK);
    double looked_at = 0.0;
    for (int k = 0; k < POINTS; k++) {
        vec3 P = random_point(extent * 1.2f);
        if (k % 5 == 0) /* just inside a range */
            P = lights[(uint32_t)k % count].position +
                vec3(0.0f, lights[(uint32_t)k % count].range * 0.999999f, 0.0f);
        vec3 all = vec3(0.0f);
        vec3 some = vec3(0.0f);
        for (uint32_t i = 0; i < count; i++)
            all += shaded(&lights[i], P);
        float point[3] = {P[0], P[1], P[2]};
        light_cursor cursor = light_grid_at(&grid, point);
        uint32_t last = 0;
        uint32_t found = 0;
        for (uint32_t i; light_cursor_next(&cursor, &i); found++) {
            assert_true(i < count && (found == 0 || i > last));
            last = i;
            some += shaded(&lights[i], P);
        }
        looked_at += (double)found / POINTS;
        for (int c = 0; c < 3; c++)
            assert_true(all[c] >= some[c] && all[c] <= some[c]);
    }
    light_grid_destroy(&grid);
    mem_free(lights);
    return looked_at;
}

static void culled_is_looped(void **state)
{
    (void)state;
    compare_with_loop(1, 1.0f, 1.0f, 0.0f);
    compare_with_loop(7, 10.0f, 3.0f, 0.5f);
    compare_with_loop(300, 10.0f, 1000.0f, 0.1f); /* all reach everywhere */
    compare_with_loop(300, 1e4f, 0.001f, 0.1f);   /* none reaches anything */
    compare_with_loop(300, 0.0f, 1.0f, 0.0f);     /* all in one place */
    compare_with_loop(1000, 10.0f, 2.0f, 1.0f);   /* none has a range */
}

static void ten_thousand_lights_cost_what_reaches(void **state)
{
    (void)state;
    double looked_at = compare_with_loop(10000, 50.0f, 5.0f, 0.0f);
    /* Of spheres of radius 0.5 to 5 in a cube of 100 m, 1.5 reach a point on average; their boxes are
     * twice as large. */
    assert_true(looked_at < 10.0);
}

static void ranges_without_end_are_none(void **state)
{
    (void)state;
    Light lights[3] = {light_point(vec3(1.0f), vec3(1.0f), INFINITY),
                       light_point(vec3(1e17f), vec3(1.0f), 3e38f),
                       light_point(vec3(-1e17f), vec3(1.0f), 1e17f)};
    light_grid grid;
    assert_int_equal(light_grid_create(lights, 3, NULL, &grid, NULL), FACET_OK);
    light_cursor cursor = light_grid_at(&grid, (float[3]){0.0f, 0.0f, 0.0f});
    uint32_t i = 9;
    assert_true(light_cursor_next(&cursor, &i) && i == 0);
    assert_true(light_cursor_next(&cursor, &i) && i == 1);
    cursor = light_grid_at(&grid, (float[3]){NAN, 0.0f, 0.0f});
    assert_true(light_cursor_next(&cursor, &i) && i == 0);
    light_grid_destroy(&grid);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(culled_is_looped),
        cmocka_unit_test(ten_thousand_lights_cost_what_reaches),
        cmocka_unit_test(ranges_without_end_are_none),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
