/* fleet.c - two models in one scene, and the scene as .glb: fleet MODEL OTHER COPY */
#include <facet/facet.h>
#include <stdio.h>

int main(int argc, char **argv)
{
    const float aside[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 4, 0, 0, 1}; /* 4 m along x */
    facet_error error;
    facet_scene *scene = NULL, *boat = NULL;

    facet_result result = facet_scene_load(argc > 1 ? argv[1] : "model.obj", NULL, &scene, &error);
    if (result == FACET_OK)
        result = facet_scene_load(argc > 2 ? argv[2] : "model.obj", NULL, &boat, &error);
    if (result == FACET_OK) {
        result = facet_scene_append(scene, boat, &error);
        if (result == FACET_OK)
            boat = NULL; /* it belongs to scene */
    }
    if (result == FACET_OK)
        result = facet_scene_place_part(scene, 1, aside, &error);
    float low[3], high[3];
    if (result == FACET_OK && facet_scene_get_bounds(scene, NULL, low, high))
        printf("x from %g to %g m\n", (double)low[0], (double)high[0]);
    if (result == FACET_OK)
        result = facet_scene_save(scene, argc > 3 ? argv[3] : "fleet.glb", NULL, &error);
    if (result != FACET_OK)
        fprintf(stderr, "%s\n", error.message);

    facet_scene_destroy(boat);
    facet_scene_destroy(scene);
    return result == FACET_OK ? 0 : 1;
}
