/* exr_channels.c - named channels and texts of OpenEXR files, as they are: not a picture to be shown, but numbers that
 * facet wrote and goes on with. */
#include "base/memory.h"
#include "base/result.h"
#include "image/codec.h"
#include "image/exr_check.h"

static facet_result check_magic(const void *bytes, size_t size, const char *name, facet_error *error)
{
    return image_codec_detect(bytes, size) == IMAGE_CODEC_EXR
               ? FACET_OK
               : fail(error, FACET_ERROR_INVALID, "%s: is no OpenEXR file", name);
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
    facet_result result = check_magic(bytes, size, name, error);
    if (result != FACET_OK)
        return result;
    exr_channel *named = mem_alloc(allocator, channel_count, sizeof *named);
    if (!named)
        return fail_memory(error, "OpenEXR channels", channel_count * sizeof *named);
    for (uint32_t c = 0; c < channel_count; c++)
        named[c] = (exr_channel){.name = channels[c].name,
                                 .first = channels[c].first,
                                 .texel_stride = channels[c].texel_stride_bytes,
                                 .row_stride = channels[c].row_stride_bytes};
    result = exr_check(bytes, size, name, INT32_MAX, named, channel_count, &info, &s, error);
    if (result == FACET_OK && (s.data_width != width || s.data_height != height))
        result = fail(error, FACET_ERROR_INVALID, "%s: OpenEXR: %u x %u texels are not %u x %u", name,
                      s.data_width, s.data_height, width, height);
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
    facet_result result = check_magic(bytes, size, name, error);
    if (result == FACET_OK)
        result = exr_check(bytes, size, name, INT32_MAX, &none, 0, &info, &s, error);
    if (result != FACET_OK)
        return result;
    result = exr_shim_text(bytes, size, text_name, value, value_size, message);
    return result == FACET_OK ? FACET_OK : exr_fail(error, result, name, message);
}
