/* codec_jpeg.c - JPEG through TurboJPEG: reading with scaling by the DCT, writing without chroma
 * subsampling. */
#include "image/codec.h"

#include <limits.h>
#include <string.h>

#include <turbojpeg.h>

#include "base/memory.h"
#include "base/result.h"

/* Fails with TurboJPEG's message. */
static facet_result fail_jpeg(facet_error *error, const char *name, tjhandle handle)
{
    const char *message = tjGetErrorStr2(handle);
    if (strstr(message, "emory"))
        return fail(error, FACET_ERROR_MEMORY, "%s: JPEG: %s", name, message);
    return fail(error, FACET_ERROR_INVALID, "%s: JPEG: %s", name, message);
}

/* Whether the last failure is only a warning that leaves the image intact: stray bytes before a marker,
 * parameters that decoders ignore. Damage to the image is an error. TurboJPEG classifies by the first warning
 * only, so the text of the last one decides. */
static bool is_harmless(tjhandle handle)
{
    static const char *const harmless[] = {"extraneous bytes", "unknown JFIF revision", "Unknown Adobe color",
                                           "Invalid SOS parameters"};
    for (size_t i = 0; i < sizeof harmless / sizeof *harmless; i++)
        if (tjGetErrorCode(handle) == TJERR_WARNING && strstr(tjGetErrorStr2(handle), harmless[i]))
            return true;
    return false;
}

static facet_result read_header(tjhandle handle, const unsigned char *bytes, size_t size, const char *name,
                                int *width, int *height, int *color_space, facet_error *error)
{
    int subsampling;
    *width = *height = *color_space = 0;
    if (size > ULONG_MAX || (tjDecompressHeader3(handle, bytes, (unsigned long)size, width, height,
                                                 &subsampling, color_space) != 0 &&
                             !is_harmless(handle)))
        return fail_jpeg(error, name, handle);
    if (*width <= 0 ||
        *height <= 0) /* libjpeg accepts files with tables only and leaves the sizes unchanged */
        return fail(error, FACET_ERROR_INVALID, "%s: JPEG: holds no image", name);
    return FACET_OK;
}

facet_result jpeg_probe(const unsigned char *bytes, size_t size, const char *name, image *header,
                        facet_error *error)
{
    tjhandle handle = tjInitDecompress();
    if (!handle)
        return fail_memory(error, "JPEG decoder", 0);
    int width, height, color_space;
    facet_result result = read_header(handle, bytes, size, name, &width, &height, &color_space, error);
    tjDestroy(handle);
    if (result == FACET_OK)
        *header =
            codec_srgb_header((uint32_t)width, (uint32_t)height, color_space == TJCS_GRAY ? 1 : 3, IMAGE_U8);
    return result;
}

/* Whether an APP14 segment of Adobe precedes the first scan: its four-component files store inverted inks,
 * 255 for none. Bytes before a marker are skipped, as in libjpeg. */
static bool is_adobe(const unsigned char *bytes, size_t size)
{
    size_t at = 2;
    while (at + 4 <= size) {
        if (bytes[at] != 0xff || bytes[at + 1] == 0xff || bytes[at + 1] == 0) { /* stray or a fill byte */
            at++;
            continue;
        }
        const unsigned marker = bytes[at + 1];
        if (marker == 0xda)
            return false;
        const size_t length = (size_t)bytes[at + 2] << 8 | bytes[at + 3];
        if (marker == 0xee && length >= 14 && at + 9 <= size && memcmp(bytes + at + 4, "Adobe", 5) == 0)
            return true;
        at += 2 + length;
    }
    return false;
}

/* Converts CMYK to RGB, each ink a filter over white: R = (1 - C)(1 - K). Works in place for channel_count 3
 * or 4. */
static void convert_cmyk(const unsigned char *cmyk, bool is_inverted, size_t texel_count,
                         uint32_t channel_count, unsigned char *out)
{
    unsigned flip = is_inverted ? 0 : 255;
    for (size_t i = 0; i < texel_count; i++, cmyk += 4, out += channel_count) {
        unsigned black = cmyk[3] ^ flip;
        unsigned char rgb[3];
        for (int c = 0; c < 3; c++)
            rgb[c] = (unsigned char)(((cmyk[c] ^ flip) * black + 127) / 255);
        memcpy(out, rgb, 3);
        if (channel_count == 4)
            out[3] = 255;
    }
}

/* Fits the image reduced by 2^k into *width and *height. */
static void reduce(uint32_t k, uint32_t *width, uint32_t *height)
{
    *width = (*width + (1u << k) - 1) >> k;
    *height = (*height + (1u << k) - 1) >> k;
}

static facet_result decode(tjhandle handle, const unsigned char *bytes, size_t size, const char *name,
                           const image_decode_desc *desc, image *out, facet_error *error)
{
    int full_width, full_height, color_space;
    TRY(read_header(handle, bytes, size, name, &full_width, &full_height, &color_space, error));
    TRY(codec_check_size(name, (uint64_t)full_width, (uint64_t)full_height, desc->max_size, error));
    const bool is_cmyk = color_space == TJCS_CMYK || color_space == TJCS_YCCK;
    const uint32_t own_count = color_space == TJCS_GRAY ? 1 : 3;
    const uint32_t channel_count = desc->channel_count ? desc->channel_count : own_count;
    uint32_t width = (uint32_t)full_width;
    uint32_t height = (uint32_t)full_height;
    reduce(desc->max_reduction < 3 ? desc->max_reduction : 3, &width, &height);

    image inks = {0}; /* CMYK is decoded to four channels */
    image *target = is_cmyk && channel_count == 3 ? &inks : out;
    facet_result result = image_create(&desc->allocator, width, height, channel_count, IMAGE_U8, out, error);
    if (result == FACET_OK && target == &inks)
        result = image_create(&desc->allocator, width, height, 4, IMAGE_U8, &inks, error);
    if (result != FACET_OK)
        return result;
    out->is_srgb = true;
    int format = is_cmyk              ? TJPF_CMYK
                 : channel_count == 1 ? TJPF_GRAY
                 : channel_count == 3 ? TJPF_RGB
                                      : TJPF_RGBA;
    if (tjDecompress2(handle, bytes, (unsigned long)size, target->pixels, (int)width, 0, (int)height, format,
                      TJFLAG_LIMITSCANS) != 0 &&
        !is_harmless(handle))
        result = fail_jpeg(error, name, handle);
    if (result == FACET_OK && is_cmyk)
        convert_cmyk(target->pixels, is_adobe(bytes, size), (size_t)width * height, channel_count,
                     out->pixels);
    image_destroy(&inks);
    return result;
}

facet_result jpeg_decode(const unsigned char *bytes, size_t size, const char *name,
                         const image_decode_desc *desc, image *out, facet_error *error)
{
    tjhandle handle = tjInitDecompress();
    if (!handle)
        return fail_memory(error, "JPEG decoder", 0);
    image made = {0};
    facet_result result = decode(handle, bytes, size, name, desc, &made, error);
    tjDestroy(handle);
    if (result == FACET_OK)
        *out = made;
    else
        image_destroy(&made);
    return result;
}

facet_result jpeg_encode(const image *i, const image_encode_desc *desc, unsigned char **bytes, size_t *size,
                         facet_error *error)
{
    facet_result result =
        codec_check_input(i, "JPEG", i->type == IMAGE_U8, "8 bits and 1 or 3", 1u << 1 | 1u << 3, error);
    if (result != FACET_OK)
        return result;
    if (i->width > 65500 || i->height > 65500)
        return fail(error, FACET_ERROR_ARGUMENT, "JPEG: %u x %u texels, more than 65500 along an edge",
                    i->width, i->height);
    const bool is_grey = i->channel_count == 1;
    const int subsampling = is_grey ? TJSAMP_GRAY : TJSAMP_444;
    unsigned long used = tjBufSize((int)i->width, (int)i->height, subsampling);
    tjhandle handle = tjInitCompress();
    unsigned char *file = mem_alloc(&desc->allocator, used, 1);
    if (!handle || !file)
        result = fail_memory(error, "JPEG file", used);
    else if (tjCompress2(handle, i->pixels, (int)i->width, 0, (int)i->height, is_grey ? TJPF_GRAY : TJPF_RGB,
                         &file, &used, subsampling, (int)desc->quality,
                         TJFLAG_NOREALLOC | TJFLAG_ACCURATEDCT) != 0)
        result = fail_jpeg(error, "JPEG", handle);
    if (handle)
        tjDestroy(handle);
    if (result == FACET_OK) {
        *bytes = file;
        *size = used;
    } else {
        mem_free(file);
    }
    return result;
}
