/* fuzz_ogl1_json.c - the reader of rgl's parameters on arbitrary bytes; the result is written and read
 * again. */
#include "fuzz_support.h"

#include <math.h>
#include <string.h>

#include "io/ogl1/ogl1_json.h"

static void check_values(const float *values, size_t count, float minimum, float maximum)
{
    for (size_t i = 0; i < count; i++)
        if (!(values[i] >= minimum && values[i] <= maximum))
            abort();
}

/* Invariants of scene/legacy.h. */
static void check_legacy(const facet_scene *scene)
{
    const scene_legacy *legacy = scene->legacy;
    for (uint32_t i = 0; i < scene->material_count; i++) {
        const legacy_material *m = &legacy->materials[i];
        check_values(m->ambient, 3, 0.0f, 1e6f);
        check_values(m->diffuse, 3, 0.0f, 1e6f);
        check_values(m->specular, 3, 0.0f, 1e6f);
        check_values(m->emission, 3, 0.0f, 1e6f);
        check_values(&m->shininess, 1, 0.0f, 1e6f);
        check_values(&m->opacity, 1, 0.0f, 1.0f);
        if (!m->name || m->name[0] == 0 || (m->unknown && m->unknown[0] == 0))
            abort();
    }
    for (uint32_t i = 0; i < legacy->light_count; i++) {
        const legacy_light *l = &legacy->lights[i];
        const float *p = l->position;
        double length =
            sqrt((double)p[0] * (double)p[0] + (double)p[1] * (double)p[1] + (double)p[2] * (double)p[2]);
        check_values(p, 3, -SCENE_FARTHEST, SCENE_FARTHEST);
        if (!l->is_point && !(fabs(length - 1.0) < 1e-5))
            abort();
    }
    check_values(&legacy->fog.scale, 1, 1e-7f, 1e6f);
}

static text print(const facet_scene *scene, const facet_allocator *allocator)
{
    text t = {.allocator = *allocator};
    ogl1_json_write(scene, "fuzz", NULL, &t);
    return t;
}

static void use_scene(const facet_scene *scene, const facet_scene_desc *desc)
{
    check_legacy(scene);
    text first = print(scene, &desc->allocator);
    facet_scene *back = NULL;
    facet_error error;
    if (!first.has_failed) {
        facet_result result = ogl1_json_load_memory(first.data, first.length, "back", desc, &back, &error);
        if (result != FACET_OK && result != FACET_ERROR_MEMORY)
            abort();
    }
    if (back) {
        text second = print(back, &desc->allocator);
        if (!second.has_failed && strcmp(first.data, second.data) != 0)
            abort();
        text_destroy(&second);
    }
    text_destroy(&first);
    scene_destroy(back);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    facet_budget *budget = fuzz_begin((uint64_t)64 << 20);
    facet_scene_desc desc = {
        .allocator = facet_budget_allocator(budget), .log = {.message = fuzz_ignore}, .thread_count = 1};
    facet_scene *scene = NULL;
    facet_error error = {0};
    ogl1_json_detect(data, size);
    if (ogl1_json_load_memory(data, size, "fuzz", &desc, &scene, &error) == FACET_OK)
        use_scene(scene, &desc);
    else if (scene || error.message[0] == 0)
        abort();
    scene_destroy(scene);
    fuzz_end(budget);
    return 0;
}
