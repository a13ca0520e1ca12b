/* inspect.c - what a model holds, and a copy of it as .glb: inspect MODEL COPY */
#include <facet/facet.h>
#include <stdio.h>

int main(int argc, char **argv)
{
    facet_error error;
    facet_scene *scene = NULL;
    char *json = NULL;

    facet_result result = facet_scene_load(argc > 1 ? argv[1] : "model.obj", NULL, &scene, &error);
    if (result == FACET_OK) {
        facet_scene_counts counts = facet_scene_get_counts(scene);
        float low[3], high[3];
        double origin[3];
        facet_scene_get_origin(scene, origin);
        printf("%u materials, %u animations, %llu triangles\n", counts.materials, counts.animations,
               (unsigned long long)counts.drawn_triangles);
        if (facet_scene_get_bounds(scene, NULL, low, high)) /* in coordinates of the file: */
            printf("x from %g to %g m\n", origin[0] + (double)low[0], origin[0] + (double)high[0]);
        result = facet_scene_describe_json(scene, &json, &error);
    }
    if (result == FACET_OK) {
        puts(json);
        result = facet_scene_save(scene, argc > 2 ? argv[2] : "model.glb", NULL, &error);
    }
    if (result != FACET_OK)
        fprintf(stderr, "%s\n", error.message);

    facet_text_destroy(json);
    facet_scene_destroy(scene);
    return result == FACET_OK ? 0 : 1;
}
