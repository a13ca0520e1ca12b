/* fuzz_parameters.c - rgl's parameters in JSON that replace the materials of a model (--parameters). */
#include "fuzz_support.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static const char model[] =
        "v 0 0 0\nv 1 0 0\nv 0 1 0\no first\nf 1 2 3\no second\nusemtl red\nf 3 2 1\n";
    facet_budget *budget = fuzz_begin((uint64_t)64 << 20);
    const facet_scene_desc desc = {.allocator = facet_budget_allocator(budget),
                                   .log = {.message = fuzz_ignore},
                                   .thread_count = 1,
                                   .parameters = fuzz_file(data, size)};
    facet_scene *scene = NULL;
    facet_error error = {0};
    facet_result result = facet_scene_load_memory(model, sizeof model - 1, "fuzz.obj", &desc, &scene, &error);
    fuzz_check_error(result, &error);
    char *text = NULL;
    if (result == FACET_OK)
        fuzz_check_error(facet_scene_describe_json(scene, &text, &error), &error);
    facet_text_destroy(text);
    facet_scene_destroy(scene);
    fuzz_end(budget);
    return 0;
}
