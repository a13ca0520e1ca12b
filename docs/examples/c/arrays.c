/* A scene from arrays, without a file: arrays [IMAGE]. docs/c-api.md, "Scenes from arrays". */
#include <facet/facet.h>
#include <stdio.h>

int main(int argc, char **argv)
{
    facet_error error;
    facet_scene *scene = NULL;
    facet_environment *studio = NULL;
    facet_image *image = NULL;

    /* A tetrahedron: corners, and four triangles, counter-clockwise from outside. Without normals they are flat. */
    const float positions[] = {1, 1, 1, -1, -1, 1, -1, 1, -1, 1, -1, -1};
    const uint32_t indices[] = {0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3};
    facet_material gold = facet_material_default();
    gold.name = "gold";
    gold.base_color[1] = 0.77f;
    gold.base_color[2] = 0.34f;
    gold.perceptual_roughness = 0.3f;

    const facet_primitive_desc faces = {.vertex_count = 4,
                                        .positions = positions,
                                        .index_count = 12,
                                        .indices = indices,
                                        .has_material = true,
                                        .material = 0};
    const facet_mesh_desc mesh = {.name = "tetrahedron", .primitive_count = 1, .primitives = &faces};
    const facet_node_desc nodes[] = {
        {.name = "left", .translation = {-1.2, 0, 0}, .has_mesh = true},
        {.name = "right", .translation = {1.2, 0, 0}, .rotation = {0, 0.38f, 0, 0.92f}, .has_mesh = true}};
    const facet_arrays_desc arrays = {.material_count = 1,
                                      .materials = &gold,
                                      .mesh_count = 1,
                                      .meshes = &mesh,
                                      .node_count = 2,
                                      .nodes = nodes};

    facet_result result = facet_scene_create(&arrays, NULL, &scene, &error); /* copies everything */
    if (result == FACET_OK)
        result = facet_environment_create_studio(NULL, &studio, &error);
    if (result == FACET_OK) {
        const facet_render_desc desc = {
            .width = 256, .height = 160, .environment = studio, .tonemap = FACET_TONEMAP_NEUTRAL};
        result = facet_render(scene, &desc, &image, &error);
    }
    if (result == FACET_OK)
        result = facet_image_save(image, argc > 1 ? argv[1] : "arrays.png", NULL, &error);
    if (result != FACET_OK)
        fprintf(stderr, "%s\n", error.message);

    facet_image_destroy(image);
    facet_environment_destroy(studio);
    facet_scene_destroy(scene);
    return result == FACET_OK ? 0 : 1;
}
