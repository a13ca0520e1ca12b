/* fuzz_ktx2.c - every image of KTX2 files of arbitrary bytes, with little memory: no fault, no leak. */
#include <stdlib.h>

#include "image/ktx2.h"

enum { MAX_IMAGES = 24, MAX_EDGE = 256 };

int LLVMFuzzerTestOneInput(const unsigned char *bytes, size_t size);

static void decode_images(const ktx2 *k, const image_decode_desc *desc)
{
    uint32_t remaining = MAX_IMAGES;
    for (uint32_t level = 0; level < k->level_count; level++) {
        ktx2_data data;
        if (ktx2_load_level(k, level, &desc->allocator, &data, NULL) != FACET_OK)
            continue;
        for (uint32_t n = 0; n / k->face_count < k->layer_count && remaining > 0; n++, remaining--) {
            image i;
            ktx2_decode(k, &data, level, n / k->face_count, n % k->face_count, desc, &i, NULL);
            image_destroy(&i);
            image_decode_desc as_is = *desc;
            as_is.keeps_nonfinite = true;
            ktx2_decode(k, &data, level, n / k->face_count, n % k->face_count, &as_is, &i, NULL);
            image_destroy(&i);
        }
        ktx2_data_destroy(&data);
    }
}

int LLVMFuzzerTestOneInput(const unsigned char *bytes, size_t size)
{
    facet_budget *budget;
    ktx2 k;
    if (ktx2_open(bytes, size, "input", &k, NULL) != FACET_OK ||
        facet_budget_create(32u << 20, &budget, NULL) != FACET_OK)
        return 0;
    image_decode_desc desc = {
        .allocator = facet_budget_allocator(budget), .thread_count = 1, .max_size = MAX_EDGE};
    decode_images(&k, &desc);
    if (facet_budget_used_bytes(budget) != 0)
        abort();
    facet_budget_destroy(budget);
    return 0;
}
