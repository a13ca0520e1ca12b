/* codec_exr.c - reading OpenEXR through OpenEXRCore: it parses the header and decompresses chunks; which
 * channels make the picture and how samples become texels is decided here. Writing: exr_write.c. */
#include "image/codec.h"

#include <math.h>
#include <stdatomic.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>

#include <openexr.h>

#include "base/memory.h"
#include "base/parallel.h"
#include "base/result.h"
#include "image/half.h"
#include "image/library_memory.h"

/* The file in memory, as OpenEXRCore reads it. */
typedef struct stream {
    const unsigned char *bytes;
    size_t size;
    bool is_parsing; /* the header, on one thread: the first message is kept */
    char message[256];
} stream;

/* What is read of a file: its first part. */
typedef struct exr_header {
    uint32_t width, height;           /* of the display window: the picture */
    int64_t data_x, data_y;           /* of the data window's first texel in it */
    int32_t first_row;                /* the file's coordinate of the data window's first row */
    uint32_t data_width, data_height; /* of the data window */
    bool is_tiled;
    uint32_t tile_width, tile_height; /* chunks: tiles, or rows of the data window */
    uint32_t tiles_x, tiles_y;
    exr_compression_t compression;
    const exr_attr_chlist_t *channels;
    int sources[4]; /* the channels that make R, G, B, A */
    uint32_t channel_count;
} exr_header;

/* ---- OpenEXRCore's callbacks ---- */

static int64_t read_stream(exr_const_context_t context, void *user, void *buffer, uint64_t size,
                           uint64_t offset, exr_stream_error_func_ptr_t on_error)
{
    (void)context;
    (void)on_error;
    const stream *s = user;
    if (offset > s->size)
        return -1;
    uint64_t count = s->size - offset < size ? s->size - offset : size;
    memcpy(buffer, s->bytes + offset, count);
    return (int64_t)count;
}

static int64_t size_stream(exr_const_context_t context, void *user)
{
    (void)context;
    return (int64_t)((const stream *)user)->size;
}

/* Keeps the message without the file name that OpenEXRCore puts before it. */
static void on_message(exr_const_context_t context, exr_result_t code, const char *message)
{
    (void)code;
    void *user = NULL;
    if (!context || exr_get_user_data(context, &user) != EXR_ERR_SUCCESS || !user)
        return;
    stream *s = user;
    if (s->is_parsing && !s->message[0])
        snprintf(s->message, sizeof s->message, "%s", message);
}

/* Zeros, so that what a damaged chunk leaves out is the same in every run. */
static void *alloc_zeros(size_t size)
{
    return library_calloc(size, 1);
}

static facet_result fail_exr(facet_error *error, const char *name, exr_result_t code, const char *message)
{
    if (code == EXR_ERR_OUT_OF_MEMORY)
        return fail_memory(error, "OpenEXR decoder", 0);
    return fail(
        error, code == EXR_ERR_FEATURE_NOT_IMPLEMENTED ? FACET_ERROR_UNSUPPORTED : FACET_ERROR_INVALID,
        "%s: OpenEXR: %s", name, message && message[0] ? message : exr_get_default_error_message(code));
}

static facet_result open_context(stream *s, const char *name, exr_context_t *context, facet_error *error)
{
    exr_context_initializer_t init = EXR_DEFAULT_CONTEXT_INITIALIZER;
    init.error_handler_fn = on_message;
    init.alloc_fn = alloc_zeros;
    init.free_fn = library_free;
    init.user_data = s;
    init.read_fn = read_stream;
    init.size_fn = size_stream;
    init.flags = EXR_CONTEXT_FLAG_DISABLE_CHUNK_RECONSTRUCTION;
    s->is_parsing = true;
    exr_result_t code = exr_start_read(context, "file", &init);
    s->is_parsing = false;
    if (code != EXR_ERR_SUCCESS) {
        *context = NULL;
        return fail_exr(error, name, code, s->message);
    }
    return FACET_OK;
}

/* ---- header ---- */

/* Index of the channel named prefix (length bytes) and then suffix, whatever their case; -1: there is none. */
static int find_channel(const exr_attr_chlist_t *channels, const char *prefix, size_t length,
                        const char *suffix)
{
    for (int c = 0; c < channels->num_channels; c++) {
        const char *name = channels->entries[c].name.str;
        if (strncmp(name, prefix, length) == 0 && strlen(name) >= length &&
            strcasecmp(name + length, suffix) == 0)
            return c;
    }
    return -1;
}

/* R, G, B and perhaps A of the layer prefix. */
static bool choose_rgb(exr_header *h, const char *prefix, size_t length)
{
    static const char *const names[] = {"R", "G", "B", "A"};
    for (int c = 0; c < 4; c++)
        h->sources[c] = find_channel(h->channels, prefix, length, names[c]);
    h->channel_count = h->sources[3] >= 0 ? 4 : 3;
    return h->sources[0] >= 0 && h->sources[1] >= 0 && h->sources[2] >= 0;
}

static void choose_grey(exr_header *h, int channel)
{
    h->sources[0] = h->sources[1] = h->sources[2] = channel;
    h->sources[3] = find_channel(h->channels, "", 0, "A");
    h->channel_count = h->sources[3] >= 0 && h->sources[3] != channel ? 4 : 3;
}

/* In this order: R, G, B; Y; R, G, B of the first layer that has them; the only channel. */
static facet_result choose_channels(exr_header *h, const char *name, facet_error *error)
{
    const exr_attr_chlist_t *list = h->channels;
    int luminance = find_channel(list, "", 0, "Y");
    bool is_found = choose_rgb(h, "", 0);
    if (!is_found && luminance >= 0) {
        if (find_channel(list, "", 0, "RY") >= 0)
            return fail(error, FACET_ERROR_UNSUPPORTED,
                        "%s: OpenEXR: luminance and chroma (Y, RY, BY) are not read", name);
        choose_grey(h, luminance);
        is_found = true;
    }
    for (int c = 0; c < list->num_channels && !is_found; c++) {
        const char *channel = list->entries[c].name.str;
        const char *point = strrchr(channel, '.');
        if (point && strcasecmp(point, ".R") == 0)
            is_found = choose_rgb(h, channel, (size_t)(point + 1 - channel));
    }
    if (!is_found && list->num_channels == 1) {
        choose_grey(h, 0);
        is_found = true;
    }
    if (!is_found)
        return fail(error, FACET_ERROR_UNSUPPORTED, "%s: OpenEXR: none of %d channels is named R, G, B or Y",
                    name, list->num_channels);
    for (int c = 0; c < list->num_channels; c++) {
        const exr_attr_chlist_entry_t *entry = &list->entries[c];
        if (entry->x_sampling != 1 || entry->y_sampling != 1)
            return fail(error, FACET_ERROR_UNSUPPORTED,
                        "%s: OpenEXR: channel %s is not sampled at every texel", name, entry->name.str);
        if ((int)entry->pixel_type < 0 || entry->pixel_type >= EXR_PIXEL_LAST_TYPE)
            return fail(error, FACET_ERROR_INVALID,
                        "%s: OpenEXR: channel %s is of type %d, 0 to 2 was expected", name, entry->name.str,
                        (int)entry->pixel_type);
    }
    return FACET_OK;
}

static facet_result read_windows(exr_const_context_t context, const char *name, uint32_t max_size,
                                 exr_header *h, facet_error *error)
{
    exr_attr_box2i_t data, display;
    exr_result_t code = exr_get_data_window(context, 0, &data);
    if (code == EXR_ERR_SUCCESS)
        code = exr_get_display_window(context, 0, &display);
    if (code != EXR_ERR_SUCCESS)
        return fail_exr(error, name, code, NULL);
    int64_t size[4] = {(int64_t)display.max.x - display.min.x + 1, (int64_t)display.max.y - display.min.y + 1,
                       (int64_t)data.max.x - data.min.x + 1, (int64_t)data.max.y - data.min.y + 1};
    for (int i = 0; i < 4; i++)
        size[i] = size[i] < 0 ? 0 : size[i];
    facet_result result = codec_check_size(name, (uint64_t)size[0], (uint64_t)size[1], max_size, error);
    if (result == FACET_OK)
        result = codec_check_size(name, (uint64_t)size[2], (uint64_t)size[3], max_size, error);
    if (result != FACET_OK)
        return result;
    h->width = (uint32_t)size[0];
    h->height = (uint32_t)size[1];
    h->data_width = (uint32_t)size[2];
    h->data_height = (uint32_t)size[3];
    h->first_row = data.min.y;
    h->data_x = (int64_t)data.min.x - display.min.x;
    h->data_y = (int64_t)data.min.y - display.min.y;
    return FACET_OK;
}

static facet_result read_chunk_sizes(exr_const_context_t context, const char *name, size_t file_size,
                                     exr_header *h, facet_error *error)
{
    exr_storage_t storage;
    int32_t rows = 0;
    int32_t chunk_count = 0;
    exr_result_t code = exr_get_storage(context, 0, &storage);
    if (code == EXR_ERR_SUCCESS)
        code = exr_get_compression(context, 0, &h->compression);
    if (code == EXR_ERR_SUCCESS)
        code = exr_get_chunk_count(context, 0, &chunk_count);
    if (code == EXR_ERR_SUCCESS && storage == EXR_STORAGE_SCANLINE) {
        code = exr_get_scanlines_per_chunk(context, 0, &rows);
        h->tile_width = h->data_width;
        h->tile_height = rows > 0 ? (uint32_t)rows : 0;
    } else if (code == EXR_ERR_SUCCESS && storage == EXR_STORAGE_TILED) {
        exr_tile_level_mode_t level_mode;
        exr_tile_round_mode_t round_mode;
        h->is_tiled = true;
        code = exr_get_tile_descriptor(context, 0, &h->tile_width, &h->tile_height, &level_mode, &round_mode);
    } else if (code == EXR_ERR_SUCCESS) {
        return fail(error, FACET_ERROR_UNSUPPORTED, "%s: OpenEXR: deep pictures are not read", name);
    }
    if (code != EXR_ERR_SUCCESS)
        return fail_exr(error, name, code, NULL);
    if (h->tile_width == 0 || h->tile_height == 0 || h->tile_width > INT32_MAX || h->tile_height > INT32_MAX)
        return fail(error, FACET_ERROR_INVALID, "%s: OpenEXR: tiles of %u x %u texels", name, h->tile_width,
                    h->tile_height);
    h->tiles_x = (h->data_width - 1) / h->tile_width + 1;
    h->tiles_y = (h->data_height - 1) / h->tile_height + 1;
    uint64_t needed = (uint64_t)h->tiles_x * h->tiles_y;
    if (chunk_count < 0 || (uint64_t)chunk_count < needed || (uint64_t)chunk_count > file_size / 8)
        return fail(error, FACET_ERROR_INVALID, "%s: OpenEXR: %d chunks, %llu were expected", name,
                    chunk_count, (unsigned long long)needed);
    return FACET_OK;
}

static facet_result read_header(exr_const_context_t context, const char *name, size_t file_size,
                                uint32_t max_size, exr_header *h, facet_error *error)
{
    *h = (exr_header){0};
    facet_result result = read_windows(context, name, max_size, h, error);
    if (result == FACET_OK)
        result = read_chunk_sizes(context, name, file_size, h, error);
    if (result != FACET_OK)
        return result;
    exr_result_t code = exr_get_channels(context, 0, &h->channels);
    if (code != EXR_ERR_SUCCESS)
        return fail_exr(error, name, code, NULL);
    return choose_channels(h, name, error);
}

facet_result exr_probe(const unsigned char *bytes, size_t size, const char *name, image *header,
                       facet_error *error)
{
    stream s = {.bytes = bytes, .size = size};
    exr_context_t context;
    exr_header h;
    const facet_allocator *previous = library_memory_begin(NULL);
    facet_result result = open_context(&s, name, &context, error);
    if (result == FACET_OK) {
        result = read_header(context, name, size, INT32_MAX, &h, error);
        exr_finish(&context);
    }
    library_memory_end(previous);
    if (result == FACET_OK)
        *header = (image){
            .width = h.width, .height = h.height, .channel_count = h.channel_count, .type = IMAGE_F32};
    return result;
}

/* ---- chunks ---- */

typedef struct reading {
    const exr_header *header;
    exr_const_context_t context;
    size_t file_size;
    const facet_allocator *allocator;
    image *image;
    _Atomic uint64_t failure; /* chunk << 32 | code of the first chunk that failed; UINT64_MAX: none */
} reading;

static size_t sample_size(const exr_attr_chlist_entry_t *channel)
{
    return channel->pixel_type == EXR_PIXEL_HALF ? 2 : 4;
}

/* One channel of a row to floats, stride apart. Infinity becomes the largest number of the channel's type. */
static void convert_samples(const unsigned char *from, int pixel_type, size_t count, float *to, size_t stride)
{
    if (pixel_type == EXR_PIXEL_HALF) {
        for (size_t x = 0; x < count; x++) {
            uint16_t half = (uint16_t)(from[2 * x] | from[2 * x + 1] << 8);
            float value = half_to_float(half);
            value = value >= -65504.0f ? value : 0.0f; /* NaN too */
            to[x * stride] = value <= 65504.0f ? value : 65504.0f;
        }
    } else if (pixel_type == EXR_PIXEL_FLOAT) {
        for (size_t x = 0; x < count; x++)
            to[x * stride] = codec_finite(float_from_bits(load_u32_le(from + 4 * x)));
    } else {
        for (size_t x = 0; x < count; x++)
            to[x * stride] = (float)load_u32_le(from + 4 * x);
    }
}

/* Chunk number index: its texels in the data window. */
static void locate_chunk(const exr_header *h, size_t index, uint32_t *x, uint32_t *y, uint32_t *width,
                         uint32_t *height)
{
    *x = (uint32_t)(index % h->tiles_x) * h->tile_width;
    *y = (uint32_t)(index / h->tiles_x) * h->tile_height;
    *width = h->data_width - *x < h->tile_width ? h->data_width - *x : h->tile_width;
    *height = h->data_height - *y < h->tile_height ? h->data_height - *y : h->tile_height;
}

static size_t texel_size(const exr_header *h)
{
    size_t size = 0;
    for (int c = 0; c < h->channels->num_channels; c++)
        size += sample_size(&h->channels->entries[c]);
    return size;
}

/* The frame of chunk number index, checked against what the header makes it. */
static exr_result_t read_chunk_info(const exr_header *h, exr_const_context_t context, size_t file_size,
                                    size_t index, exr_chunk_info_t *info)
{
    uint32_t x, y, width, height;
    locate_chunk(h, index, &x, &y, &width, &height);
    exr_result_t code =
        h->is_tiled ? exr_read_tile_chunk_info(context, 0, (int)(index % h->tiles_x),
                                               (int)(index / h->tiles_x), 0, 0, info)
                    : exr_read_scanline_chunk_info(context, 0, (int)(h->first_row + (int64_t)y), info);
    if (code != EXR_ERR_SUCCESS)
        return code;
    bool is_right = (uint32_t)info->width == width && (uint32_t)info->height == height &&
                    info->unpacked_size == (uint64_t)width * height * texel_size(h) &&
                    info->packed_size <= file_size && info->packed_size <= info->unpacked_size;
    return is_right ? EXR_ERR_SUCCESS : EXR_ERR_BAD_CHUNK_LEADER;
}

/* The rows of a chunk that are inside the display window, as texels. samples: row by row, in it channel by
 * channel, as the file has them. */
static void convert_chunk(reading *r, size_t index, const unsigned char *samples)
{
    const exr_header *h = r->header;
    uint32_t x, y, width, height;
    locate_chunk(h, index, &x, &y, &width, &height);
    int64_t out_x = h->data_x + x;
    int64_t skipped = out_x < 0 ? -out_x : 0; /* columns before the display window */
    int64_t column_end = (int64_t)h->width - out_x < width ? (int64_t)h->width - out_x : width;
    if (skipped >= column_end)
        return;
    for (uint32_t row = 0; row < height; row++) {
        int64_t out_y = h->data_y + y + row;
        if (out_y < 0 || out_y >= h->height)
            continue;
        const unsigned char *row_samples = samples + (size_t)row * width * texel_size(h);
        float *texel = (float *)r->image->pixels +
                       ((size_t)out_y * h->width + (size_t)(out_x + skipped)) * h->channel_count;
        for (uint32_t c = 0; c < h->channel_count; c++) {
            const unsigned char *from = row_samples;
            for (int before = 0; before < h->sources[c]; before++)
                from += width * sample_size(&h->channels->entries[before]);
            const exr_attr_chlist_entry_t *entry = &h->channels->entries[h->sources[c]];
            convert_samples(from + (size_t)skipped * sample_size(entry), (int)entry->pixel_type,
                            (size_t)(column_end - skipped), texel + c, h->channel_count);
        }
    }
}

static exr_result_t decode_chunk(reading *r, size_t index)
{
    exr_chunk_info_t info;
    exr_decode_pipeline_t pipeline = EXR_DECODE_PIPELINE_INITIALIZER;
    exr_result_t code = read_chunk_info(r->header, r->context, r->file_size, index, &info);
    if (code == EXR_ERR_SUCCESS)
        code = exr_decoding_initialize(r->context, 0, &info, &pipeline);
    if (code != EXR_ERR_SUCCESS)
        return code;
    code = exr_decoding_choose_default_routines(r->context, 0, &pipeline);
    pipeline.unpack_and_convert_fn = NULL; /* convert_chunk() does it */
    if (code == EXR_ERR_SUCCESS)
        code = exr_decoding_run(r->context, 0, &pipeline);
    if (code == EXR_ERR_SUCCESS && !pipeline.unpacked_buffer)
        code = EXR_ERR_CORRUPT_CHUNK;
    if (code == EXR_ERR_SUCCESS)
        convert_chunk(r, index, pipeline.unpacked_buffer);
    exr_decoding_destroy(r->context, &pipeline);
    return code;
}

static void decode_chunks(void *context, size_t begin, size_t end)
{
    reading *r = context;
    const facet_allocator *previous = library_memory_begin(r->allocator);
    for (size_t index = begin; index < end; index++) {
        exr_result_t code = decode_chunk(r, index);
        if (code == EXR_ERR_SUCCESS)
            continue;
        uint64_t failure = (uint64_t)index << 32 | (uint32_t)code;
        uint64_t first = atomic_load(&r->failure);
        while (failure < first && !atomic_compare_exchange_weak(&r->failure, &first, failure))
            ;
    }
    library_memory_end(previous);
}

/* Looks at all chunk frames before memory is taken for the picture: each has to be there, and together they
 * have to be large enough for it; deflate, the densest of the codings but DWA, makes at most 1032 bytes of one. */
static facet_result check_chunks(const exr_header *h, exr_const_context_t context, const char *name,
                                 size_t file_size, facet_error *error)
{
    uint64_t packed = 0;
    uint64_t unpacked = 0;
    const size_t count = (size_t)h->tiles_x * h->tiles_y;
    for (size_t index = 0; index < count; index++) {
        exr_chunk_info_t info;
        exr_result_t code = read_chunk_info(h, context, file_size, index, &info);
        if (code != EXR_ERR_SUCCESS)
            return fail(error, code == EXR_ERR_OUT_OF_MEMORY ? FACET_ERROR_MEMORY : FACET_ERROR_INVALID,
                        "%s: OpenEXR: chunk %zu of %zu: %s", name, index, count,
                        exr_get_default_error_message(code));
        packed += info.packed_size;
        unpacked += info.unpacked_size;
    }
    bool is_dwa = h->compression == EXR_COMPRESSION_DWAA || h->compression == EXR_COMPRESSION_DWAB;
    if (packed > file_size || (!is_dwa && unpacked / 1032 > packed))
        return fail(error, FACET_ERROR_INVALID, "%s: OpenEXR: %llu bytes in chunks cannot be %llu of samples",
                    name, (unsigned long long)packed, (unsigned long long)unpacked);
    return FACET_OK;
}

static facet_result decode(exr_const_context_t context, size_t size, const char *name,
                           const image_decode_desc *desc, image *out, facet_error *error)
{
    exr_header h;
    facet_result result = read_header(context, name, size, desc->max_size, &h, error);
    if (result == FACET_OK)
        result = check_chunks(&h, context, name, size, error);
    if (result == FACET_OK)
        result = image_create(&desc->allocator, h.width, h.height, h.channel_count, IMAGE_F32, out, error);
    if (result != FACET_OK)
        return result;
    if (h.data_x > 0 || h.data_y > 0 || h.data_x + h.data_width < h.width ||
        h.data_y + h.data_height < h.height)
        memset(out->pixels, 0, image_row_size(out) * out->height); /* outside the data window: nothing */
    reading r = {
        .header = &h, .context = context, .file_size = size, .allocator = &desc->allocator, .image = out};
    atomic_init(&r.failure, UINT64_MAX);
    const size_t count = (size_t)h.tiles_x * h.tiles_y;
    size_t texels = (size_t)h.tile_width * h.tile_height;
    parallel_for(desc->thread_count, count, texels < 16384 ? 16384 / texels : 1, decode_chunks, &r);
    uint64_t failure = atomic_load(&r.failure);
    if (failure == UINT64_MAX)
        return FACET_OK;
    exr_result_t code = (exr_result_t)(failure & UINT32_MAX);
    if (code == EXR_ERR_OUT_OF_MEMORY)
        return fail_exr(error, name, code, NULL);
    return fail(error, FACET_ERROR_INVALID, "%s: OpenEXR: chunk %llu of %zu: %s", name,
                (unsigned long long)(failure >> 32), count, exr_get_default_error_message(code));
}

facet_result exr_decode(const unsigned char *bytes, size_t size, const char *name,
                        const image_decode_desc *desc, image *out, facet_error *error)
{
    stream s = {.bytes = bytes, .size = size};
    exr_context_t context;
    image made = {0};
    const facet_allocator *previous = library_memory_begin(&desc->allocator);
    facet_result result = open_context(&s, name, &context, error);
    if (result == FACET_OK) {
        result = decode(context, size, name, desc, &made, error);
        exr_finish(&context);
    }
    library_memory_end(previous);
    if (result == FACET_OK)
        *out = made;
    else
        image_destroy(&made);
    return result;
}
