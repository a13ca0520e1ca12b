/* codec_avif.c - AVIF through libavif, whose own memory comes from malloc; built only with libavif. Reads the
 * first image of a sequence. libavif leaves clean aperture, rotation and mirroring to the caller.
 *
 * libavif is opened when a file needs it: it depends on 23 libraries, and linking it would add 1.5 ms to
 * every start. */
#include "image/codec.h"

#include <avif/avif.h>
#include <dlfcn.h>

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/library.h"
#include "base/result.h"

/* clang-format off */
#define AVIF_FUNCTIONS(F, out) \
    F(out, avifResultToString, result_text) F(out, avifDecoderCreate, create) \
    F(out, avifDecoderDestroy, destroy) F(out, avifDecoderSetIOMemory, set_memory) \
    F(out, avifDecoderParse, parse) F(out, avifDecoderNextImage, next_image) \
    F(out, avifRGBImageSetDefaults, rgb_defaults) F(out, avifImageYUVToRGB, to_rgb)
/* clang-format on */

/* Functions of libavif. */
typedef struct avif_library {
    void *handle;
    AVIF_FUNCTIONS(LIBRARY_MEMBER, )
} avif_library;

/* A decoder and its library. {0}: none. */
typedef struct avif_file {
    avif_library library;
    avifDecoder *decoder;
} avif_file;

static facet_result open_library(avif_library *out, const char *name, facet_error *error)
{
    char subject[512];
    snprintf(subject, sizeof subject, "%.400s: AVIF", name);
    const library_symbol symbols[] = {AVIF_FUNCTIONS(LIBRARY_SYMBOL, out)};
    const library_desc desc = {.subject = subject,
                               .advice = " is not installed",
                               .missing = FACET_ERROR_UNSUPPORTED,
                               .symbols = symbols,
                               .symbol_count = sizeof symbols / sizeof *symbols};
    return library_open(FACET_AVIF_SONAME, &desc, &out->handle, error);
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

/* Reads everything but the image itself. *out must be closed, also after a failure. */
static facet_result open_file(const unsigned char *bytes, size_t size, const char *name, avif_file *out,
                              facet_error *error)
{
    *out = (avif_file){0};
    TRY(open_library(&out->library, name, error));
    avifDecoder *decoder = out->decoder = out->library.create();
    if (!decoder)
        return fail_memory(error, "AVIF decoder", sizeof *decoder);
    decoder->ignoreExif = decoder->ignoreXMP = AVIF_TRUE;
    decoder->strictFlags = AVIF_STRICT_DISABLED; /* descriptive boxes may be missing */
    decoder->imageDimensionLimit = 0;            /* sizes are checked by the caller */
    decoder->imageSizeLimit = (uint32_t)CODEC_MAX_SIZE * CODEC_MAX_SIZE; /* its maximum */
    avifResult status = out->library.set_memory(decoder, bytes, size);
    if (status == AVIF_RESULT_OK)
        status = out->library.parse(decoder);
    if (status != AVIF_RESULT_OK)
        return fail_avif(&out->library, error, name, status);
    return codec_check_size(name, decoder->image->width, decoder->image->height, UINT32_MAX, error);
}

/* ---- clean aperture, rotation, mirroring: ISO/IEC 23008-12:2022, 6.5.9, 6.5.10 and 6.5.12, in this order ---- */

typedef struct crop {
    uint32_t x, y, width, height;
} crop;

/* One axis of a clean aperture: size and centre offset from the middle of count texels, as fractions,
 * rounded to whole texels. False: not inside the image, or nothing. */
static bool find_aperture(uint32_t count, uint32_t size_n, uint32_t size_d, uint32_t offset_n,
                          uint32_t offset_d, uint32_t *first, uint32_t *size)
{
    if (size_d == 0 || offset_d == 0)
        return false;
    const double n = floor((double)size_n / size_d + 0.5);
    const double offset = (double)(int32_t)offset_n / (double)(int32_t)offset_d;
    const double begin = floor(offset + (count - n) / 2.0 + 0.5);
    if (!(n >= 1.0 && begin >= 0.0 && begin + n <= count))
        return false;
    *first = (uint32_t)begin;
    *size = (uint32_t)n;
    return true;
}

/* False: the aperture does not fit, and *out is the whole image. */
static bool find_crop(const avifImage *i, crop *out)
{
    *out = (crop){0, 0, i->width, i->height};
    if (!(i->transformFlags & AVIF_TRANSFORM_CLAP))
        return true;
    const avifCleanApertureBox *c = &i->clap;
    crop found;
    if (!find_aperture(i->width, c->widthN, c->widthD, c->horizOffN, c->horizOffD, &found.x, &found.width) ||
        !find_aperture(i->height, c->heightN, c->heightD, c->vertOffN, c->vertOffD, &found.y, &found.height))
        return false;
    *out = found;
    return true;
}

/* Quarter turns anticlockwise. */
static uint32_t get_turns(const avifImage *i)
{
    return i->transformFlags & AVIF_TRANSFORM_IROT ? i->irot.angle & 3u : 0;
}

typedef enum mirroring { MIRROR_NONE, MIRROR_ROWS, MIRROR_COLUMNS } mirroring;

static mirroring get_mirroring(const avifImage *i)
{
#if AVIF_VERSION >= 1000000
    const uint8_t axis = i->imir.axis;
#else
    const uint8_t axis = i->imir.mode;
#endif
    return !(i->transformFlags & AVIF_TRANSFORM_IMIR) ? MIRROR_NONE : axis ? MIRROR_COLUMNS : MIRROR_ROWS;
}

/* Applies the file's crop, rotation and mirroring; in is released. */
static facet_result orient(image *in, const avifImage *properties, const facet_allocator *allocator,
                           image *out, facet_error *error)
{
    crop c;
    find_crop(properties, &c);
    const uint32_t turns = get_turns(properties);
    const mirroring m = get_mirroring(properties);
    if (c.width == in->width && c.height == in->height && turns == 0 && m == MIRROR_NONE) {
        *out = *in;
        *in = (image){0};
        return FACET_OK;
    }
    const uint32_t width = turns % 2 ? c.height : c.width;
    const uint32_t height = turns % 2 ? c.width : c.height;
    facet_result result = image_create(allocator, width, height, in->channel_count, in->type, out, error);
    const size_t texel_size = image_texel_size(in);
    unsigned char *to = out->pixels;
    for (uint32_t row = 0; row < height && result == FACET_OK; row++) {
        const uint32_t y = m == MIRROR_ROWS ? height - 1 - row : row;
        for (uint32_t column = 0; column < width; column++, to += texel_size) {
            const uint32_t x = m == MIRROR_COLUMNS ? width - 1 - column : column;
            const uint32_t from_x[4] = {x, c.width - 1 - y, c.width - 1 - x, y};
            const uint32_t from_y[4] = {y, x, c.height - 1 - y, c.height - 1 - x};
            const size_t texel = (size_t)(c.y + from_y[turns]) * in->width + c.x + from_x[turns];
            memcpy(to, (const unsigned char *)in->pixels + texel * texel_size, texel_size);
        }
    }
    out->is_srgb = in->is_srgb;
    image_destroy(in);
    return result;
}

/* ---- probing and decoding ---- */

/* As it is stored. */
static image make_header(const avifDecoder *decoder)
{
    return codec_srgb_header(decoder->image->width, decoder->image->height, decoder->alphaPresent ? 4 : 3,
                             decoder->image->depth > 8 ? IMAGE_U16 : IMAGE_U8);
}

facet_result avif_probe(const unsigned char *bytes, size_t size, const char *name, image *header,
                        facet_error *error)
{
    avif_file file;
    facet_result result = open_file(bytes, size, name, &file, error);
    if (result == FACET_OK) {
        crop c;
        find_crop(file.decoder->image, &c);
        const bool is_upright = get_turns(file.decoder->image) % 2 == 0;
        *header = make_header(file.decoder);
        header->width = is_upright ? c.width : c.height;
        header->height = is_upright ? c.height : c.width;
    }
    close_file(&file);
    return result;
}

/* The reason why libavif cannot convert the colors; NULL: it can. */
static const char *get_unread_matrix(const avifImage *i)
{
    switch (i->matrixCoefficients) {
    case AVIF_MATRIX_COEFFICIENTS_BT2020_CL:
        return "BT.2020 with constant luminance";
    case AVIF_MATRIX_COEFFICIENTS_SMPTE2085:
        return "SMPTE ST 2085";
    case AVIF_MATRIX_COEFFICIENTS_CHROMA_DERIVED_CL:
        return "constant luminance derived from the chromaticities";
    case AVIF_MATRIX_COEFFICIENTS_ICTCP:
        return "ICtCp";
    default:
        return NULL;
    }
}

/* Converts the decoded planes to RGB or RGBA at the depth of out. */
static avifResult convert(const avif_library *l, const avifImage *from, image *out)
{
    avifRGBImage rgb;
    l->rgb_defaults(&rgb, from);
    rgb.depth = out->type == IMAGE_U16 ? 16 : 8;
    rgb.format =
        out->channel_count == 4 ? AVIF_RGB_FORMAT_RGBA : AVIF_RGB_FORMAT_RGB; /* straight alpha, as stored */
    rgb.pixels = out->pixels;
    rgb.rowBytes = (uint32_t)image_row_size(out);
    return l->to_rgb(from, &rgb);
}

/* Decodes the image as it is stored, with its own channels. */
static facet_result decode_stored(const avif_file *file, const char *name, const image_decode_desc *desc,
                                  image *out, facet_error *error)
{
    const avif_library *l = &file->library;
    avifDecoder *decoder = file->decoder;
    const image header = make_header(decoder);
    TRY(codec_check_size(name, header.width, header.height, desc->max_size, error));
    const char *matrix = get_unread_matrix(decoder->image);
    if (matrix)
        return fail(error, FACET_ERROR_UNSUPPORTED,
                    "%s: AVIF: matrix coefficients %u (%s): colors of this kind are not converted to RGB",
                    name, decoder->image->matrixCoefficients, matrix);
    decoder->maxThreads = (int)desc->thread_count;
    avifResult status = l->next_image(decoder);
    if (status != AVIF_RESULT_OK)
        return fail_avif(l, error, name, status);
    const image decoded = make_header(decoder);
    if (decoded.width != header.width || decoded.height != header.height || decoded.type != header.type)
        return fail(error, FACET_ERROR_INVALID, "%s: AVIF: %u x %u texels were expected, decoded %u x %u",
                    name, header.width, header.height, decoded.width, decoded.height);
    TRY(image_create(&desc->allocator, header.width, header.height, header.channel_count, header.type, out,
                     error));
    out->is_srgb = true;
    status = convert(l, decoder->image, out);
    return status == AVIF_RESULT_OK ? FACET_OK : fail_avif(l, error, name, status);
}

static facet_result decode(const avif_file *file, const char *name, const image_decode_desc *desc, image *out,
                           facet_error *error)
{
    image stored = {0};
    crop c;
    facet_result result = decode_stored(file, name, desc, &stored, error);
    if (result == FACET_OK && !find_crop(file->decoder->image, &c))
        image_note_set(desc->note, FACET_LOG_LEVEL_WARNING,
                       "its clean aperture (clap) is not inside the image and is ignored");
    if (result == FACET_OK)
        result = orient(&stored, file->decoder->image, &desc->allocator, out, error);
    image_destroy(&stored);
    /* libavif would premultiply colors by an alpha that is dropped */
    return result == FACET_OK ? codec_set_channels(out, desc, error) : result;
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
