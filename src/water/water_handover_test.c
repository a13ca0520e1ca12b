/* water_handover_test.c - what is not seen as a wave any more goes on as roughness: from far away a sea of
 * waves looks, on average, as a plane with all of their slopes (Cox and Munk's). */
#include "water/water_fixture.h"

enum { WIDTH = 192, HEIGHT = 128, BLOCK = 64 };

/* The same sea without its waves: all of their slopes are hidden, whatever the footprint. */
static facet_sea plane_of(const facet_sea *sea)
{
    facet_sea plane = *sea;
    plane.waves.tile_count = 0;
    for (int i = 0; i < 64; i++)
        plane.slopes.residual[i] = sea->slopes.total;
    return plane;
}

static double block_mean(const shot *s, uint32_t left, uint32_t top)
{
    double sum = 0.0;
    for (uint32_t y = top; y < top + BLOCK; y++)
        for (uint32_t x = left; x < left + BLOCK; x++) {
            const float *p = shot_pixel(s, x, y);
            sum += 0.2126 * (double)p[0] + 0.7152 * (double)p[1] + 0.0722 * (double)p[2];
        }
    return sum / (BLOCK * BLOCK);
}

typedef struct view {
    float eye_m, down_rad, azimuth_rad, fov_rad;
} view;

static void compare_view(const facet_sea *sea, const view *v)
{
    facet_sea plane = plane_of(sea);
    shot rough, flat;
    make_shot(&rough, WIDTH, HEIGHT, v->eye_m, v->down_rad);
    rough.desc.samples = 4;
    rough.desc.sea_shading.omits_foam = true;
    rough.desc.sky.sun_azimuth_rad = v->azimuth_rad;
    rough.camera.fov_y_rad = v->fov_rad;
    flat = rough;
    draw_shot(sea, &rough);
    draw_shot(&plane, &flat);
    for (uint32_t y = 0; y + BLOCK <= HEIGHT; y += BLOCK)
        for (uint32_t x = 0; x + BLOCK <= WIDTH; x += BLOCK) {
            double a = block_mean(&rough, x, y), b = block_mean(&flat, x, y);
            if (fabs(a / b - 1.0) > 0.05)
                fail_msg("from %g m, block %u, %u: waves %g, a plane %g (%+.1f %%)", (double)v->eye_m, x, y,
                         a, b, 100.0 * (a / b - 1.0));
        }
    film_destroy(&rough.film);
    film_destroy(&flat.film);
}

static void unresolved_waves_keep_the_radiance_of_resolved_ones(void **state)
{
    (void)state;
    facet_sea_desc d = sea_default();
    d.fetch_m = 100000.0f;
    facet_sea *sea = make_sea(&d);
    static const view views[] = {{300.0f, 0.7f, 0.3f, 0.7f},
                                 {300.0f, 0.7f, 3.14159265f, 0.7f},
                                 {300.0f, 0.25f, 1.2f, 0.4f},
                                 {10e3f, 0.7f, 3.14159265f, 0.1f},
                                 {10e3f, 0.45f, 3.14159265f, 0.7f}};
    for (size_t i = 0; i < sizeof views / sizeof *views; i++)
        compare_view(sea, &views[i]);
    sea_destroy(sea);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(unresolved_waves_keep_the_radiance_of_resolved_ones)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
