/* fuzz_environment.c - images as environments in every layout, cube maps included: read, prepared, baked. The
 * first byte is the layout. */
#include "fuzz_support.h"

static void bake(facet_environment *environment, const facet_allocator *allocator)
{
    const facet_bake_desc desc = {
        .allocator = *allocator, .thread_count = 1, .size = 4, .level_count = 2, .samples = 4};
    facet_cube *cube = NULL;
    facet_error error = {0};
    facet_result result = facet_cube_bake(environment, &desc, &cube, &error);
    fuzz_check_error(result, &error);
    facet_cube_destroy(cube);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    facet_budget *budget = fuzz_begin((uint64_t)96 << 20);
    facet_allocator allocator = facet_budget_allocator(budget);
    uint8_t layout;
    fuzz_take(&data, &size, &layout, 1);
    const facet_environment_desc desc = {.allocator = allocator,
                                         .log = {.message = fuzz_ignore},
                                         .thread_count = 1,
                                         .max_size = 64,
                                         .layout = (facet_layout)(layout % (FACET_LAYOUT_OCTAHEDRAL + 1))};
    facet_environment *environment = NULL;
    facet_error error = {0};
    facet_result result = facet_environment_load_memory(data, size, "fuzz", &desc, &environment, &error);
    fuzz_check_error(result, &error);
    if (result == FACET_OK)
        bake(environment, &allocator);
    facet_environment_destroy(environment);
    fuzz_end(budget);
    return 0;
}
