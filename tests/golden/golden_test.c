/* golden_test.c - the built-in scene against pictures that were looked at and kept: whatever changes a picture, on
 * purpose or not, shows here. Linear floats, 64 x 48.
 *
 * A picture may be off by 0.2 % of its own root mean square: far above what compilers differ by (1e-5), far below what
 * an eye sees. To keep new pictures, after looking at them:
 *     facet render -s 64x48 --background transparent --tone-mapping none -o tests/golden/builtin_gltf.pfm
 *     facet render -s 64x48 --background env --energy conserving --orbit 40,60,105% --env-rotation 30 \
 *         --tone-mapping none -o tests/golden/builtin_conserving.pfm
 * A test that fails leaves NAME.got.pfm and NAME.difference.pfm in the folder that it runs in. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "facet/facet.h"

enum { WIDTH = 64, HEIGHT = 48, VALUES = WIDTH * HEIGHT * 3 };
static const char *folder; /* of the kept pictures */
static const double tolerance = 0.002;

/* Rows of a PFM file go up; these go down. */
static void read_pfm(const char *name, float *values)
{
    char path[1024];
    snprintf(path, sizeof path, "%s/%s.pfm", folder, name);
    FILE *file = fopen(path, "rb");
    if (!file)
        fail_msg("%s: cannot be opened", path);
    int width = 0, height = 0;
    double scale = 0.0;
    assert_int_equal(fscanf(file, "PF %d %d %lf", &width, &height, &scale), 3);
    assert_true(width == WIDTH && height == HEIGHT && scale < 0.0); /* little-endian */
    assert_int_equal(fgetc(file), '\n');
    for (int y = HEIGHT - 1; y >= 0; y--)
        assert_int_equal(fread(values + y * WIDTH * 3, sizeof *values, WIDTH * 3, file), WIDTH * 3);
    fclose(file);
}

static void write_pfm(const char *name, const char *what, const float *values)
{
    char path[1024];
    snprintf(path, sizeof path, "%s.%s.pfm", name, what);
    FILE *file = fopen(path, "wb");
    if (!file)
        return;
    fprintf(file, "PF\n%d %d\n-1.0\n", WIDTH, HEIGHT);
    for (int y = HEIGHT - 1; y >= 0; y--)
        fwrite(values + y * WIDTH * 3, sizeof *values, WIDTH * 3, file);
    fclose(file);
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

    static float wanted[VALUES], got[VALUES], difference[VALUES];
    read_pfm(name, wanted);
    const float *pixels = facet_image_get_layer(image, 0).pixels;
    double squares = 0.0, error = 0.0;
    for (int i = 0; i < VALUES; i++) {
        got[i] = pixels[i / 3 * 4 + i % 3];
        difference[i] = fabsf(got[i] - wanted[i]);
        squares += (double)wanted[i] * (double)wanted[i];
        error += (double)difference[i] * (double)difference[i];
    }
    double relative = sqrt(error / squares);
    facet_image_destroy(image);
    facet_environment_destroy(studio);
    facet_scene_destroy(scene);
    if (!(relative <= tolerance)) {
        write_pfm(name, "got", got);
        write_pfm(name, "difference", difference);
        fail_msg("%s: differs by %.3g of its root mean square; at most %g is allowed", name, relative,
                 tolerance);
    }
    print_message("%s: differs by %.2g\n", name, relative);
}

static void in_the_mode_of_gltf(void **state)
{
    (void)state;
    compare("builtin_gltf", &(facet_render_desc){0});
}

static void in_the_conserving_mode_before_its_environment(void **state)
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
        cmocka_unit_test(in_the_mode_of_gltf),
        cmocka_unit_test(in_the_conserving_mode_before_its_environment),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
