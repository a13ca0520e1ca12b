/* fuzz_obj.c - the OBJ reader over any bytes; the first byte chooses how normals are made and how many threads read. */
#include <math.h>
#include <stdint.h>
#include <stdlib.h>

#include "base/text.h"
#include "io/obj/obj.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static void ignore(void *user, facet_log_level level, const char *message)
{
    (void)user;
    (void)level;
    (void)message;
}

/* What scene_primitive promises. */
static void check_primitive(const facet_scene *scene, const scene_primitive *p)
{
    if (p->index_count == 0 || p->index_count % (p->mode == SCENE_TRIANGLES ? 3
                                                 : p->mode == SCENE_LINES   ? 2
                                                                            : 1))
        abort();
    if ((p->material != SCENE_NONE && p->material >= scene->material_count) ||
        (p->has_flat_normals && p->vertex_count != p->index_count) ||
        (p->normals != NULL) != (p->mode == SCENE_TRIANGLES))
        abort();
    for (size_t i = 0; i < p->index_count; i++) {
        size_t v = p->indices[i];
        if (v >= p->vertex_count)
            abort();
        for (size_t k = 0; k < 3; k++)
            if (!(p->positions[3 * v + k] >= p->bounds_min[k] &&
                  p->positions[3 * v + k] <= p->bounds_max[k]) ||
                !(fabsf(p->positions[3 * v + k]) <= SCENE_FARTHEST))
                abort();
        if (p->normals) {
            const float *n = p->normals + 3 * v;
            if (!(fabsf(n[0] * n[0] + n[1] * n[1] + n[2] * n[2] - 1.0f) < 1e-4f))
                abort();
        }
        for (size_t k = 0; p->texcoord_count && k < 2; k++)
            if (!(fabsf(p->texcoords[0][2 * v + k]) < 1e31f))
                abort();
        for (size_t k = 0; p->colors && k < 4; k++)
            if (!(p->colors[4 * v + k] >= 0.0f && p->colors[4 * v + k] <= 1.0f))
                abort();
    }
}

static void use_scene(const facet_scene *scene, const facet_allocator *allocator)
{
    if (!scene->legacy || scene->scene_count != 1 || scene->default_scene != 0)
        abort();
    for (uint32_t i = 0; i < scene->mesh_count; i++)
        for (uint32_t k = 0; k < scene->meshes[i].primitive_count; k++)
            check_primitive(scene, &scene->meshes[i].primitives[k]);
    text t = {.allocator = *allocator};
    scene_describe_json(scene, &t);
    text_destroy(&t);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    facet_budget *budget = NULL;
    if (size == 0 || facet_budget_create((uint64_t)64 << 20, &budget, NULL) != FACET_OK)
        return 0;
    facet_allocator allocator = facet_budget_allocator(budget);
    facet_scene_desc desc = {.allocator = allocator,
                             .log = {.message = ignore},
                             .thread_count = 1,
                             .obj_normals = (facet_obj_normals)(data[0] % 3),
                             .has_flipped_texcoords = data[0] & 4};
    facet_scene *scene = NULL;
    facet_error error = {0};
    obj_detect(data + 1, size - 1);
    if (obj_load_memory(data + 1, size - 1, "fuzz", &desc, &scene, &error) == FACET_OK)
        use_scene(scene, &allocator);
    else if (scene || error.message[0] == 0)
        abort();
    scene_destroy(scene);
    if (facet_budget_used_bytes(budget) != 0)
        abort();
    facet_budget_destroy(budget);
    return 0;
}
