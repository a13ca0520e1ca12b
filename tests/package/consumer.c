/* consumer.c - an external program: renders the built-in scene with the installed library.
 *     consumer [FILE [gl]]    gl: with OpenGL; exit code 77: there is none */
#include <facet/facet.h>

#include <stdio.h>
#include <string.h>

int main(int argc, char **argv)
{
    facet_error error;
    facet_scene *scene = NULL;
    facet_environment *studio = NULL;
    facet_image *image = NULL;
    facet_result result = facet_scene_create_builtin(NULL, &scene, &error);
    if (result == FACET_OK)
        result = facet_environment_create_studio(NULL, &studio, &error);
    if (result == FACET_OK) {
        facet_render_desc desc = {
            .width = 64, .height = 48, .environment = studio, .tonemap = FACET_TONEMAP_NEUTRAL};
        if (argc > 2 && strcmp(argv[2], "gl") == 0)
            desc.renderer = FACET_RENDERER_KIND_GL;
        result = facet_render(scene, &desc, &image, &error);
    }
    if (result == FACET_OK)
        result = facet_image_save(image, argc > 1 ? argv[1] : "consumer.png", NULL, &error);
    if (result != FACET_OK)
        fprintf(stderr, "%s\n", error.message);
    facet_image_destroy(image);
    facet_environment_destroy(studio);
    facet_scene_destroy(scene);
    return result == FACET_OK ? 0 : result == FACET_ERROR_SYSTEM ? 77 : 1;
}
