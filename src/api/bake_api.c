/* bake_api.c - baked cube maps and tables as images. */
#include "api/api.h"

#include "bake/bake.h"
#include "base/memory.h"
#include "base/result.h"
#include "ibl/cube_layout.h"
#include "image/image.h"
#include "report/report.h"

static const facet_allocator default_allocator;

/* Converts texels of 1 to 4 floats to a facet_image and releases them. */
static facet_result give(image *texels, const facet_allocator *allocator, facet_image **out,
                         facet_error *error)
{
    image rgba = {0};
    facet_result result = FACET_OK;
    if (texels->channel_count != 4) {
        result = image_create(allocator, texels->width, texels->height, 4, IMAGE_F32, &rgba, error);
        const float *from = texels->pixels;
        float *to = rgba.pixels;
        uint32_t channels = texels->channel_count;
        for (size_t i = 0; result == FACET_OK && i < (size_t)texels->width * texels->height; i++)
            for (uint32_t c = 0; c < 4; c++)
                to[4 * i + c] = c < channels ? from[channels * i + c] : c == 3 ? 1.0f : 0.0f;
    }
    const image *source = rgba.pixels ? &rgba : texels;
    const facet_image_view view = {
        .width = source->width, .height = source->height, .channel_count = 4, .pixels = source->pixels};
    if (result == FACET_OK)
        result = facet_image_create(&view, allocator, out, error);
    image_destroy(&rgba);
    image_destroy(texels);
    return result;
}

static facet_result check_level(const facet_cube *c, uint32_t level, facet_error *error)
{
    if (level < c->level_count)
        return FACET_OK;
    return fail(error, FACET_ERROR_ARGUMENT, "cube map: there is no level %u; it has %u, counted from 0",
                level, c->level_count);
}

facet_result facet_cube_unfold(const facet_cube *c, uint32_t level, facet_layout layout, uint32_t height,
                               const facet_allocator *allocator, facet_image **out, facet_error *error)
{
    *out = NULL;
    allocator = allocator ? allocator : &default_allocator;
    TRY(check_level(c, level, error));
    image texels = {0};
    facet_result result =
        layout_write(&c->levels[level], layout, height, allocator, facet_thread_count(), &texels, error);
    return result == FACET_OK ? give(&texels, allocator, out, error) : result;
}

facet_result facet_cube_copy_face(const facet_cube *c, uint32_t level, uint32_t face,
                                  const facet_allocator *allocator, facet_image **out, facet_error *error)
{
    *out = NULL;
    allocator = allocator ? allocator : &default_allocator;
    TRY(check_level(c, level, error));
    if (face >= 6)
        return fail(error, FACET_ERROR_ARGUMENT, "cube map: there is no face %u; it has 6, counted from 0",
                    face);
    uint32_t size = c->levels[level].size;
    image texels = {0};
    facet_result result = image_create(allocator, size, size, 4, IMAGE_F32, &texels, error);
    if (result != FACET_OK)
        return result;
    rgbx *to = texels.pixels;
    for (uint32_t y = 0; y < size; y++)
        for (uint32_t x = 0; x < size; x++) {
            rgbx texel = *cube_texel(&c->levels[level], face, (int)x, (int)y);
            texel[3] = 1.0f;
            to[(size_t)y * size + x] = texel;
        }
    return give(&texels, allocator, out, error);
}

facet_result facet_dfg_bake(const facet_dfg_desc *desc, facet_image **out, facet_error *error)
{
    static const facet_dfg_desc defaults;
    *out = NULL;
    desc = desc ? desc : &defaults;
    image table = {0};
    facet_result result = bake_dfg(desc, &table, error);
    return result == FACET_OK ? give(&table, &desc->allocator, out, error) : result;
}

facet_result facet_image_encode_ktx2(const facet_image *source, const facet_ktx2_desc *desc,
                                     unsigned char **bytes, size_t *size, facet_error *error)
{
    const film *f = &source->film;
    const image rgba = {.pixels = f->layers[0].pixels,
                        .width = f->width,
                        .height = f->height,
                        .channel_count = 4,
                        .type = IMAGE_F32};
    return bake_image_ktx2(&rgba, desc, bytes, size, error);
}

facet_result facet_image_encode_rgbm(const facet_image *source, float range,
                                     const facet_image_save_desc *desc, unsigned char **bytes, size_t *size,
                                     facet_error *error)
{
    static const facet_image_save_desc default_save_desc;
    desc = desc ? desc : &default_save_desc;
    *bytes = NULL;
    *size = 0;
    if (!(range > 0.0f && range <= 0x1.fffffep127f))
        return fail(error, FACET_ERROR_ARGUMENT, "RGBM: a range above 0 was expected, not %g", (double)range);
    const film *f = &source->film;
    const image rgba = {.pixels = f->layers[0].pixels,
                        .width = f->width,
                        .height = f->height,
                        .channel_count = f->layers[0].channel_count,
                        .type = IMAGE_F32};
    const uint32_t thread_count = desc->thread_count ? desc->thread_count : facet_thread_count();
    image packed = {0};
    facet_result result = rgbm_encode(&rgba, range, &desc->allocator, thread_count, &packed, error);
    if (result == FACET_OK)
        result = image_encode(&packed, IMAGE_CODEC_PNG,
                              &(image_encode_desc){.allocator = desc->allocator,
                                                   .thread_count = thread_count,
                                                   .compression = desc->png_compression},
                              bytes, size, error);
    image_destroy(&packed);
    return result;
}

facet_result facet_cube_draw_sheet(const facet_cube *c, facet_environment *environment,
                                   const facet_sheet_desc *desc, facet_image **out, facet_error *error)
{
    static const facet_sheet_desc default_desc;
    *out = NULL;
    desc = desc ? desc : &default_desc;
    image texels = {0};
    facet_result result = ibl_sheet_draw(c, environment, desc, &texels, error);
    return result == FACET_OK ? give(&texels, &desc->allocator, out, error) : result;
}
