/* fuzz_gltf.c - the glTF reader, and the preparation of a scene for rendering, on arbitrary bytes. */
#include "fuzz_support.h"

#include <math.h>

#include "base/text.h"
#include "io/gltf/gltf.h"

/* Invariants of the joints and morph targets of scene_primitive. */
static void use_deformation(const scene_primitive *p)
{
    for (size_t vertex = 0; p->influence_count && vertex < p->vertex_count; vertex++) {
        double sum = 0.0;
        for (size_t i = vertex * p->influence_count; i < (vertex + 1) * p->influence_count; i++) {
            if (!(p->weights[i] >= 0.0f) || (p->weights[i] == 0.0f && p->joints[i] != 0))
                abort();
            sum += (double)p->weights[i];
        }
        if (!(fabs(sum - 1.0) < 0.001))
            abort();
    }
    for (uint32_t i = 0; i < p->target_count; i++) {
        const float *const arrays[3] = {p->targets[i].positions, p->targets[i].normals,
                                        p->targets[i].tangents};
        for (int k = 0; k < 3; k++)
            for (size_t j = 0; arrays[k] && j < 3 * (size_t)p->vertex_count; j++)
                if (!(fabsf(arrays[k][j]) <= SCENE_FARTHEST))
                    abort();
    }
}

/* Queries of each primitive by a renderer. Also reads every indexed vertex. */
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
    use_deformation(p);
    if (p->mode != SCENE_TRIANGLES || p->texcoord_count == 0 || p->index_count == 0)
        return;
    float *tangents = mem_alloc(allocator, p->index_count, 4 * sizeof *tangents);
    if (tangents)
        scene_generate_tangents(p, p->texcoord_count - 1, allocator, tangents, NULL);
    mem_free(tangents);
}

/* Invariants of scene_animation, and the pose in the middle of it. */
static void use_animation(const facet_scene *scene, uint32_t number, const facet_allocator *allocator)
{
    const scene_animation *a = &scene->animations[number];
    for (uint32_t i = 0; i < a->channel_count; i++)
        if (a->channels[i].sampler >= a->sampler_count)
            abort();
    for (uint32_t i = 0; i < a->sampler_count; i++) {
        const scene_sampler *s = &a->samplers[i];
        size_t count = (size_t)s->key_count * s->width * (s->interpolation == SCENE_CUBIC_SPLINE ? 3 : 1);
        for (size_t k = 0; k < count; k++)
            if (!isfinite(s->values[k]))
                abort();
        for (size_t k = 0; k < s->key_count; k++)
            if (!isfinite(s->times[k]) || (k > 0 && !(s->times[k] > s->times[k - 1])))
                abort();
    }
    const facet_pose_desc desc = {
        .animation_count = 1, .animations = &number, .time_s = 0.5 * ((double)a->begin_s + (double)a->end_s)};
    scene_pose pose = {0};
    if (scene_pose_create(scene, &desc, allocator, 1, &pose, NULL) == FACET_OK)
        scene_pose_destroy(&pose);
}

static void use_scene(const facet_scene *scene, const facet_allocator *allocator)
{
    for (uint32_t i = 0; i < scene->animation_count && i < 4; i++)
        use_animation(scene, i, allocator);
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
    facet_budget *budget = fuzz_begin((uint64_t)64 << 20);
    facet_allocator allocator = facet_budget_allocator(budget);
    facet_scene_desc desc = {.allocator = allocator, .log = {.message = fuzz_ignore}, .thread_count = 1};
    facet_scene *scene = NULL;
    facet_error error;
    if (gltf_load_memory(data, size, "fuzz", &desc, &scene, &error) == FACET_OK)
        use_scene(scene, &allocator);
    else if (scene || error.message[0] == 0)
        abort();
    scene_destroy(scene);
    fuzz_end(budget);
    return 0;
}
