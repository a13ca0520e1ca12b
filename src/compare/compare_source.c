/* compare_source.c - see compare_source.h. */
#include "compare/compare_source.h"

#include <float.h>
#include <math.h>

#include "base/result.h"
#include "base/simd.h"
#include "compare/compare_math.h"

#include "shade/shade.h"

/* ---- opening ---- */

static facet_result take_crop(const uint32_t crop[4], compare_source *s, facet_error *error)
{
    const uint32_t width = s->a.image.texels->width, height = s->a.image.texels->height;
    if (!crop[0] && !crop[1] && !crop[2] && !crop[3]) {
        s->width = width;
        s->height = height;
        return FACET_OK;
    }
    if (crop[2] == 0 || crop[3] == 0 || crop[0] >= width || crop[1] >= height || crop[2] > width - crop[0] ||
        crop[3] > height - crop[1])
        return fail(error, FACET_ERROR_ARGUMENT,
                    "compare: the crop of %u x %u pixels at %u, %u is not inside the image of %u x %u",
                    crop[2], crop[3], crop[0], crop[1], width, height);
    s->x = crop[0];
    s->y = crop[1];
    s->width = crop[2];
    s->height = crop[3];
    return FACET_OK;
}

facet_result compare_source_open(const compare_image *a, const compare_image *b, const compare_image *mask,
                                 const facet_compare_desc *desc, compare_source *out, facet_error *error)
{
    const image *first = a->texels, *second = b->texels;
    if (first->width != second->width || first->height != second->height)
        return fail(error, FACET_ERROR_ARGUMENT,
                    "compare: the images are of different sizes, %u x %u and %u x %u pixels", first->width,
                    first->height, second->width, second->height);
    if (mask && (mask->texels->width != first->width || mask->texels->height != first->height))
        return fail(error, FACET_ERROR_ARGUMENT, "compare: the mask has %u x %u pixels, the images %u x %u",
                    mask->texels->width, mask->texels->height, first->width, first->height);
    *out = (compare_source){.a.image = *a,
                            .b.image = *b,
                            .has_mask = mask != NULL,
                            .has_opacity = desc->alpha == FACET_COMPARE_ALPHA_CHANNEL,
                            .tonemap = desc->tonemap,
                            .scale = exp2f(desc->exposure_ev)};
    out->is_display = desc->space == FACET_COMPARE_SPACE_DISPLAY ||
                      (desc->space == FACET_COMPARE_SPACE_AUTO &&
                       (a->is_display || b->is_display || desc->tonemap != FACET_TONEMAP_NONE));
    if (desc->alpha == FACET_COMPARE_ALPHA_BACKGROUND)
        for (int k = 0; k < 3; k++)
            out->background[k] = desc->background[k];
    TRY(take_crop(desc->crop, out, error));
    facet_result result = image_reader_create(first, &desc->allocator, &out->a.reader, error);
    if (result == FACET_OK)
        result = image_reader_create(second, &desc->allocator, &out->b.reader, error);
    if (result == FACET_OK && mask) {
        out->mask.image = *mask;
        result = image_reader_create(mask->texels, &desc->allocator, &out->mask.reader, error);
    }
    if (result != FACET_OK)
        compare_source_close(out);
    return result;
}

void compare_source_close(compare_source *s)
{
    image_reader_destroy(&s->a.reader);
    image_reader_destroy(&s->b.reader);
    image_reader_destroy(&s->mask.reader);
}

/* ---- loading ---- */

static bool is_finite(float x)
{
    return (float_bits(x) & 0x7f800000u) != 0x7f800000u;
}

/* Equal, or both NaN. */
static bool is_same(float a, float b)
{
    return a == b || (isnan(a) && isnan(b));
}

/* Texels from index first on: in place if they are linear, premultiplied RGBA floats already, else converted
 * into memory. */
static const float *read_side(const compare_side *s, size_t first, uint32_t count, float *memory)
{
    const image *i = s->image.texels;
    if (i->type == IMAGE_F32 && i->channel_count == 4 && !i->is_srgb && !s->image.is_straight)
        return (const float *)i->pixels + 4 * first;
    image_reader_load(&s->reader, first, count, memory);
    for (uint32_t k = 0; k < count && s->image.is_straight; k++)
        for (uint32_t c = 0; c < 3; c++)
            memory[4 * k + c] *= memory[4 * k + 3];
    return memory;
}

void compare_source_read(const compare_source *s, uint32_t x, uint32_t y, uint32_t count, compare_texels *out)
{
    const size_t first = (size_t)(s->y + y) * s->a.image.texels->width + s->x + x;
    for (uint32_t i = 0; i < count; i++)
        out->counts[i] = true;
    if (s->has_mask) {
        const float *c = read_side(&s->mask, first, count, out->memory[0]);
        for (uint32_t i = 0; i < count; i++, c += 4) /* 0.214 is linear for sRGB 0.5 */
            out->counts[i] = 0.2126f * c[0] + 0.7152f * c[1] + 0.0722f * c[2] >= 0.21404114f;
    }
    out->a = read_side(&s->a, first, count, out->memory[0]);
    out->b = read_side(&s->b, first, count, out->memory[1]);
}

/* Replaces the channels of a pixel that are not finite by 0 in both images; the pixel is invalid unless they
 * are the same in both. */
static unsigned take_out(const float *a, const float *b, float pa[4], float pb[4])
{
    bool is_invalid = false;
    for (int k = 0; k < 4; k++)
        is_invalid = is_invalid || ((!is_finite(a[k]) || !is_finite(b[k])) && !is_same(a[k], b[k]));
    for (int k = 0; k < 4; k++) {
        bool is_kept = !is_invalid && is_finite(a[k]) && is_finite(b[k]);
        pa[k] = is_kept ? a[k] : 0.0f;
        pb[k] = is_kept ? b[k] : 0.0f;
    }
    return is_invalid ? COMPARE_INVALID : 0;
}

static uint32_t clamp_index(int64_t i, uint32_t count)
{
    return i < 0 ? 0 : i >= (int64_t)count ? count - 1 : (uint32_t)i;
}

/* Stores up to COMPARE_TEXELS pixels from (x, y) on at position at of out. */
static void gather(const compare_source *s, int64_t x, int64_t y, uint32_t count, uint32_t at,
                   const compare_row *out)
{
    const uint32_t first = clamp_index(x, s->width), last = clamp_index(x + count - 1, s->width);
    compare_texels t;
    compare_source_read(s, first, clamp_index(y, s->height), last - first + 1, &t);
    for (uint32_t n = 0, i = at; n < count; n++, i++) {
        const uint32_t column = clamp_index(x + n, s->width) - first;
        const float *a = t.a + 4 * (size_t)column;
        const float *b = t.b + 4 * (size_t)column;
        float pa[4], pb[4];
        unsigned flags = COMPARE_COUNTS;
        if (!t.counts[column]) {
            b = a;
            flags = 0;
        }
        unsigned finite_count = 0;
        for (int k = 0; k < 4; k++)
            finite_count += (unsigned)is_finite(a[k]) + (unsigned)is_finite(b[k]);
        if (finite_count < 8) {
            flags |= take_out(a, b, pa, pb);
            a = pa;
            b = pb;
        }
        for (int k = 0; k < 4; k++) {
            out->a[k][i] = a[k];
            out->b[k][i] = b[k];
        }
        if (out->flags)
            out->flags[i] = (unsigned char)flags;
    }
}

/* Exposure and tone mapping of linear pixels. The operator is applied to the unpremultiplied color. */
static void tone_map_rows(const compare_source *s, float *const c[4], uint32_t count)
{
    for (int k = 0; k < 3 && s->scale != 1.0f; k++)
        for (uint32_t i = 0; i < count; i++)
            c[k][i] *= s->scale;
    for (uint32_t i = 0; i < count && s->is_display && s->tonemap != FACET_TONEMAP_NONE; i++) {
        const float opacity = clamp(c[3][i], 0.0f, 1.0f);
        vec3 shown = vec3(0.0f); /* as film_tone_map() where nothing is covered */
        if (opacity > 0.0f)
            shown = tonemap((int)s->tonemap, vec3(c[0][i], c[1][i], c[2][i]) / opacity) * opacity;
        for (int k = 0; k < 3; k++)
            c[k][i] = shown[k];
    }
}

DISPATCH_AVX2 static void compare_finish(float *const c[4], uint32_t count, const float background[3],
                                         bool is_display, bool is_encoded)
{
    for (int k = 0; k < 3; k++) {
        float *restrict channel = c[k];
        const float *restrict opacity = c[3];
        const float behind = background[k];
        if (behind != 0.0f)
            for (uint32_t i = 0; i < count; i++)
                channel[i] += behind * (1.0f - compare_clamp(opacity[i], 0.0f, 1.0f));
        if (is_display)
            for (uint32_t i = 0; i < count; i++)
                channel[i] = compare_clamp(channel[i], 0.0f, 1.0f);
        if (is_encoded)
            for (uint32_t i = 0; i < count; i++)
                channel[i] = compare_srgb_encode(channel[i]);
    }
    for (uint32_t i = 0; i < count && is_display; i++)
        c[3][i] = compare_clamp(c[3][i], 0.0f, 1.0f);
}

void compare_source_load(const compare_source *s, compare_values values, const float background[3], int64_t x,
                         int64_t y, uint32_t count, const compare_row *out)
{
    const bool is_encoded = s->is_display && values == COMPARE_CODES;
    for (uint32_t done = 0; done < count; done += COMPARE_TEXELS)
        gather(s, x + done, y, count - done < COMPARE_TEXELS ? count - done : COMPARE_TEXELS, done, out);
    if (!s->a.image.is_display)
        tone_map_rows(s, out->a, count);
    if (!s->b.image.is_display)
        tone_map_rows(s, out->b, count);
    background = background ? background : s->background;
    compare_finish(out->a, count, background, s->is_display, is_encoded);
    compare_finish(out->b, count, background, s->is_display, is_encoded);
}
