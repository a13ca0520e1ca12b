/* codec_exr.c - OpenEXR through its library (exr_shim.h): rows to texels in parallel, layers to channels.
 * Reads the first part of a file, its scanlines or the finest level of its tiles; deep data is refused. */
#include "image/codec.h"

#include <float.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "base/memory.h"
#include "base/parallel.h"
#include "base/result.h"
#include "image/exr_shim.h"
#include "image/primaries.h"

enum {
    STRIP_ROWS = 16,        /* of a ZIP chunk */
    PARALLEL_TEXELS = 65536 /* fewer are not worth another thread */
};

facet_result exr_probe(const unsigned char *bytes, size_t size, const char *name, image *header,
                       facet_error *error)
{
    exr_info info;
    exr_sizes s;
    TRY(exr_check(bytes, size, name, INT32_MAX, NULL, 0, &info, &s, error));
    *header =
        (image){.width = s.width, .height = s.height, .channel_count = info.channel_count, .type = IMAGE_F32};
    return FACET_OK;
}

/* ---- reading ---- */

typedef struct reading {
    const unsigned char *bytes;
    size_t size;
    const exr_info *info;
    const exr_sizes *sizes;
    const facet_allocator *allocator;
    image *image;
    bool keeps_nonfinite;
    _Atomic uint64_t failure; /* row << 8 | facet_result of the first strip that failed; UINT64_MAX: none */
} reading;

/* Copies samples of one channel to texels. NaN and negative infinity become 0, infinity the largest number of
 * the channel's type, 65504 for half, so that sums stay finite. */
static void store_samples(const float *from, bool is_half, size_t count, size_t stride, float *to)
{
    for (size_t x = 0; x < count * stride; x += stride) {
        float value = codec_finite(from[x]);
        if (is_half) {
            value = from[x] >= -65504.0f ? value : 0.0f;
            value = value <= 65504.0f ? value : 65504.0f;
        }
        to[x] = value;
    }
}

/* Copies the part of rows [row, row_end) of the data window that is inside the display window. */
static void store_rows(const reading *r, uint32_t row, uint32_t row_end, const float *texels)
{
    const exr_info *info = r->info;
    const size_t channels = info->channel_count;
    const int64_t x =
        (int64_t)info->data.min_x - info->display.min_x; /* position of the data window in the image */
    const int64_t y = (int64_t)info->data.min_y - info->display.min_y;
    const int64_t width = r->sizes->data_width;
    const int64_t first = x < 0 ? -x : 0; /* column of the data window */
    const int64_t end = (int64_t)r->sizes->width - x < width ? (int64_t)r->sizes->width - x : width;
    for (; row < row_end && first < end; row++, texels += (size_t)width * channels) {
        if (y + row < 0 || y + row >= r->sizes->height)
            continue;
        float *to = (float *)r->image->pixels +
                    ((size_t)(y + row) * r->sizes->width + (size_t)(x + first)) * channels;
        if (r->keeps_nonfinite)
            memcpy(to, texels + (size_t)first * channels, (size_t)(end - first) * channels * sizeof *to);
        for (size_t k = 0; k < channels && !r->keeps_nonfinite; k++)
            store_samples(texels + (size_t)first * channels + k, info->sources[k].is_half,
                          (size_t)(end - first), channels, to + k);
    }
}

static void record_failure(reading *r, uint64_t row, facet_result result)
{
    const uint64_t failure = row << 8 | (uint64_t)result;
    uint64_t first = atomic_load(&r->failure);
    while (failure < first && !atomic_compare_exchange_weak(&r->failure, &first, failure))
        ;
}

static void read_strips(void *context, size_t begin, size_t end)
{
    reading *r = context;
    const uint32_t rows = r->sizes->strip_rows;
    char message[EXR_MESSAGE];
    exr_reader *reader = NULL;
    float *texels =
        mem_alloc(r->allocator, (size_t)rows * r->sizes->data_width, r->info->channel_count * sizeof(float));
    facet_result result = FACET_ERROR_MEMORY;
    if (texels && mem_account(r->allocator, (ptrdiff_t)r->sizes->library_memory)) {
        result = exr_shim_open(r->bytes, r->size, &reader, message);
        for (; begin < end && result == FACET_OK; begin += result == FACET_OK) {
            const uint32_t row = (uint32_t)begin * rows;
            const uint32_t row_end = r->sizes->data_height - row > rows ? row + rows : r->sizes->data_height;
            result = exr_shim_read(reader, r->info, row, row_end, texels, message);
            if (result == FACET_OK)
                store_rows(r, row, row_end, texels);
        }
        exr_shim_close(reader);
        mem_account(r->allocator, -(ptrdiff_t)r->sizes->library_memory);
    }
    if (result != FACET_OK)
        record_failure(r, (uint64_t)begin * rows, result);
    mem_free(texels);
}

/* Opens the file, which detects damaged tables before memory is allocated for the image. */
static facet_result check_open(const reading *r, const char *name, facet_error *error)
{
    char message[EXR_MESSAGE] = "";
    exr_reader *reader;
    if (!mem_account(r->allocator, (ptrdiff_t)r->sizes->library_memory))
        return fail_memory(error, "OpenEXR library", (size_t)r->sizes->library_memory);
    facet_result result = exr_shim_open(r->bytes, r->size, &reader, message);
    exr_shim_close(reader);
    mem_account(r->allocator, -(ptrdiff_t)r->sizes->library_memory);
    return result == FACET_OK ? FACET_OK : exr_fail(error, result, name, message);
}

static facet_result decode(reading *r, const char *name, const image_decode_desc *desc, facet_error *error)
{
    const exr_info *info = r->info;
    const exr_sizes *s = r->sizes;
    TRY(check_open(r, name, error));
    TRY(image_create(&desc->allocator, s->width, s->height, info->channel_count, IMAGE_F32, r->image, error));
    if (info->data.min_x > info->display.min_x || info->data.min_y > info->display.min_y ||
        info->data.max_x < info->display.max_x || info->data.max_y < info->display.max_y)
        memset(r->image->pixels, 0, image_row_size(r->image) * s->height); /* 0 outside of the data window */
    const size_t strip_count = (s->data_height - 1) / s->strip_rows + 1;
    const size_t strip_texels = (size_t)s->strip_rows * s->data_width;
    size_t grain =
        (strip_count + desc->thread_count - 1) / desc->thread_count; /* each thread opens the file once */
    const size_t worth = PARALLEL_TEXELS / strip_texels + 1;
    parallel_for(desc->thread_count, strip_count, grain > worth ? grain : worth, read_strips, r);
    const uint64_t failure = atomic_load(&r->failure);
    if (failure == UINT64_MAX)
        return FACET_OK;
    if ((failure & 0xff) == FACET_ERROR_MEMORY)
        return fail_memory(error, "OpenEXR rows", strip_texels * image_texel_size(r->image));
    return fail(error, FACET_ERROR_INVALID, "%s: OpenEXR: the rows from %llu of %u on are damaged or missing",
                name, (unsigned long long)(failure >> 8), s->data_height);
}

image_envmap exr_get_envmap(const unsigned char *bytes, size_t size)
{
    static const exr_channel none = {0};
    exr_info info;
    exr_sizes s;
    return exr_check(bytes, size, "", INT32_MAX, &none, 0, &info, &s, NULL) == FACET_OK ? info.envmap
                                                                                        : IMAGE_ENVMAP_NONE;
}

/* Whether the first three channels are R, G and B of any layer, not other quantities or one channel for all. */
static bool is_rgb(const exr_info *info)
{
    for (uint32_t k = 0; k < 3; k++) {
        const char *name = k < info->channel_count ? info->sources[k].name : "";
        const char *point = strrchr(name, '.');
        if (strcasecmp(point ? point + 1 : name, (const char *[]){"R", "G", "B"}[k]) != 0)
            return false;
    }
    return true;
}

static void convert_color(const exr_info *info, image *i, const image_decode_desc *desc)
{
    primaries p;
    if (!info->has_chromaticities || !is_rgb(info))
        return;
    for (int k = 0; k < 8; k++)
        p.xy[k / 2][k % 2] = (double)info->chromaticities[k];
    primaries_convert(i, &p, desc);
}

facet_result exr_decode(const unsigned char *bytes, size_t size, const char *name,
                        const image_decode_desc *desc, image *out, facet_error *error)
{
    exr_info info;
    exr_sizes s;
    image made = {0};
    char message[EXR_MESSAGE] = "";
    const exr_channel none = {0};
    facet_result result =
        exr_check(bytes, size, name, desc->max_size, desc->layer ? &none : NULL, 0, &info, &s, error);
    if (result == FACET_OK && desc->layer) {
        result = exr_shim_layer(bytes, size, desc->layer, &info, message);
        if (result != FACET_OK)
            return exr_fail(error, result, name, message);
    }
    if (result != FACET_OK)
        return result;
    reading r = {.bytes = bytes,
                 .size = size,
                 .info = &info,
                 .sizes = &s,
                 .allocator = &desc->allocator,
                 .image = &made,
                 .keeps_nonfinite = desc->keeps_nonfinite};
    bool is_half = true;
    for (uint32_t k = 0; k < info.channel_count && k < 3; k++)
        is_half &= info.sources[k].is_half;
    *desc->largest = is_half ? 65504.0f : FLT_MAX;
    atomic_init(&r.failure, UINT64_MAX);
    result = decode(&r, name, desc, error);
    if (result == FACET_OK) {
        convert_color(&info, &made, desc);
        *out = made;
    } else {
        image_destroy(&made);
    }
    return result;
}

/* ---- writing ---- */

static int compare_names(const void *a, const void *b)
{
    return strcmp(((const exr_channel *)a)->name, ((const exr_channel *)b)->name);
}

static facet_result list_channels(const image_layer *layers, uint32_t layer_count, exr_channel *channels,
                                  facet_error *error)
{
    uint32_t count = 0;
    for (uint32_t l = 0; l < layer_count; l++)
        for (uint32_t k = 0; k < layers[l].channel_count; k++)
            channels[count++] = (exr_channel){.name = layers[l].channel_names[k],
                                              .first = (float *)(uintptr_t)(layers[l].pixels + k),
                                              .texel_stride = layers[l].channel_count * sizeof(float),
                                              .row_stride = layers[l].row_stride_bytes,
                                              .needs_float = layers[l].needs_float || layers[l].is_integer,
                                              .is_integer = layers[l].is_integer};
    qsort(channels, count, sizeof *channels, compare_names);
    for (uint32_t c = 0; c < count; c++) {
        const size_t length = strlen(channels[c].name);
        if (length == 0 || length >= EXR_NAME)
            return fail(error, FACET_ERROR_ARGUMENT,
                        "OpenEXR: a channel's name has %zu bytes; 1 to %d were expected", length,
                        EXR_NAME - 1);
        if (c > 0 && strcmp(channels[c].name, channels[c - 1].name) == 0)
            return fail(error, FACET_ERROR_ARGUMENT, "OpenEXR: two channels are named %s", channels[c].name);
    }
    return FACET_OK;
}

facet_result image_encode_exr(uint32_t width, uint32_t height, const image_layer *layers,
                              uint32_t layer_count, bool as_half, const image_encode_desc *desc,
                              unsigned char **bytes, size_t *size, facet_error *error)
{
    *bytes = NULL;
    *size = 0;
    const facet_allocator allocator = desc ? desc->allocator : (facet_allocator){0};
    const uint32_t level = desc && desc->compression ? desc->compression : 4;
    uint64_t count = 0;
    for (uint32_t l = 0; l < layer_count; l++)
        count += layers[l].channel_count;
    if (width == 0 || height == 0 || width > INT32_MAX / 2 || height > INT32_MAX / 2 || count == 0 ||
        count > INT16_MAX || width * count > INT32_MAX / (STRIP_ROWS * 8) || level > 9)
        return fail(error, FACET_ERROR_ARGUMENT,
                    "OpenEXR: %u x %u texels of %llu channels at compression %u cannot be written", width,
                    height, (unsigned long long)count, level);
    exr_channel *channels = mem_alloc(&allocator, (size_t)count, sizeof *channels);
    if (!channels)
        return fail_memory(error, "OpenEXR channels", (size_t)count * sizeof *channels);
    char message[EXR_MESSAGE] = "";
    facet_result result = list_channels(layers, layer_count, channels, error);
    if (result == FACET_OK) {
        const exr_write_desc write_desc = {.width = width,
                                           .height = height,
                                           .as_half = as_half,
                                           .is_stored = desc && desc->is_stored,
                                           .level = level,
                                           .texts = desc ? desc->texts : NULL,
                                           .text_count = desc ? desc->text_count : 0};
        result = exr_shim_write(&write_desc, channels, (uint32_t)count, &allocator, bytes, size, message);
        if (result == FACET_ERROR_MEMORY)
            fail_memory(error, "OpenEXR file", (size_t)height * width * count * (as_half ? 2 : 4));
        else if (result != FACET_OK)
            fail(error, result, "OpenEXR: %s", message);
    }
    mem_free(channels);
    return result;
}

/* ---- named channels ---- */

static facet_result check_magic(const void *bytes, size_t size, const char *name, facet_error *error)
{
    return image_codec_detect(bytes, size) == IMAGE_CODEC_EXR
               ? FACET_OK
               : fail(error, FACET_ERROR_INVALID, "%s: an OpenEXR file was expected", name);
}

static facet_result read_all(const void *bytes, size_t size, const char *name,
                             const facet_allocator *allocator, const exr_channel *named, const exr_info *info,
                             const exr_sizes *s, facet_error *error)
{
    char message[EXR_MESSAGE] = "";
    exr_reader *reader = NULL;
    if (!mem_account(allocator, (ptrdiff_t)s->library_memory))
        return fail_memory(error, "OpenEXR library", (size_t)s->library_memory);
    facet_result result = exr_shim_open(bytes, size, &reader, message);
    if (result == FACET_OK)
        result = exr_shim_read_named(reader, info, named, info->channel_count, message);
    exr_shim_close(reader);
    mem_account(allocator, -(ptrdiff_t)s->library_memory);
    return result == FACET_OK ? FACET_OK : exr_fail(error, result, name, message);
}

facet_result image_read_exr_channels(const void *bytes, size_t size, const char *name,
                                     const facet_allocator *allocator, uint32_t width, uint32_t height,
                                     const image_channel *channels, uint32_t channel_count,
                                     facet_error *error)
{
    exr_info info;
    exr_sizes s;
    TRY(check_magic(bytes, size, name, error));
    exr_channel *named = mem_alloc(allocator, channel_count, sizeof *named);
    if (!named)
        return fail_memory(error, "OpenEXR channels", channel_count * sizeof *named);
    for (uint32_t c = 0; c < channel_count; c++)
        named[c] = (exr_channel){.name = channels[c].name,
                                 .first = channels[c].first,
                                 .is_integer = channels[c].is_integer,
                                 .texel_stride = channels[c].texel_stride_bytes,
                                 .row_stride = channels[c].row_stride_bytes};
    facet_result result = exr_check(bytes, size, name, INT32_MAX, named, channel_count, &info, &s, error);
    if (result == FACET_OK && (s.data_width != width || s.data_height != height))
        result = fail(error, FACET_ERROR_INVALID, "%s: OpenEXR: the image has %u x %u texels, not %u x %u",
                      name, s.data_width, s.data_height, width, height);
    if (result == FACET_OK)
        result = read_all(bytes, size, name, allocator, named, &info, &s, error);
    mem_free(named);
    return result;
}

facet_result image_read_exr_text(const void *bytes, size_t size, const char *name, const char *text_name,
                                 char *value, size_t value_size, facet_error *error)
{
    static const exr_channel none = {0};
    char message[EXR_MESSAGE] = "";
    exr_info info;
    exr_sizes s;
    TRY(check_magic(bytes, size, name, error));
    TRY(exr_check(bytes, size, name, INT32_MAX, &none, 0, &info, &s, error));
    facet_result result = exr_shim_text(bytes, size, text_name, value, value_size, message);
    return result == FACET_OK ? FACET_OK : exr_fail(error, result, name, message);
}
