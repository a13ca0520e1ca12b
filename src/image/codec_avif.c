/* codec_avif.c - AVIF through libavif, whose own memory comes from malloc; only built where libavif is. The first
 * picture of a sequence counts; rotations and crops that a file may ask for are not applied. */
#include "image/codec.h"

#include <avif/avif.h>

#include "base/result.h"

static facet_result fail_avif(facet_error *error, const char *name, avifResult status)
{
    switch (status) {
    case AVIF_RESULT_OUT_OF_MEMORY:
        return fail_memory(error, "AVIF decoder", 0);
    case AVIF_RESULT_NO_CODEC_AVAILABLE:
    case AVIF_RESULT_NOT_IMPLEMENTED:
    case AVIF_RESULT_UNSUPPORTED_DEPTH:
        return fail(error, FACET_ERROR_UNSUPPORTED, "%s: AVIF: a feature that libavif does not read here: %s",
                    name, avifResultToString(status));
    default:
        return fail(error, FACET_ERROR_INVALID, "%s: AVIF: %s", name, avifResultToString(status));
    }
}

/* Reads all but the picture itself. *out: to be destroyed, also after a failure (NULL: there is none). */
static facet_result open_file(const unsigned char *bytes, size_t size, const char *name, avifDecoder **out,
                              facet_error *error)
{
    avifDecoder *decoder = *out = avifDecoderCreate();
    if (!decoder)
        return fail_memory(error, "AVIF decoder", sizeof *decoder);
    decoder->ignoreExif = decoder->ignoreXMP = AVIF_TRUE;
    decoder->strictFlags = AVIF_STRICT_DISABLED; /* boxes that only describe the picture may be missing */
    decoder->imageDimensionLimit = 0;            /* sizes are checked here */
    decoder->imageSizeLimit = (uint32_t)CODEC_MAX_SIZE * CODEC_MAX_SIZE; /* the most that it takes */
    avifResult status = avifDecoderSetIOMemory(decoder, bytes, size);
    if (status == AVIF_RESULT_OK)
        status = avifDecoderParse(decoder);
    if (status != AVIF_RESULT_OK)
        return fail_avif(error, name, status);
    return codec_check_size(name, decoder->image->width, decoder->image->height, UINT32_MAX, error);
}

static image make_header(const avifDecoder *decoder)
{
    return (image){.width = decoder->image->width,
                   .height = decoder->image->height,
                   .channel_count = decoder->alphaPresent ? 4 : 3,
                   .type = decoder->image->depth > 8 ? IMAGE_U16 : IMAGE_U8,
                   .is_srgb = true};
}

facet_result avif_probe(const unsigned char *bytes, size_t size, const char *name, image *header,
                        facet_error *error)
{
    avifDecoder *decoder;
    facet_result result = open_file(bytes, size, name, &decoder, error);
    if (result == FACET_OK)
        *header = make_header(decoder);
    if (decoder)
        avifDecoderDestroy(decoder);
    return result;
}

/* The decoded planes as RGB or RGBA of all bits that out has. */
static avifResult convert(const avifImage *from, image *out)
{
    avifRGBImage rgb;
    avifRGBImageSetDefaults(&rgb, from);
    rgb.depth = out->type == IMAGE_U16 ? 16 : 8;
    rgb.format =
        out->channel_count == 4 ? AVIF_RGB_FORMAT_RGBA : AVIF_RGB_FORMAT_RGB; /* as the file has it */
    rgb.pixels = out->pixels;
    rgb.rowBytes = (uint32_t)image_row_size(out);
    return avifImageYUVToRGB(from, &rgb);
}

static facet_result decode(avifDecoder *decoder, const char *name, const image_decode_desc *desc, image *out,
                           facet_error *error)
{
    const image header = make_header(decoder);
    facet_result result = codec_check_size(name, header.width, header.height, desc->max_size, error);
    if (result != FACET_OK)
        return result;
    decoder->maxThreads = (int)desc->thread_count;
    avifResult status = avifDecoderNextImage(decoder);
    if (status != AVIF_RESULT_OK)
        return fail_avif(error, name, status);
    const image decoded = make_header(decoder);
    if (decoded.width != header.width || decoded.height != header.height || decoded.type != header.type)
        return fail(error, FACET_ERROR_INVALID, "%s: AVIF: %u x %u texels were expected, decoded %u x %u",
                    name, header.width, header.height, decoded.width, decoded.height);
    result = image_create(&desc->allocator, header.width, header.height, header.channel_count, header.type,
                          out, error);
    if (result != FACET_OK)
        return result;
    out->is_srgb = true;
    status = convert(decoder->image, out);
    if (status != AVIF_RESULT_OK)
        return fail_avif(error, name, status);
    if (desc->channel_count == 0 || desc->channel_count == header.channel_count || header.type != IMAGE_U8)
        return FACET_OK;
    /* libavif would multiply colors by an alpha that it leaves out */
    image asked;
    result = image_convert(out, &desc->allocator, desc->thread_count, desc->channel_count, IMAGE_U8, true,
                           &asked, error);
    image_destroy(out);
    *out = asked;
    return result;
}

facet_result avif_decode(const unsigned char *bytes, size_t size, const char *name,
                         const image_decode_desc *desc, image *out, facet_error *error)
{
    avifDecoder *decoder;
    image made = {0};
    facet_result result = open_file(bytes, size, name, &decoder, error);
    if (result == FACET_OK)
        result = decode(decoder, name, desc, &made, error);
    if (decoder)
        avifDecoderDestroy(decoder);
    if (result == FACET_OK)
        *out = made;
    else
        image_destroy(&made);
    return result;
}
