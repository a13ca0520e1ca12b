/* bake_ktx2.c - cube maps and tables as KTX2 files. */
#include "bake/bake.h"

#include "base/result.h"

facet_result facet_cube_encode_ktx2(const facet_cube *c, const facet_ktx2_desc *desc, unsigned char **bytes,
                                    size_t *size, facet_error *error)
{
    (void)c, (void)desc, (void)bytes, (void)size;
    return fail(error, FACET_ERROR_UNSUPPORTED, "bake: not there yet");
}

facet_result bake_image_ktx2(const image *picture, const facet_ktx2_desc *desc, unsigned char **bytes,
                             size_t *size, facet_error *error)
{
    (void)picture, (void)desc, (void)bytes, (void)size;
    return fail(error, FACET_ERROR_UNSUPPORTED, "bake: not there yet");
}
