/* fuzz_image.c - all decoders on arbitrary bytes, with little memory: no fault, no leak, probe and decode
 * agree. */
#include <stdlib.h>

#include "image/image.h"

int LLVMFuzzerTestOneInput(const unsigned char *bytes, size_t size);

int LLVMFuzzerTestOneInput(const unsigned char *bytes, size_t size)
{
    facet_budget *budget;
    if (facet_budget_create(64u << 20, &budget, NULL) != FACET_OK)
        return 0;
    image header;
    image decoded;
    image_decode_desc desc = {.allocator = facet_budget_allocator(budget), .max_size = 1024};
    desc.max_reduction = (uint32_t)(size % 4);
    desc.channel_count = size % 3 ? (uint32_t)(size % 3 + 2) : 0;
    facet_result probed = image_probe(bytes, size, "input", &header, NULL, NULL);
    facet_result result = image_decode(bytes, size, "input", &desc, &decoded, NULL);
    if (result == FACET_OK && (probed != FACET_OK || decoded.type != header.type))
        abort();
    image_destroy(&decoded);
    if (facet_budget_used_bytes(budget) != 0)
        abort();
    facet_budget_destroy(budget);
    return 0;
}
