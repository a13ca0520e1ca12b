/* turntable.c - a model from eight sides on one sheet: turntable MODEL SHEET */
#include <facet/facet.h>
#include <stdio.h>

enum { VIEW_COUNT = 8 };

static facet_result draw_views(const facet_scene *scene, facet_environment *studio,
                               facet_image *views[VIEW_COUNT], facet_error *error)
{
    facet_renderer *renderer = NULL;
    facet_result result = facet_renderer_create(scene, NULL, &renderer, error);
    facet_orbit orbit = facet_orbit_default();
    orbit.fits_all_azimuths = true; /* the model keeps its size */
    for (int i = 0; i < VIEW_COUNT && result == FACET_OK; i++) {
        facet_camera camera;
        facet_render_desc desc = {.width = 128,
                                  .height = 128,
                                  .camera = &camera,
                                  .environment = studio,
                                  .tonemap = FACET_TONEMAP_NEUTRAL};
        orbit.azimuth_rad = 6.2831853f * (float)i / VIEW_COUNT;
        result = facet_camera_from_orbit(scene, NULL, &orbit, 1.0f, &camera, error);
        if (result == FACET_OK)
            result = facet_renderer_render(renderer, &desc, &views[i], error);
    }
    facet_renderer_destroy(renderer);
    return result;
}

int main(int argc, char **argv)
{
    facet_error error;
    facet_scene *scene = NULL;
    facet_environment *studio = NULL;
    facet_image *views[VIEW_COUNT] = {NULL}, *sheet = NULL;

    facet_result result = facet_scene_load(argc > 1 ? argv[1] : "model.glb", NULL, &scene, &error);
    if (result == FACET_OK)
        result = facet_environment_create_studio(NULL, &studio, &error);
    if (result == FACET_OK)
        result = draw_views(scene, studio, views, &error);
    if (result == FACET_OK)
        result =
            facet_image_create_sheet((const facet_image *const *)views, VIEW_COUNT, NULL, &sheet, &error);
    if (result == FACET_OK)
        result = facet_image_save(sheet, argc > 2 ? argv[2] : "turntable.png", NULL, &error);
    if (result != FACET_OK)
        fprintf(stderr, "%s\n", error.message);

    facet_image_destroy(sheet);
    for (int i = 0; i < VIEW_COUNT; i++)
        facet_image_destroy(views[i]);
    facet_environment_destroy(studio);
    facet_scene_destroy(scene);
    return result == FACET_OK ? 0 : 1;
}
