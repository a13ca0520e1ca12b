/* sea.c - the sea under a sky, metered as by a camera: sea IMAGE */
#include <facet/facet.h>
#include <stdio.h>

int main(int argc, char **argv)
{
    facet_error error;
    facet_sea_desc desc;
    facet_sea *sea = NULL;
    facet_image *image = NULL;

    facet_result result = facet_sea_preset("trade-wind", &desc, &error);
    if (result == FACET_OK)
        result = facet_sea_create(&desc, &sea, &error);
    if (result == FACET_OK) {
        const facet_camera camera = facet_sea_camera(sea, 4.0f, 0.6f); /* 4 m up, 34 degrees beside the sun */
        facet_sea_render_desc d = {
            .render = {.width = 320, .height = 180, .camera = &camera, .tonemap = FACET_TONEMAP_AGX},
            .sky = {.sun_elevation_rad = 0.4f}};
        double ev100 = 0.0;
        result = facet_sea_meter(sea, &d, &ev100, &error);
        d.render.exposure_ev = facet_exposure_from_ev100(ev100);
        if (result == FACET_OK)
            result = facet_sea_render(sea, NULL, &d, &image, &error);
    }
    if (result == FACET_OK)
        result = facet_image_save(image, argc > 1 ? argv[1] : "sea.png", NULL, &error);
    if (result != FACET_OK)
        fprintf(stderr, "%s\n", error.message);

    facet_image_destroy(image);
    facet_sea_destroy(sea);
    return result == FACET_OK ? 0 : 1;
}
