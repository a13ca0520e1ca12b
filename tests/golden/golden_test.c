/* golden_test.c - the built-in scene against reference images that were inspected: any change of an image,
 * intended or not, shows here. Linear floats, 64 x 48.
 *
 * An image may differ by 0.2 % of its own root mean square: far above the difference between compilers
 * (1e-5), far below the visible (FLIP, which is limited to 0.005 as well). To replace the references,
 * after inspection:
 *     facet render -s 64x48 --background transparent --energy gltf --tone-mapping none -o tests/golden/builtin_gltf.pfm
 *     facet render -s 64x48 --background env --orbit 40,60,105% --env-rotation 30 \
 *         --tone-mapping none -o tests/golden/builtin_conserving.pfm
 * A failing test leaves NAME.got.pfm and NAME.difference.png (reference, result, difference) in its working
 * folder; the same by hand: facet compare REFERENCE RESULT --max nrmse=0.002,flip=0.005 --alpha ignore. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

#include <cmocka.h>

#include "facet/facet.h"

enum { WIDTH = 64, HEIGHT = 48 };
static const char *folder; /* of the reference images */
static const double most_nrmse = 0.002, most_flip = 0.005;

/* Reference images are over black. */
static void check(const char *name, const facet_image *got)
{
    char path[1024];
    facet_error error;
    facet_image *wanted = NULL, *difference = NULL;
    facet_comparison c;
    const facet_compare_desc desc = {.alpha = FACET_COMPARE_ALPHA_IGNORE,
                                     .space = FACET_COMPARE_SPACE_LINEAR,
                                     .difference = FACET_DIFFERENCE_HEAT_MAP,
                                     .is_sheet = true};
    snprintf(path, sizeof path, "%s/%s.pfm", folder, name);
    if (facet_image_load(path, NULL, &wanted, &error) != FACET_OK ||
        facet_compare(wanted, got, &desc, &c, &difference, &error) != FACET_OK)
        fail_msg("%s", error.message);
    const bool is_good = c.invalid_count == 0 && c.nrmse <= most_nrmse && c.flip <= most_flip;
    if (!is_good) {
        snprintf(path, sizeof path, "%s.got.pfm", name);
        facet_image_save(got, path, NULL, NULL);
        snprintf(path, sizeof path, "%s.difference.png", name);
        facet_image_save(difference, path, NULL, NULL);
    }
    facet_image_destroy(wanted);
    facet_image_destroy(difference);
    if (!is_good)
        fail_msg("%s: differs by %.3g of its root mean square, FLIP %.3g, %llu pixels are not finite; at "
                 "most %g, %g "
                 "and 0 are allowed",
                 name, c.nrmse, c.flip, (unsigned long long)c.invalid_count, most_nrmse, most_flip);
    print_message("%s: differs by %.2g, FLIP %.2g\n", name, c.nrmse, c.flip);
}

static void compare(const char *name, const facet_render_desc *desc)
{
    facet_scene *scene;
    facet_environment *studio;
    facet_image *image;
    assert_int_equal(facet_scene_create_builtin(NULL, &scene, NULL), FACET_OK);
    assert_int_equal(facet_environment_create_studio(NULL, &studio, NULL), FACET_OK);
    facet_render_desc filled = *desc;
    filled.width = WIDTH;
    filled.height = HEIGHT;
    filled.environment = studio;
    facet_camera camera;
    facet_orbit orbit = facet_orbit_default();
    if (desc->energy == FACET_ENERGY_CONSERVING) {
        orbit.azimuth_rad = 40.0f * 0.0174532925f;
        orbit.polar_rad = 60.0f * 0.0174532925f;
    }
    assert_int_equal(facet_camera_from_orbit(scene, NULL, &orbit, (float)WIDTH / HEIGHT, &camera, NULL),
                     FACET_OK);
    filled.camera = &camera;
    assert_int_equal(facet_render(scene, &filled, &image, NULL), FACET_OK);

    check(name, image);
    facet_image_destroy(image);
    facet_environment_destroy(studio);
    facet_scene_destroy(scene);
}

static void the_builtin_scene_is_unchanged_in_gltf_mode(void **state)
{
    (void)state;
    compare("builtin_gltf", &(facet_render_desc){.energy = FACET_ENERGY_GLTF});
}

static void the_builtin_scene_is_unchanged_in_conserving_mode(void **state)
{
    (void)state;
    compare("builtin_conserving", &(facet_render_desc){.energy = FACET_ENERGY_CONSERVING,
                                                       .background = FACET_BACKGROUND_ENVIRONMENT,
                                                       .environment_rotation_rad = 30.0f * 0.0174532925f});
}

int main(int argc, char **argv)
{
    folder = argc > 1 ? argv[1] : "tests/golden";
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_builtin_scene_is_unchanged_in_gltf_mode),
        cmocka_unit_test(the_builtin_scene_is_unchanged_in_conserving_mode),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
