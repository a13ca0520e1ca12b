/* fuzz_checkpoint.c - checkpoints of the path tracer, read into a film of 4 x 4 pixels. */
#include "fuzz_support.h"

#include "path/path_checkpoint.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static const char key[] = "0123456789abcdef0123456789abcdef0123456789abcdef0123456789abcdef";
    facet_budget *budget = fuzz_begin((uint64_t)64 << 20);
    facet_allocator allocator = facet_budget_allocator(budget);
    path_film *f = NULL;
    if (path_film_create(&allocator, 4, 4, true, &f, NULL) != FACET_OK)
        abort();
    facet_error error = {0};
    bool exists = false;
    facet_result result = path_film_load(f, key, fuzz_file(data, size), &exists, &error);
    fuzz_check_error(result, &error);
    for (size_t i = 0; i < 16; i++)
        if (path_film_samples(f, i) > 1u << 24)
            abort();
    path_film_destroy(f);
    fuzz_end(budget);
    return 0;
}
