/* codec_avif.c - AVIF through libavif, whose own memory comes from malloc; only built where libavif is. The first
 * picture of a sequence counts; rotations and crops that a file may ask for are not applied.
 *
 * libavif is opened when a file needs it: it brings 23 libraries along, which would cost every start of a program
 * that is linked with them 1.5 ms. */
#include "image/codec.h"

#include <avif/avif.h>
#include <dlfcn.h>

#include <string.h>

#include "base/result.h"

/* The functions of libavif that are called. */
typedef struct avif_library {
    void *handle;
    const char *(*result_text)(avifResult);
    avifDecoder *(*create)(void);
    void (*destroy)(avifDecoder *);
    avifResult (*set_memory)(avifDecoder *, const uint8_t *, size_t);
    avifResult (*parse)(avifDecoder *);
    avifResult (*next_image)(avifDecoder *);
    void (*rgb_defaults)(avifRGBImage *, const avifImage *);
    avifResult (*to_rgb)(const avifImage *, avifRGBImage *);
} avif_library;

/* A decoder and the library that it is of. {0}. */
typedef struct avif_file {
    avif_library library;
    avifDecoder *decoder;
} avif_file;

static facet_result open_library(avif_library *out, const char *name, facet_error *error)
{
    out->handle = dlopen(FACET_AVIF_SONAME, RTLD_NOW | RTLD_LOCAL);
    if (!out->handle)
        return fail(error, FACET_ERROR_UNSUPPORTED, "%s: AVIF: %s is not installed", name, FACET_AVIF_SONAME);
    const struct {
        const char *symbol;
        void *place; /* of the pointer */
    } functions[] = {{"avifResultToString", &out->result_text},
                     {"avifDecoderCreate", &out->create},
                     {"avifDecoderDestroy", &out->destroy},
                     {"avifDecoderSetIOMemory", &out->set_memory},
                     {"avifDecoderParse", &out->parse},
                     {"avifDecoderNextImage", &out->next_image},
                     {"avifRGBImageSetDefaults", &out->rgb_defaults},
                     {"avifImageYUVToRGB", &out->to_rgb}};
    for (size_t i = 0; i < sizeof functions / sizeof *functions; i++) {
        void *symbol = dlsym(out->handle, functions[i].symbol);
        if (!symbol)
            return fail(error, FACET_ERROR_UNSUPPORTED, "%s: AVIF: %s has no %s", name, FACET_AVIF_SONAME,
                        functions[i].symbol);
        memcpy(functions[i].place, &symbol, sizeof symbol);
    }
    return FACET_OK;
}

static void close_file(avif_file *f)
{
    if (f->decoder)
        f->library.destroy(f->decoder);
    if (f->library.handle)
        dlclose(f->library.handle);
}

static facet_result fail_avif(const avif_library *l, facet_error *error, const char *name, avifResult status)
{
    switch (status) {
    case AVIF_RESULT_OUT_OF_MEMORY:
        return fail_memory(error, "AVIF decoder", 0);
    case AVIF_RESULT_NO_CODEC_AVAILABLE:
    case AVIF_RESULT_NOT_IMPLEMENTED:
    case AVIF_RESULT_UNSUPPORTED_DEPTH:
        return fail(error, FACET_ERROR_UNSUPPORTED, "%s: AVIF: a feature that libavif does not read here: %s",
                    name, l->result_text(status));
    default:
        return fail(error, FACET_ERROR_INVALID, "%s: AVIF: %s", name, l->result_text(status));
    }
}

/* Reads all but the picture itself. *out: to be closed, also after a failure. */
static facet_result open_file(const unsigned char *bytes, size_t size, const char *name, avif_file *out,
                              facet_error *error)
{
    *out = (avif_file){0};
    facet_result result = open_library(&out->library, name, error);
    if (result != FACET_OK)
        return result;
    avifDecoder *decoder = out->decoder = out->library.create();
    if (!decoder)
        return fail_memory(error, "AVIF decoder", sizeof *decoder);
    decoder->ignoreExif = decoder->ignoreXMP = AVIF_TRUE;
    decoder->strictFlags = AVIF_STRICT_DISABLED; /* boxes that only describe the picture may be missing */
    decoder->imageDimensionLimit = 0;            /* sizes are checked here */
    decoder->imageSizeLimit = (uint32_t)CODEC_MAX_SIZE * CODEC_MAX_SIZE; /* the most that it takes */
    avifResult status = out->library.set_memory(decoder, bytes, size);
    if (status == AVIF_RESULT_OK)
        status = out->library.parse(decoder);
    if (status != AVIF_RESULT_OK)
        return fail_avif(&out->library, error, name, status);
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
    avif_file file;
    facet_result result = open_file(bytes, size, name, &file, error);
    if (result == FACET_OK)
        *header = make_header(file.decoder);
    close_file(&file);
    return result;
}

/* The decoded planes as RGB or RGBA of all bits that out has. */
static avifResult convert(const avif_library *l, const avifImage *from, image *out)
{
    avifRGBImage rgb;
    l->rgb_defaults(&rgb, from);
    rgb.depth = out->type == IMAGE_U16 ? 16 : 8;
    rgb.format =
        out->channel_count == 4 ? AVIF_RGB_FORMAT_RGBA : AVIF_RGB_FORMAT_RGB; /* as the file has it */
    rgb.pixels = out->pixels;
    rgb.rowBytes = (uint32_t)image_row_size(out);
    return l->to_rgb(from, &rgb);
}

static facet_result decode(const avif_file *file, const char *name, const image_decode_desc *desc, image *out,
                           facet_error *error)
{
    const avif_library *l = &file->library;
    avifDecoder *decoder = file->decoder;
    const image header = make_header(decoder);
    facet_result result = codec_check_size(name, header.width, header.height, desc->max_size, error);
    if (result != FACET_OK)
        return result;
    decoder->maxThreads = (int)desc->thread_count;
    avifResult status = l->next_image(decoder);
    if (status != AVIF_RESULT_OK)
        return fail_avif(l, error, name, status);
    const image decoded = make_header(decoder);
    if (decoded.width != header.width || decoded.height != header.height || decoded.type != header.type)
        return fail(error, FACET_ERROR_INVALID, "%s: AVIF: %u x %u texels were expected, decoded %u x %u",
                    name, header.width, header.height, decoded.width, decoded.height);
    result = image_create(&desc->allocator, header.width, header.height, header.channel_count, header.type,
                          out, error);
    if (result != FACET_OK)
        return result;
    out->is_srgb = true;
    status = convert(l, decoder->image, out);
    if (status != AVIF_RESULT_OK)
        return fail_avif(l, error, name, status);
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
    avif_file file;
    image made = {0};
    facet_result result = open_file(bytes, size, name, &file, error);
    if (result == FACET_OK)
        result = decode(&file, name, desc, &made, error);
    close_file(&file);
    if (result == FACET_OK)
        *out = made;
    else
        image_destroy(&made);
    return result;
}
