/* frames.c - the first animation of a model as 8 PNG files: frames MODEL */
#include <facet/facet.h>
#include <stdio.h>

static facet_result draw_frames(const facet_scene *scene, facet_environment *studio, facet_renderer *renderer,
                                facet_error *error)
{
    const uint32_t first = 0;
    const facet_animation animation = facet_scene_get_animation(scene, first);
    facet_render_desc desc = {.width = 128,
                              .height = 128,
                              .environment = studio,
                              .tonemap = FACET_TONEMAP_NEUTRAL,
                              .pose = {.animation_count = 1, .animations = &first}};
    double ev100;
    facet_result result = facet_renderer_meter(renderer, &desc, &ev100, error);
    desc.exposure_ev = facet_exposure_from_ev100(ev100); /* one for all frames */
    for (int frame = 0; frame < 8 && result == FACET_OK; frame++) {
        facet_image *image = NULL;
        char path[32];
        snprintf(path, sizeof path, "frame%d.png", frame);
        desc.pose.time_s = animation.begin_s + (animation.end_s - animation.begin_s) * frame / 8.0;
        result = facet_renderer_render(renderer, &desc, &image, error);
        if (result == FACET_OK)
            result = facet_image_save(image, path, NULL, error);
        facet_image_destroy(image);
    }
    return result;
}

int main(int argc, char **argv)
{
    facet_error error;
    facet_scene *scene = NULL;
    facet_environment *studio = NULL;
    facet_renderer *renderer = NULL;

    facet_result result = facet_scene_load(argc > 1 ? argv[1] : "model.glb", NULL, &scene, &error);
    if (result == FACET_OK)
        result = facet_environment_create_studio(NULL, &studio, &error);
    if (result == FACET_OK)
        result = facet_renderer_create(scene, NULL, &renderer, &error);
    if (result == FACET_OK)
        result = draw_frames(scene, studio, renderer, &error);
    if (result != FACET_OK)
        fprintf(stderr, "%s\n", error.message);

    facet_renderer_destroy(renderer);
    facet_environment_destroy(studio);
    facet_scene_destroy(scene);
    return result == FACET_OK ? 0 : 1;
}
