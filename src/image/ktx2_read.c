/* ktx2_read.c - see ktx2.h: decodes the bytes of a level: supercompression, blocks or texels row by row in
 * parallel, swizzle. */
#include "image/ktx2.h"

#include <float.h>
#include <stdatomic.h>
#include <zlib.h>

#include "base/memory.h"
#include "base/parallel.h"
#include "base/result.h"
#ifdef HAVE_ASTC
#include "image/astc_shim.h"
#endif
#include "image/basis_etc1s.h"
#include "image/codec.h"

/* ---- ASTC ---- */

/* Decodes size bytes of blocks of k->format into out, RGBA U8 of its size. The memory of the library comes
 * from malloc. FACET_ERROR_MEMORY; _UNSUPPORTED where this build has no libastcenc. */
#ifdef HAVE_ASTC

enum { THREAD_TEXELS = 65536 }; /* fewer are not worth another thread */

/* Shared by the threads; the library distributes the blocks. */
typedef struct astc_job {
    astc_shim *shim;
    const unsigned char *bytes;
    size_t size;
    image *out;
    atomic_int failure; /* 0: none yet */
} astc_job;

static void run_threads(void *context, size_t begin, size_t end)
{
    astc_job *j = context;
    for (size_t thread = begin; thread < end; thread++) {
        int failure = astc_shim_decode(j->shim, j->bytes, j->size, j->out->width, j->out->height,
                                       j->out->pixels, (unsigned)thread);
        if (failure)
            atomic_store(&j->failure, failure);
    }
}

static facet_result decode_astc_blocks(const ktx2 *k, const unsigned char *bytes, size_t size,
                                       uint32_t thread_count, image *out, facet_error *error)
{
    const ktx2_format *f = k->format;
    const size_t useful = 1 + (size_t)out->width * out->height / THREAD_TEXELS;
    const uint32_t threads = thread_count == 0 ? 1 : thread_count < useful ? thread_count : (uint32_t)useful;
    astc_job j = {.bytes = bytes, .size = size, .out = out};
    int failure = astc_shim_create(f->block_width, f->block_height, k->is_srgb, threads, &j.shim);
    if (!failure) {
        parallel_for(threads, threads, 1, run_threads, &j);
        failure = atomic_load(&j.failure);
    }
    astc_shim_destroy(j.shim);
    if (failure == ASTC_SHIM_MEMORY)
        return fail_memory(error, "ASTC decoder", 0);
    if (failure)
        return fail(error, FACET_ERROR_SYSTEM, "%s: KTX2: libastcenc does not decode %s here", k->name,
                    f->name);
    return FACET_OK;
}

#else

static facet_result decode_astc_blocks(const ktx2 *k, const unsigned char *bytes, size_t size,
                                       uint32_t thread_count, image *out, facet_error *error)
{
    (void)bytes, (void)size, (void)thread_count, (void)out;
    return fail(error, FACET_ERROR_UNSUPPORTED, "%s: KTX2: this build of facet does not read %s", k->name,
                k->format->name); /* refused by ktx2_open() */
}

#endif

/* ---- supercompression ---- */

static facet_result inflate_zlib(const unsigned char *in, size_t in_size, unsigned char *out, size_t out_size)
{
    uLongf made = (uLongf)out_size;
    return in_size <= ULONG_MAX && out_size <= ULONG_MAX &&
                   uncompress(out, &made, in, (uLong)in_size) == Z_OK && made == out_size
               ? FACET_OK
               : FACET_ERROR_INVALID;
}

/* Bytes of one image of a level. */
static size_t get_image_size(const ktx2 *k, uint32_t level)
{
    const ktx2_format *f = k->format;
    const size_t columns = ((size_t)ktx2_level_edge(k->width, level) + f->block_width - 1) / f->block_width;
    const size_t rows = ((size_t)ktx2_level_edge(k->height, level) + f->block_height - 1) / f->block_height;
    return columns * rows * f->block_size; /* checked by ktx2_open() */
}

facet_result ktx2_load_level(const ktx2 *k, uint32_t level, const facet_allocator *allocator, ktx2_data *out,
                             facet_error *error)
{
    *out = (ktx2_data){.bytes = k->levels[level].bytes, .size = k->levels[level].size};
    if (k->scheme == KTX2_NONE || k->scheme == KTX2_BASISLZ)
        return FACET_OK;
    const size_t size = get_image_size(k, level) * k->face_count * k->layer_count;
    unsigned char *block = mem_alloc(allocator, size, 1);
    if (!block) {
        *out = (ktx2_data){0};
        return fail_memory(error, "KTX2 level", size);
    }
    char reason[KTX2_REASON] = "the compressed data is damaged";
    const facet_result result = k->scheme == KTX2_ZLIB
                                    ? inflate_zlib(out->bytes, out->size, block, size)
                                    : ktx2_inflate_zstd(out->bytes, out->size, block, size, reason);
    if (result != FACET_OK) {
        mem_free(block);
        *out = (ktx2_data){0};
        return fail(error, result, "%s: KTX2: level %u: %s", k->name, level, reason);
    }
    *out = (ktx2_data){.bytes = block, .size = size, .block = block};
    return FACET_OK;
}

void ktx2_data_destroy(ktx2_data *d)
{
    mem_free(d->block);
    *d = (ktx2_data){0};
}

/* ---- channels ---- */

/* Sources of RGBA: indices of decoded channels; 4: 0, 5: 1. Transcoders put the second channel of red-green
 * textures into alpha, and toktx writes the swizzle "ra01" for them: there a is that channel and not the
 * constant 1 of formats without alpha. */
static void compose_channels(const ktx2 *k, unsigned char from[4])
{
    static const char letters[] = "rgba01";
    const bool is_green_in_alpha = k->format->from[1] == 3;
    for (int c = 0; c < 4; c++) {
        const unsigned source = (unsigned)(strchr(letters, k->swizzle[c]) - letters);
        const bool is_kept = source >= 4 || (source == 3 && is_green_in_alpha);
        from[c] = (unsigned char)(is_kept ? source : k->format->from[source]);
    }
}

image ktx2_header(const ktx2 *k)
{
    image header = {.width = k->width,
                    .height = k->height,
                    .channel_count = k->format->channel_count,
                    .type = k->format->type,
                    .is_srgb = k->is_srgb};
    unsigned char from[4];
    compose_channels(k, from);
    if (memcmp(k->swizzle, "rgba", 4) == 0)
        return header;
    const bool has_alpha = from[3] < 3 || from[3] == 4 || (from[3] == 3 && k->format->channel_count == 4);
    const bool is_grey = !has_alpha && from[0] == from[1] && from[0] == from[2];
    header.channel_count = has_alpha ? 4 : is_grey ? 1 : 3;
    return header;
}

/* How decoded RGBA is stored. */
typedef struct store {
    image_type type;
    uint32_t channel_count;
    unsigned char from[4];
    bool is_identity; /* RGBA unchanged */
} store;

static store make_store(const ktx2 *k, const image *out)
{
    store s = {.type = out->type, .channel_count = out->channel_count};
    compose_channels(k, s.from);
    static const unsigned char identity[4] = {0, 1, 2, 3};
    s.is_identity = memcmp(s.from, identity, 4) == 0;
    return s;
}

static void store_u8(const store *s, const unsigned char *rgba, size_t count, unsigned char *to)
{
    if (s->is_identity && s->channel_count == 4) {
        memcpy(to, rgba, 4 * count);
        return;
    }
    if (s->is_identity && s->channel_count == 3) {
        for (size_t i = 0; i < count; i++, rgba += 4, to += 3) {
            to[0] = rgba[0];
            to[1] = rgba[1];
            to[2] = rgba[2];
        }
        return;
    }
    for (size_t i = 0; i < count; i++, rgba += 4)
        for (uint32_t c = 0; c < s->channel_count; c++)
            *to++ = s->from[c] < 4 ? rgba[s->from[c]] : s->from[c] == 4 ? 0 : 255;
}

static void store_u16(const store *s, const uint16_t *rgba, size_t count, uint16_t *to)
{
    const uint16_t one = s->type == IMAGE_F16 ? 0x3c00 : 65535;
    for (size_t i = 0; i < count; i++, rgba += 4)
        for (uint32_t c = 0; c < s->channel_count; c++)
            *to++ = s->from[c] < 4 ? rgba[s->from[c]] : s->from[c] == 4 ? 0 : one;
}

static void store_f32(const store *s, const float *rgba, size_t count, float *to)
{
    for (size_t i = 0; i < count; i++, rgba += 4)
        for (uint32_t c = 0; c < s->channel_count; c++)
            *to++ = s->from[c] < 4 ? rgba[s->from[c]] : s->from[c] == 4 ? 0.0f : 1.0f;
}

static void store_texels(const store *s, const void *rgba, size_t count, void *to)
{
    if (s->type == IMAGE_U8)
        store_u8(s, rgba, count, to);
    else if (s->type == IMAGE_F32)
        store_f32(s, rgba, count, to);
    else
        store_u16(s, rgba, count, to);
}

/* ---- rows ---- */

enum { CHUNK_TEXELS = 256, GRAIN_TEXELS = 16384 };

/* An image being decoded; a row is one of texels or of blocks. */
typedef struct job {
    const ktx2_format *format;
    const unsigned char *bytes;
    texel_unpack *unpack;
    block_decode *decode;
    store store;
    image *out;
    const etc1s_codebook *codebook;
    const etc1s_block *color, *alpha; /* ETC1S; alpha NULL: none */
} job;

static unsigned char *get_texel(const image *i, uint32_t x, uint32_t y)
{
    return (unsigned char *)i->pixels + ((size_t)y * i->width + x) * image_texel_size(i);
}

static void unpack_rows(void *context, size_t begin, size_t end)
{
    const job *j = context;
    const uint32_t width = j->out->width;
    const unsigned count_in = j->format->component_count;
    float rgba[4 * CHUNK_TEXELS]; /* the largest type */
    if (j->store.is_identity && j->out->channel_count == 4) {
        j->unpack(j->bytes + begin * width * j->format->block_size, (end - begin) * width, count_in,
                  get_texel(j->out, 0, (uint32_t)begin));
        return;
    }
    for (size_t y = begin; y < end; y++)
        for (uint32_t x = 0; x < width; x += CHUNK_TEXELS) {
            const size_t count = width - x < CHUNK_TEXELS ? width - x : CHUNK_TEXELS;
            j->unpack(j->bytes + (y * width + x) * j->format->block_size, count, count_in, rgba);
            store_texels(&j->store, rgba, count, get_texel(j->out, x, (uint32_t)y));
        }
}

/* Stores the part of a tile that is inside of the image. */
static void store_tile(const job *j, const void *tile, uint32_t x, uint32_t y)
{
    const image *out = j->out;
    const size_t row_size = TILE_EDGE * TILE_CHANNELS * image_type_size(out->type);
    const uint32_t columns = out->width - x < TILE_EDGE ? out->width - x : TILE_EDGE;
    const uint32_t rows = out->height - y < TILE_EDGE ? out->height - y : TILE_EDGE;
    for (uint32_t row = 0; row < rows; row++)
        store_texels(&j->store, (const unsigned char *)tile + row * row_size, columns,
                     get_texel(out, x, y + row));
}

static void decode_rows(void *context, size_t begin, size_t end)
{
    const job *j = context;
    const size_t columns = ((size_t)j->out->width + TILE_EDGE - 1) / TILE_EDGE;
    float tile[TILE_TEXELS * TILE_CHANNELS]; /* the largest type */
    for (size_t row = begin; row < end; row++)
        for (size_t column = 0; column < columns; column++) {
            const size_t block = row * columns + column;
            if (j->codebook) {
                etc1s_decode_color(j->codebook, j->color[block], (unsigned char *)tile);
                if (j->alpha)
                    etc1s_decode_alpha(j->codebook, j->alpha[block], (unsigned char *)tile);
            } else {
                j->decode(j->bytes + block * j->format->block_size, tile);
            }
            store_tile(j, tile, (uint32_t)column * TILE_EDGE, (uint32_t)row * TILE_EDGE);
        }
}

/* Processes rows in parallel, in groups large enough for a thread. */
static void run_rows(job *j, uint32_t thread_count, void (*body)(void *, size_t, size_t), uint32_t row_height)
{
    const size_t row_texels = (size_t)j->out->width * row_height;
    const size_t rows = ((size_t)j->out->height + row_height - 1) / row_height;
    parallel_for(thread_count, rows, 1 + GRAIN_TEXELS / row_texels, body, j);
}

/* ---- ETC1S ---- */

/* The two slices of an image. */
typedef struct slices {
    const ktx2 *k;
    const etc1s_codebook *codebook;
    const facet_allocator *allocator;
    uint32_t columns, rows;
    struct {
        const unsigned char *bytes;
        size_t size;
        etc1s_block *blocks;
        facet_result result;
        facet_error error;
    } parts[2];
} slices;

static void decode_slices(void *context, size_t begin, size_t end)
{
    slices *s = context;
    for (size_t i = begin; i < end; i++)
        s->parts[i].result =
            etc1s_decode_slice(s->codebook, s->parts[i].bytes, s->parts[i].size, s->columns, s->rows,
                               s->k->name, s->allocator, s->parts[i].blocks, &s->parts[i].error);
}

/* Reads the record of an image and checks that its slices are inside of the level. */
static facet_result find_slices(const ktx2 *k, const ktx2_data *data, uint64_t index, etc1s_image *out,
                                facet_error *error)
{
    const uint64_t image_count = (uint64_t)k->level_count * k->layer_count * k->face_count;
    TRY(etc1s_read_image(k->global, k->global_size, image_count, index, k->name, out, error));
    if (out->flags & ETC1S_P_FRAME)
        return fail(error, FACET_ERROR_UNSUPPORTED, "%s: KTX2: P frames of texture videos are not read",
                    k->name);
    const bool has_alpha = out->alpha_size > 0;
    const bool wants_alpha = k->format->channel_count == 4 || k->format->from[1] == 3;
    if (out->color_size == 0 || (uint64_t)out->color_offset + out->color_size > data->size ||
        (uint64_t)out->alpha_offset + out->alpha_size > data->size || (wants_alpha && !has_alpha))
        return fail(error, FACET_ERROR_INVALID,
                    "%s: KTX2: BasisLZ global data: a slice is missing or outside of its level", k->name);
    if (!wants_alpha)
        out->alpha_size = 0;
    return FACET_OK;
}

static facet_result decode_etc1s(const ktx2 *k, const ktx2_data *data, uint64_t index,
                                 const image_decode_desc *desc, job *j, facet_error *error)
{
    const uint64_t image_count = (uint64_t)k->level_count * k->layer_count * k->face_count;
    etc1s_image record;
    etc1s_codebook codebook;
    facet_result result = find_slices(k, data, index, &record, error);
    if (result == FACET_OK)
        result = etc1s_codebook_create(k->global, k->global_size, image_count, k->name, &desc->allocator,
                                       &codebook, error);
    if (result != FACET_OK)
        return result;
    slices s = {.k = k,
                .codebook = &codebook,
                .allocator = &desc->allocator,
                .columns = (j->out->width + TILE_EDGE - 1) / TILE_EDGE,
                .rows = (j->out->height + TILE_EDGE - 1) / TILE_EDGE,
                .parts = {{data->bytes + record.color_offset, record.color_size, NULL, FACET_OK, {0}},
                          {data->bytes + record.alpha_offset, record.alpha_size, NULL, FACET_OK, {0}}}};
    const size_t count = record.alpha_size ? 2 : 1;
    for (size_t i = 0; i < count && result == FACET_OK; i++) {
        s.parts[i].blocks =
            mem_alloc(&desc->allocator, (size_t)s.columns * s.rows, sizeof *s.parts[i].blocks);
        if (!s.parts[i].blocks)
            result =
                fail_memory(error, "ETC1S blocks", (size_t)s.columns * s.rows * sizeof *s.parts[i].blocks);
    }
    if (result == FACET_OK)
        parallel_for(desc->thread_count, count, 1, decode_slices, &s);
    for (size_t i = 0; i < count && result == FACET_OK; i++) {
        result = s.parts[i].result;
        if (result != FACET_OK && error)
            *error = s.parts[i].error;
    }
    if (result == FACET_OK) {
        j->codebook = &codebook;
        j->color = s.parts[0].blocks;
        j->alpha = s.parts[1].blocks;
        run_rows(j, desc->thread_count, decode_rows, TILE_EDGE);
    }
    mem_free(s.parts[0].blocks);
    mem_free(s.parts[1].blocks);
    etc1s_codebook_destroy(&codebook);
    return result;
}

/* ---- ASTC ---- */

/* Swizzles an image that was decoded as RGBA8. */
static void store_rows(void *context, size_t begin, size_t end)
{
    const job *j = context;
    for (size_t y = begin; y < end; y++)
        store_texels(&j->store, j->bytes + y * j->out->width * 4, j->out->width,
                     get_texel(j->out, 0, (uint32_t)y));
}

static facet_result decode_astc(const ktx2 *k, const unsigned char *bytes, size_t size,
                                const image_decode_desc *desc, job *j, facet_error *error)
{
    image rgba = {0};
    const bool is_direct = j->store.is_identity && j->out->channel_count == 4;
    image *to = is_direct ? j->out : &rgba;
    facet_result result = FACET_OK;
    if (!is_direct)
        result = image_create(&desc->allocator, j->out->width, j->out->height, 4, IMAGE_U8, &rgba, error);
    if (result == FACET_OK)
        result = decode_astc_blocks(k, bytes, size, desc->thread_count, to, error);
    if (result == FACET_OK && !is_direct) {
        j->bytes = rgba.pixels;
        run_rows(j, desc->thread_count, store_rows, 1);
    }
    image_destroy(&rgba);
    return result;
}

/* ---- images ---- */

facet_result ktx2_decode(const ktx2 *k, const ktx2_data *data, uint32_t level, uint32_t layer, uint32_t face,
                         const image_decode_desc *desc, image *out, facet_error *error)
{
    *out = (image){0};
    const ktx2_format *f = k->format;
    const uint32_t width = ktx2_level_edge(k->width, level), height = ktx2_level_edge(k->height, level);
    image made = ktx2_header(k);
    facet_result result =
        codec_check_size(k->name, width, height, desc->max_size ? desc->max_size : CODEC_MAX_SIZE, error);
    if (result == FACET_OK)
        result = image_create(&desc->allocator, width, height,
                              desc->channel_count && f->type == IMAGE_U8 ? desc->channel_count
                                                                         : made.channel_count,
                              f->type, &made, error);
    if (result != FACET_OK)
        return result;
    made.is_srgb = k->is_srgb;
    if (desc->largest)
        *desc->largest = f->type == IMAGE_F16 ? 65504.0f : FLT_MAX;
    const uint64_t index = (uint64_t)layer * k->face_count + face;
    const size_t size = get_image_size(k, level);
    job j = {.format = f, .store = make_store(k, &made), .out = &made};
    if (f->kind == KTX2_ETC1S) {
        const uint64_t per_level = (uint64_t)k->layer_count * k->face_count;
        result = decode_etc1s(k, data, level * per_level + index, desc, &j, error);
    } else if (f->kind == KTX2_ASTC) {
        result = decode_astc(k, data->bytes + (size_t)index * size, size, desc, &j, error);
    } else {
        const bool is_blocks = f->kind == KTX2_BLOCKS;
        j.bytes = data->bytes + (size_t)index * size;
        j.unpack = desc->keeps_nonfinite ? unpack_nonfinite(f->unpack) : f->unpack;
        j.decode = k->is_srgb && f->decode_srgb ? f->decode_srgb : f->decode;
        run_rows(&j, desc->thread_count, is_blocks ? decode_rows : unpack_rows, is_blocks ? TILE_EDGE : 1);
    }
    if (result != FACET_OK) {
        image_destroy(&made);
        return result;
    }
    codec_flip(&made, k->is_right_to_left,
               k->is_bottom_up); /* from the file's orientation to top left first */
    *out = made;
    return FACET_OK;
}

facet_result ktx2_read(const ktx2 *k, uint32_t level, uint32_t layer, uint32_t face,
                       const image_decode_desc *desc, image *out, facet_error *error)
{
    ktx2_data data;
    *out = (image){0};
    TRY(codec_check_size(k->name, ktx2_level_edge(k->width, level), ktx2_level_edge(k->height, level),
                         desc->max_size ? desc->max_size : CODEC_MAX_SIZE, error));
    TRY(ktx2_load_level(k, level, &desc->allocator, &data, error));
    facet_result result = ktx2_decode(k, &data, level, layer, face, desc, out, error);
    ktx2_data_destroy(&data);
    return result;
}
