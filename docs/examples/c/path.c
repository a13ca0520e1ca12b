/* path.c - path tracing with a time limit and a checkpoint, and a layer without a file: path MODEL */
#include <facet/facet.h>
#include <stdio.h>
#include <string.h>

static void print_depth(const facet_image *image)
{
    for (uint32_t i = 0; i < facet_image_get_layer_count(image); i++) {
        facet_image_view layer = facet_image_get_layer(image, i);
        const char *row = (const char *)layer.pixels + layer.height / 2 * layer.row_stride_bytes;
        if (strcmp(layer.name, "depth") == 0)
            printf("%.3f m in the middle\n", (double)((const float *)row)[layer.width / 2]);
    }
}

int main(int argc, char **argv)
{
    facet_error error;
    facet_scene *scene = NULL;
    facet_environment *studio = NULL;
    facet_image *image = NULL;

    facet_result result = facet_scene_load(argc > 1 ? argv[1] : "model.glb", NULL, &scene, &error);
    if (result == FACET_OK)
        result = facet_environment_create_studio(NULL, &studio, &error);
    if (result == FACET_OK) {
        facet_render_desc desc = {.width = 128,
                                  .height = 128,
                                  .environment = studio,
                                  .renderer = FACET_RENDERER_KIND_PATH,
                                  .ground = FACET_GROUND_SHADOW,
                                  .samples = 64,
                                  .time_limit_s = 30.0,
                                  .path = {.noise = 0.02f, .checkpoint_path = "state.exr", .resumes = true},
                                  .aovs = FACET_AOV_DEPTH};
        result = facet_render(scene, &desc, &image, &error);
    }
    if (result == FACET_OK) {
        facet_render_stats stats = facet_image_get_render_stats(image);
        printf("%.1f samples per pixel%s\n", (double)stats.samples / (128.0 * 128.0),
               stats.is_partial ? ", stopped at the time limit" : "");
        print_depth(image);
        result = facet_image_save(image, "path.exr", NULL, &error); /* with all layers */
    }
    if (result != FACET_OK)
        fprintf(stderr, "%s\n", error.message);

    facet_image_destroy(image);
    facet_environment_destroy(studio);
    facet_scene_destroy(scene);
    return result == FACET_OK ? 0 : 1;
}
