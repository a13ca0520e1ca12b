/* sea_model.c - a model afloat, path traced with the depth and the object IDs as layers: sea_model MODEL */
#include <facet/facet.h>
#include <stdio.h>

static facet_result draw(const facet_scene *scene, const facet_sea *sea, facet_image **image,
                         facet_error *error)
{
    const facet_camera camera = {
        .eye = {0.0f, 2.5f, -3.0f}, .target = {0.0f, 0.0f, 4.0f}, .fov_y_rad = 0.35f};
    facet_render_desc desc = {.width = 96,
                              .height = 64,
                              .sea = sea,
                              .sky = {.sun_elevation_rad = 0.4f, .sun_azimuth_rad = 0.6f},
                              .camera = &camera,
                              .renderer = FACET_RENDERER_KIND_PATH,
                              .samples = 16,
                              .aovs = FACET_AOV_DEPTH | FACET_AOV_OBJECT_ID};
    facet_renderer *renderer = NULL;
    double ev100 = 0.0;
    facet_result result = facet_renderer_create(scene, NULL, &renderer, error);
    if (result == FACET_OK)
        result = facet_renderer_meter(renderer, &desc, &ev100, error);
    desc.exposure_ev = facet_exposure_from_ev100(ev100); /* daylight in cd/m^2 */
    if (result == FACET_OK)
        result = facet_renderer_render(renderer, &desc, image, error);
    facet_renderer_destroy(renderer);
    return result;
}

int main(int argc, char **argv)
{
    facet_error error;
    facet_sea_desc desc;
    facet_sea *sea = NULL;
    facet_scene *scene = NULL;
    facet_image *image = NULL;

    facet_result result = facet_scene_load(argc > 1 ? argv[1] : "model.glb", NULL, &scene, &error);
    if (result == FACET_OK)
        result = facet_sea_preset("breeze", &desc, &error);
    if (result == FACET_OK)
        result = facet_sea_create(&desc, &sea, &error);
    if (result == FACET_OK) {
        const double place[2] = {0.0, 4.0}; /* along +X and +Z, m */
        facet_sea_point p;
        facet_sea_get_points(sea, place, 1, &p);
        const float matrix[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, (float)p.height_m, 4, 1};
        result = facet_scene_place(scene, matrix, &error);
    }
    if (result == FACET_OK)
        result = draw(scene, sea, &image, &error);
    if (result == FACET_OK)
        result = facet_image_save(image, "sea_model.exr", NULL, &error); /* with all layers */
    if (result != FACET_OK)
        fprintf(stderr, "%s\n", error.message);

    facet_image_destroy(image);
    facet_sea_destroy(sea);
    facet_scene_destroy(scene);
    return result == FACET_OK ? 0 : 1;
}
