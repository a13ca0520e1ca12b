/* codec_webp.c - WebP through libwebp, whose own memory comes from malloc; built only with libwebp. */
#include "image/codec.h"

#include <string.h>

#include <webp/decode.h>
#include <webp/encode.h>

#include "base/memory.h"
#include "base/result.h"

static facet_result fail_webp(facet_error *error, const char *name, VP8StatusCode status)
{
    static const char *const messages[] = {
        [VP8_STATUS_INVALID_PARAM] = "invalid parameter",
        [VP8_STATUS_BITSTREAM_ERROR] = "the data is damaged",
        [VP8_STATUS_SUSPENDED] = "the file ends too early",
        [VP8_STATUS_USER_ABORT] = "aborted",
        [VP8_STATUS_NOT_ENOUGH_DATA] = "the file ends too early",
    };
    if (status == VP8_STATUS_OUT_OF_MEMORY)
        return fail_memory(error, "WebP decoder", 0);
    if (status == VP8_STATUS_UNSUPPORTED_FEATURE)
        return fail(error, FACET_ERROR_UNSUPPORTED, "%s: WebP: a feature that libwebp does not read", name);
    return fail(error, FACET_ERROR_INVALID, "%s: WebP: %s", name, messages[status]);
}

static facet_result read_header(const unsigned char *bytes, size_t size, const char *name,
                                WebPBitstreamFeatures *features, facet_error *error)
{
    VP8StatusCode status = WebPGetFeatures(bytes, size, features);
    if (status != VP8_STATUS_OK)
        return fail_webp(error, name, status);
    if (features->has_animation)
        return fail(error, FACET_ERROR_UNSUPPORTED, "%s: WebP: animations are not read", name);
    return codec_check_size(name, (uint64_t)features->width, (uint64_t)features->height, UINT32_MAX, error);
}

facet_result webp_probe(const unsigned char *bytes, size_t size, const char *name, image *header,
                        facet_error *error)
{
    WebPBitstreamFeatures features;
    TRY(read_header(bytes, size, name, &features, error));
    *header = codec_srgb_header((uint32_t)features.width, (uint32_t)features.height,
                                features.has_alpha ? 4 : 3, IMAGE_U8);
    return FACET_OK;
}

facet_result webp_decode(const unsigned char *bytes, size_t size, const char *name,
                         const image_decode_desc *desc, image *out, facet_error *error)
{
    WebPDecoderConfig config;
    if (!WebPInitDecoderConfig(&config))
        return fail(error, FACET_ERROR_SYSTEM,
                    "%s: libwebp has a different version from the one that facet was built with", name);
    image made = {0};
    TRY(read_header(bytes, size, name, &config.input, error));
    TRY(codec_check_size(name, (uint64_t)config.input.width, (uint64_t)config.input.height, desc->max_size,
                         error));
    uint32_t channel_count = desc->channel_count ? desc->channel_count : config.input.has_alpha ? 4 : 3;
    TRY(image_create(&desc->allocator, (uint32_t)config.input.width, (uint32_t)config.input.height,
                     channel_count, IMAGE_U8, &made, error));
    made.is_srgb = true;
    config.options.use_threads = desc->thread_count > 1;
    config.output.colorspace = channel_count == 4 ? MODE_RGBA : MODE_RGB;
    config.output.is_external_memory = 1;
    config.output.u.RGBA.rgba = made.pixels;
    config.output.u.RGBA.stride = (int)image_row_size(&made);
    config.output.u.RGBA.size = image_row_size(&made) * made.height;
    VP8StatusCode status = WebPDecode(bytes, size, &config);
    WebPFreeDecBuffer(&config.output);
    if (status != VP8_STATUS_OK) {
        image_destroy(&made);
        return fail_webp(error, name, status);
    }
    *out = made;
    return FACET_OK;
}

/* ---- writing ---- */

typedef struct growing {
    unsigned char *data; /* the first block exists before libwebp writes */
    size_t size, capacity;
    bool has_no_memory;
} growing;

static int append(const uint8_t *data, size_t size, const WebPPicture *picture)
{
    growing *g = picture->custom_ptr;
    if (!mem_reserve(NULL, (void **)&g->data, &g->capacity, g->size + size, 1)) {
        g->has_no_memory = true;
        return 0;
    }
    memcpy(g->data + g->size, data, size);
    g->size += size;
    return 1;
}

facet_result webp_encode(const image *i, const image_encode_desc *desc, unsigned char **bytes, size_t *size,
                         facet_error *error)
{
    facet_result result =
        codec_check_input(i, "WebP", i->type == IMAGE_U8, "8 bits and 3 or 4", 1u << 3 | 1u << 4, error);
    if (result != FACET_OK)
        return result;
    if (i->width > WEBP_MAX_DIMENSION || i->height > WEBP_MAX_DIMENSION)
        return fail(error, FACET_ERROR_ARGUMENT, "WebP: %u x %u texels, more than %d along an edge", i->width,
                    i->height, WEBP_MAX_DIMENSION);
    const bool is_lossless = desc->quality == 100;
    WebPConfig config;
    WebPPicture picture;
    if (!WebPConfigPreset(&config, WEBP_PRESET_DEFAULT, (float)desc->quality) || !WebPPictureInit(&picture))
        return fail(error, FACET_ERROR_SYSTEM,
                    "libwebp has a different version from the one that facet was built with");
    if (is_lossless)
        WebPConfigLosslessPreset(&config, 4);
    config.exact = is_lossless; /* colors under zero alpha are kept */
    config.thread_level = desc->thread_count > 1;
    growing file = {.capacity = (size_t)i->width * i->height / 4 + 4096};
    file.data = mem_alloc(&desc->allocator, file.capacity, 1);
    picture.use_argb = is_lossless;
    picture.width = (int)i->width;
    picture.height = (int)i->height;
    picture.writer = append;
    picture.custom_ptr = &file;
    int stride = (int)image_row_size(i);
    bool is_ok = file.data && (i->channel_count == 4 ? WebPPictureImportRGBA(&picture, i->pixels, stride)
                                                     : WebPPictureImportRGB(&picture, i->pixels, stride));
    is_ok = is_ok && WebPEncode(&config, &picture);
    if (!is_ok) {
        bool is_memory = !file.data || file.has_no_memory ||
                         picture.error_code == VP8_ENC_ERROR_OUT_OF_MEMORY ||
                         picture.error_code == VP8_ENC_ERROR_BITSTREAM_OUT_OF_MEMORY;
        result = is_memory
                     ? fail_memory(error, "WebP file", file.capacity)
                     : fail(error, FACET_ERROR_BUG, "WebP: libwebp failed with %d", (int)picture.error_code);
        mem_free(file.data);
    } else {
        *bytes = file.data;
        *size = file.size;
    }
    WebPPictureFree(&picture);
    return result;
}
