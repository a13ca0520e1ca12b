/* fuzz_gltf.c - the glTF reader, and what is made of a scene before it is drawn, over any bytes. */
#include <stdint.h>
#include <stdlib.h>

#include "base/text.h"
#include "io/gltf.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static void ignore(void *user, facet_log_level level, const char *message)
{
    (void)user;
    (void)level;
    (void)message;
}

/* What a renderer asks of each primitive. Also reads every vertex that an index names. */
static void use_primitive(const scene_primitive *p, const facet_allocator *allocator)
{
    double sum = 0.0;
    for (uint32_t i = 0; i < p->index_count; i++) {
        size_t vertex = p->indices[i];
        sum += (double)p->positions[3 * vertex + 2];
        sum += p->normals ? (double)p->normals[3 * vertex + 2] : 0.0;
        sum += p->tangents ? (double)p->tangents[4 * vertex + 3] : 0.0;
        sum += p->colors ? (double)p->colors[4 * vertex + 3] : 0.0;
        for (uint32_t set = 0; set < p->texcoord_count; set++)
            sum += (double)p->texcoords[set][2 * vertex + 1];
    }
    if (!(sum < 1e30)) /* positions are finite and at most 1e18; normals and colors at most 1 */
        abort();
    if (p->mode != SCENE_TRIANGLES || p->texcoord_count == 0 || p->index_count == 0)
        return;
    float *tangents = mem_alloc(allocator, p->index_count, 4 * sizeof *tangents);
    if (tangents)
        scene_generate_tangents(p, p->texcoord_count - 1, allocator, tangents, NULL);
    mem_free(tangents);
}

static void use_scene(const facet_scene *scene, const facet_allocator *allocator)
{
    for (uint32_t i = 0; i < scene->mesh_count; i++)
        for (uint32_t k = 0; k < scene->meshes[i].primitive_count; k++)
            use_primitive(&scene->meshes[i].primitives[k], allocator);
    text t = {.allocator = *allocator};
    scene_describe_json(scene, &t);
    text_destroy(&t);
    const facet_orbit orbit = {.polar_rad = 1.3f, .radius_scale = 1.05f, .fov_y_rad = 0.5f};
    facet_camera camera;
    scene_fit_orbit(scene, NULL, &orbit, 1.5f, &camera, NULL);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    facet_budget *budget = NULL;
    if (facet_budget_create((uint64_t)64 << 20, &budget, NULL) != FACET_OK)
        return 0;
    facet_allocator allocator = facet_budget_allocator(budget);
    facet_scene_desc desc = {.allocator = allocator, .log = {.message = ignore}, .thread_count = 1};
    facet_scene *scene = NULL;
    facet_error error;
    if (gltf_load_memory(data, size, "fuzz", &desc, &scene, &error) == FACET_OK)
        use_scene(scene, &allocator);
    else if (scene || error.message[0] == 0)
        abort();
    scene_destroy(scene);
    if (facet_budget_used_bytes(budget) != 0)
        abort();
    facet_budget_destroy(budget);
    return 0;
}
