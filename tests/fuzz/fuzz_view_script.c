/* fuzz_view_script.c - scripts of the viewer. */
#include "fuzz_support.h"

#include "view/view_script.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    facet_budget *budget = fuzz_begin((uint64_t)64 << 20);
    facet_allocator allocator = facet_budget_allocator(budget);
    view_script script = {0};
    facet_error error = {0};
    facet_result result = view_script_parse((const char *)data, size, "fuzz", &allocator, &script, &error);
    fuzz_check_error(result, &error);
    view_script_destroy(&script);
    fuzz_end(budget);
    return 0;
}
