/* texture_texels.c - see texture_texels.h. */
#include "legacy/texture_texels.h"

#include <math.h>
#include <string.h>

#include "base/parallel.h"
#include "base/result.h"
#include "legacy/texture_baker.h"

/* ---- decoding ---- */

static facet_result decode(const facet_scene *scene, uint32_t index, uint32_t max_reduction,
                           uint32_t thread_count, const image_row_sink *sink, struct image *out,
                           facet_error *error)
{
    const scene_image *source = &scene->images[index];
    *out = (image){0};
    const scene_address at = scene_get_address(scene, SCENE_ITEM_IMAGE, index);
    if (!source->bytes)
        return fail(error, FACET_ERROR_READ, "%s: image %u cannot be read", at.source, at.number);
    image_decode_desc desc = {.allocator = scene->allocator,
                              .thread_count = thread_count,
                              .max_size = scene->max_texture_size,
                              .max_reduction = max_reduction,
                              .sink = sink};
    return image_decode(source->bytes, source->size, source->uri ? source->uri : source->name, &desc, out,
                        error);
}

facet_result texels_decode_raw(const facet_scene *scene, uint32_t index, uint32_t max_reduction,
                               uint32_t thread_count, struct image *out, facet_error *error)
{
    return decode(scene, index, max_reduction, thread_count, NULL, out, error);
}

/* Converts to RGBA of 8 bits; takes over raw. */
static facet_result make_rgba(struct image *raw, const facet_scene *scene, uint32_t thread_count,
                              struct image *out, facet_error *error)
{
    bool is_float = raw->type == IMAGE_F16 || raw->type == IMAGE_F32;
    if (raw->type == IMAGE_U8 && raw->channel_count == 4) {
        *out = *raw;
        *raw = (image){0};
        return FACET_OK;
    }
    facet_result result = image_convert(raw, &scene->allocator, thread_count, 4, IMAGE_U8,
                                        is_float || raw->is_srgb, out, error);
    image_destroy(raw);
    return result;
}

static facet_result texels_decode(const facet_scene *scene, uint32_t index, uint32_t max_reduction,
                                  uint32_t thread_count, struct image *out, facet_error *error)
{
    image raw;
    *out = (image){0};
    TRY(texels_decode_raw(scene, index, max_reduction, thread_count, &raw, error));
    return make_rgba(&raw, scene, thread_count, out, error);
}

/* ---- another size ---- */

static uint32_t wrap_texel(int64_t i, uint32_t size, scene_wrap wrap)
{
    int64_t n = (int64_t)size;
    if (wrap == SCENE_WRAP_CLAMP)
        return (uint32_t)(i < 0 ? 0 : i >= n ? n - 1 : i);
    int64_t period = wrap == SCENE_WRAP_MIRROR ? 2 * n : n;
    i = ((i % period) + period) % period;
    return (uint32_t)(i < n ? i : period - 1 - i);
}

typedef struct resize {
    const image *in;
    const image *out;
    const scene_texture *texture;
} resize;

static void resize_rows(void *context, size_t begin, size_t end)
{
    const resize *r = context;
    const uint8_t *in = r->in->pixels;
    for (size_t y = begin; y < end; y++) {
        double v = ((double)y + 0.5) * (double)r->in->height / (double)r->out->height - 0.5;
        double y0 = floor(v);
        uint32_t rows[2] = {wrap_texel((int64_t)y0, r->in->height, r->texture->wrap_v),
                            wrap_texel((int64_t)y0 + 1, r->in->height, r->texture->wrap_v)};
        uint8_t *out = (uint8_t *)r->out->pixels + y * r->out->width * 4;
        for (uint32_t x = 0; x < r->out->width; x++) {
            double u = ((double)x + 0.5) * (double)r->in->width / (double)r->out->width - 0.5;
            double x0 = floor(u);
            uint32_t columns[2] = {wrap_texel((int64_t)x0, r->in->width, r->texture->wrap_u),
                                   wrap_texel((int64_t)x0 + 1, r->in->width, r->texture->wrap_u)};
            for (int k = 0; k < 4; k++) {
                double value[2];
                for (int j = 0; j < 2; j++) {
                    const uint8_t *row = in + (size_t)rows[j] * r->in->width * 4 + k;
                    double left = row[(size_t)columns[0] * 4];
                    double right = row[(size_t)columns[1] * 4];
                    value[j] = left + (right - left) * (u - x0);
                }
                out[(size_t)x * 4 + (size_t)k] = (uint8_t)(value[0] + (value[1] - value[0]) * (v - y0) + 0.5);
            }
        }
    }
}

facet_result texels_resize(const struct image *in, const scene_texture *texture, uint32_t width,
                           uint32_t height, uint32_t thread_count, const facet_allocator *allocator,
                           struct image *out, facet_error *error)
{
    TRY(image_create(allocator, width, height, 4, IMAGE_U8, out, error));
    resize r = {.in = in, .out = out, .texture = texture};
    parallel_for(thread_count, height, 16, resize_rows, &r);
    return FACET_OK;
}

/* ---- counting ---- */

/* RGBA texels of 8 bits. */
static void add_texels(const uint8_t *texel, size_t count, texture_statistics *out)
{
    for (size_t i = 0; i < count; i++, texel += 4) {
        for (int k = 0; k < 4; k++)
            out->histogram[k][texel[k]]++;
        out->histogram[TEXTURE_GREY][texture_grey(texel)]++;
    }
}

/* An image that is counted while decoding. */
typedef struct row_count {
    const facet_scene *scene;
    image row; /* a row of pixels */
    texture_statistics *out;
} row_count;

static facet_result begin_count(void *user, const struct image *header, facet_error *error)
{
    row_count *r = user;
    facet_result result = image_create(&r->scene->allocator, header->width, 1, header->channel_count,
                                       header->type, &r->row, error);
    r->row.is_srgb = header->is_srgb;
    return result;
}

static facet_result count_row(void *user, const void *texels, facet_error *error)
{
    row_count *r = user;
    if (r->row.type == IMAGE_U8 && r->row.channel_count == 4) {
        add_texels(texels, r->row.width, r->out);
        return FACET_OK;
    }
    image rgba;
    memcpy(r->row.pixels, texels, image_row_size(&r->row));
    facet_result result =
        image_convert(&r->row, &r->scene->allocator, 1, 4, IMAGE_U8, r->row.is_srgb, &rgba, error);
    if (result == FACET_OK)
        add_texels(rgba.pixels, rgba.width, r->out);
    image_destroy(&rgba);
    return result;
}

facet_result texels_count(const facet_scene *scene, uint32_t index, uint32_t max_reduction,
                          uint32_t thread_count, texture_statistics *out, facet_error *error)
{
    image raw, rgba = {0};
    row_count rows = {.scene = scene, .out = out};
    const image_row_sink sink = {.user = &rows, .begin = begin_count, .add_row = count_row};
    *out = (texture_statistics){0};
    facet_result result = decode(scene, index, max_reduction, thread_count, &sink, &raw, error);
    const uint32_t width = raw.width, height = raw.height;
    if (result == FACET_OK && raw.pixels) {
        result = make_rgba(&raw, scene, thread_count, &rgba, error);
        if (result == FACET_OK)
            add_texels(rgba.pixels, (size_t)width * height, out);
    }
    image_destroy(&rows.row);
    image_destroy(&rgba);
    if (result != FACET_OK) {
        *out = (texture_statistics){0};
        return result;
    }
    out->width = width;
    out->height = height;
    out->texel_count = width * height;
    out->has_alpha = out->histogram[TEXTURE_ALPHA][255] != out->texel_count;
    out->is_readable = out->texel_count > 0;
    return FACET_OK;
}

/* ---- the cache ---- */

enum { CACHE_SLOTS = 16, CACHE_PINNED = 4 };
/* Above this size only the last four images are kept. */
static const size_t CACHE_BYTES = (size_t)192 << 20;

typedef struct cached {
    uint32_t index;
    uint64_t last_use; /* 0: the slot is empty */
    image texels;
} cached;

struct texels_cache {
    const facet_scene *scene;
    uint64_t clock;
    cached slots[CACHE_SLOTS];
};

texels_cache *texels_cache_create(const facet_scene *scene)
{
    texels_cache *cache = mem_zalloc(&scene->allocator, 1, sizeof *cache);
    if (cache)
        cache->scene = scene;
    return cache;
}

void texels_cache_destroy(texels_cache *cache)
{
    if (!cache)
        return;
    for (int i = 0; i < CACHE_SLOTS; i++)
        image_destroy(&cache->slots[i].texels);
    mem_free(cache);
}

static cached *oldest(texels_cache *cache)
{
    cached *found = NULL;
    for (int i = 0; i < CACHE_SLOTS; i++) {
        cached *slot = &cache->slots[i];
        if (slot->last_use > 0 && (!found || slot->last_use < found->last_use))
            found = slot;
    }
    return found;
}

/* An empty slot, after evicting old images that are too many or too large. */
static cached *make_room(texels_cache *cache)
{
    for (;;) {
        size_t bytes = 0;
        int count = 0;
        cached *empty = NULL;
        for (int i = 0; i < CACHE_SLOTS; i++) {
            cached *slot = &cache->slots[i];
            if (slot->last_use == 0) {
                empty = slot;
            } else {
                bytes += image_row_size(&slot->texels) * slot->texels.height;
                count++;
            }
        }
        if (empty && (bytes <= CACHE_BYTES || count < CACHE_PINNED))
            return empty;
        cached *old = oldest(cache);
        image_destroy(&old->texels);
        old->last_use = 0;
    }
}

facet_result texels_cache_get(texels_cache *cache, uint32_t index, const struct image **out,
                              facet_error *error)
{
    *out = NULL;
    for (int i = 0; i < CACHE_SLOTS; i++) {
        cached *slot = &cache->slots[i];
        if (slot->last_use > 0 && slot->index == index) {
            slot->last_use = ++cache->clock;
            *out = &slot->texels;
            return FACET_OK;
        }
    }
    cached *slot = make_room(cache);
    TRY(texels_decode(cache->scene, index, 0, cache->scene->thread_count, &slot->texels, error));
    slot->index = index;
    slot->last_use = ++cache->clock;
    *out = &slot->texels;
    return FACET_OK;
}

/* ---- statistics of the counted codes ---- */

double texture_mean(const texture_statistics *s, int channel, const float values[256])
{
    double sum = 0;
    for (int i = 0; i < 256; i++)
        sum += (double)s->histogram[channel][i] * (double)values[i];
    return sum / (double)s->texel_count;
}

int texture_percentile(const texture_statistics *s, int channel, double fraction)
{
    double wanted = fraction * (double)s->texel_count;
    double sum = 0;
    for (int i = 0; i < 255; i++) {
        sum += (double)s->histogram[channel][i];
        if (sum >= wanted && sum > 0)
            return i;
    }
    return 255;
}
