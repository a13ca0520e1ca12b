/* sky.c - a sky with its sun as an environment, and what it holds: sky IMAGE */
#include <facet/facet.h>
#include <stdio.h>

int main(int argc, char **argv)
{
    facet_error error;
    facet_scene *spheres = NULL;
    facet_environment *sky = NULL;
    facet_image *image = NULL;
    facet_environment_info info;
    const facet_sky_desc desc = {.sun_elevation_rad = 0.6f,
                                 .sun_azimuth_rad = 0.8f,
                                 .ground_albedo = {0.2f, 0.2f, 0.2f},
                                 .illuminance_lux = 3.14159f}; /* white has 1 cd/m^2 */

    facet_result result = facet_environment_create_sky(&desc, NULL, &sky, &error);
    if (result == FACET_OK)
        result = facet_environment_get_info(sky, &info, &error);
    if (result == FACET_OK) {
        printf("mean radiance %.3f %.3f %.3f cd/m^2\n", info.mean[0], info.mean[1], info.mean[2]);
        result = facet_scene_create_builtin(NULL, &spheres, &error);
    }
    if (result == FACET_OK) {
        const facet_render_desc render = {.width = 320,
                                          .height = 240,
                                          .environment = sky,
                                          .background = FACET_BACKGROUND_ENVIRONMENT,
                                          .tonemap = FACET_TONEMAP_AGX};
        result = facet_render(spheres, &render, &image, &error);
    }
    if (result == FACET_OK)
        result = facet_image_save(image, argc > 1 ? argv[1] : "sky.png", NULL, &error);
    if (result != FACET_OK)
        fprintf(stderr, "%s\n", error.message);

    facet_image_destroy(image);
    facet_environment_destroy(sky);
    facet_scene_destroy(spheres);
    return result == FACET_OK ? 0 : 1;
}
