/* fuzz_part.c - parts of an image: what the file says, and merging it with itself. */
#include "fuzz_support.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    facet_budget *budget = fuzz_begin((uint64_t)64 << 20);
    const facet_merge_desc desc = {
        .allocator = facet_budget_allocator(budget), .log = {.message = fuzz_ignore}, .thread_count = 1};
    const char *path = fuzz_file(data, size);
    const char *const paths[] = {path, path};
    facet_part_info info;
    facet_error error = {0};
    facet_result result = facet_part_read_info(path, &info, &error);
    fuzz_check_error(result, &error);
    if (result == FACET_OK && (info.index >= info.count || !info.width || !info.height))
        abort();
    facet_image *image = NULL;
    result = facet_part_merge(paths, 2, &desc, &image, &error);
    fuzz_check_error(result, &error);
    if ((result == FACET_OK) != (image != NULL))
        abort();
    facet_image_destroy(image);
    fuzz_end(budget);
    return 0;
}
