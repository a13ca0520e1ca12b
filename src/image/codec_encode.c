/* codec_encode.c - calls the encoder of an image format. */
#include "base/result.h"
#include "image/codec.h"

static facet_result resolve(const image_encode_desc *desc, image_codec codec_id, image_encode_desc *resolved,
                            facet_error *error)
{
    image_encode_desc d = desc ? *desc : (image_encode_desc){0};
    if (d.thread_count == 0)
        d.thread_count = 1;
    if (d.quality == 0)
        d.quality = 92;
    if (d.compression == 0)
        d.compression = 4;
    if (d.quality > 100 || d.compression > 9)
        return fail(error, FACET_ERROR_ARGUMENT,
                    "%s: quality %u is not 1 to 100 or compression %u not 1 to 9", image_codec_name(codec_id),
                    d.quality, d.compression);
    *resolved = d;
    return FACET_OK;
}

facet_result image_encode_png(const image *i, const image_encode_desc *desc, unsigned char **bytes,
                              size_t *size, facet_error *error)
{
    image_encode_desc d;
    *bytes = NULL;
    *size = 0;
    TRY(resolve(desc, IMAGE_CODEC_PNG, &d, error));
    return png_encode(i, &d, bytes, size, error);
}

/* NULL: facet does not write this format, or not by image_encode(). */
static codec_encode *find_encoder(image_codec codec_id)
{
    switch (codec_id) {
    case IMAGE_CODEC_PNG:
        return png_encode;
    case IMAGE_CODEC_JPEG:
        return jpeg_encode;
#ifdef HAVE_WEBP
    case IMAGE_CODEC_WEBP:
        return webp_encode;
#endif
    case IMAGE_CODEC_HDR:
        return hdr_encode;
    case IMAGE_CODEC_PFM:
        return pfm_encode;
    default:
        return NULL;
    }
}

facet_result image_encode(const image *i, image_codec codec_id, const image_encode_desc *desc,
                          unsigned char **bytes, size_t *size, facet_error *error)
{
    codec_encode *encode = find_encoder(codec_id);
    image_encode_desc d;
    *bytes = NULL;
    *size = 0;
    TRY(resolve(desc, codec_id, &d, error));
    if (!encode)
        return fail(error, FACET_ERROR_UNSUPPORTED, "this build of facet does not write %s files this way",
                    image_codec_name(codec_id));
    return encode(i, &d, bytes, size, error);
}
