/* codec_exr_none.c - what writes OpenEXR files and reads them as data, in builds without the library. */
#include "base/result.h"
#include "image/image.h"

static facet_result fail_without_openexr(const char *what, facet_error *error)
{
    return fail(error, FACET_ERROR_UNSUPPORTED,
                "this build of facet does not %s OpenEXR files this way: it has no OpenEXR library", what);
}

facet_result image_encode_exr(uint32_t width, uint32_t height, const image_layer *layers,
                              uint32_t layer_count, bool as_half, const image_encode_desc *desc,
                              unsigned char **bytes, size_t *size, facet_error *error)
{
    (void)width, (void)height, (void)layers, (void)layer_count, (void)as_half, (void)desc;
    *bytes = NULL;
    *size = 0;
    return fail_without_openexr("write", error);
}

facet_result image_read_exr_channels(const void *bytes, size_t size, const char *name,
                                     const facet_allocator *allocator, uint32_t width, uint32_t height,
                                     const image_channel *channels, uint32_t channel_count,
                                     facet_error *error)
{
    (void)bytes, (void)size, (void)name, (void)allocator, (void)width, (void)height;
    (void)channels, (void)channel_count;
    return fail_without_openexr("read", error);
}

facet_result image_read_exr_text(const void *bytes, size_t size, const char *name, const char *text_name,
                                 char *value, size_t value_size, facet_error *error)
{
    (void)bytes, (void)size, (void)name, (void)text_name, (void)value, (void)value_size;
    return fail_without_openexr("read", error);
}
