/* render.c - a model as a PNG with a transparent background: render MODEL IMAGE
 * cc render.c $(pkg-config --cflags --libs facet) -o render */
#include <facet/facet.h>
#include <stdio.h>

int main(int argc, char **argv)
{
    const char *model = argc > 1 ? argv[1] : "model.glb", *path = argc > 2 ? argv[2] : "model.png";
    facet_error error;
    facet_scene *scene = NULL;
    facet_environment *studio = NULL;
    facet_image *image = NULL;

    facet_result result = facet_scene_load(model, NULL, &scene, &error);
    if (result == FACET_OK)
        result = facet_environment_create_studio(NULL, &studio, &error);
    if (result == FACET_OK) {
        const facet_render_desc desc = {
            .width = 512, .height = 512, .environment = studio, .tonemap = FACET_TONEMAP_NEUTRAL};
        result = facet_render(scene, &desc, &image, &error);
    }
    if (result == FACET_OK)
        result = facet_image_save(image, path, NULL, &error);
    if (result != FACET_OK)
        fprintf(stderr, "%s\n", error.message);

    facet_image_destroy(image);
    facet_environment_destroy(studio);
    facet_scene_destroy(scene);
    return result == FACET_OK ? 0 : 1;
}
