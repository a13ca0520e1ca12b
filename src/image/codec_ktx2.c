/* codec_ktx2.c - a KTX2 file as a picture: its first layer and face, at the level that was asked for. */
#include "image/codec.h"

#include "image/ktx2.h"

facet_result ktx2_probe(const unsigned char *bytes, size_t size, const char *name, image *header,
                        facet_error *error)
{
    ktx2 k;
    facet_result result = ktx2_open(bytes, size, name, &k, error);
    if (result == FACET_OK)
        *header = ktx2_header(&k);
    return result;
}

/* An edge reduced by 2^k as image_decode_desc has it, rounded up. */
static uint32_t get_reduced_edge(uint32_t edge, uint32_t k)
{
    return (uint32_t)(((uint64_t)edge + (UINT64_C(1) << k) - 1) >> k);
}

/* The smallest level that is the reduced picture: levels round down, which for odd edges is another size. */
static uint32_t choose_level(const ktx2 *k, uint32_t max_reduction)
{
    uint32_t level = 0;
    for (uint32_t i = 1; i <= max_reduction && i < k->level_count; i++)
        if (ktx2_level_edge(k->width, i) == get_reduced_edge(k->width, i) &&
            ktx2_level_edge(k->height, i) == get_reduced_edge(k->height, i))
            level = i;
    return level;
}

facet_result ktx2_decode_file(const unsigned char *bytes, size_t size, const char *name,
                              const image_decode_desc *desc, image *out, facet_error *error)
{
    ktx2 k;
    facet_result result = ktx2_open(bytes, size, name, &k, error);
    if (result == FACET_OK) /* of the whole picture, whatever is decoded of it */
        result = codec_check_size(name, k.width, k.height, desc->max_size, error);
    if (result == FACET_OK)
        result = ktx2_read(&k, choose_level(&k, desc->max_reduction), 0, 0, desc, out, error);
    return result;
}
