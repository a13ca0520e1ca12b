/* thumbnail_api.c - small copies of images for display: reduced, exposed, tone-mapped. */
#include "api/api.h"

#include <math.h>

#include "base/memory.h"
#include "base/parallel.h"
#include "base/result.h"
#include "film/meter.h"

/* Largest value of a pixel: that of half floats. NaN becomes 0. */
static const float MOST = 65504.0f;

typedef struct reduction {
    const film *from;
    film *to;
} reduction;

/* The mean of the pixels of one cell. */
static void reduce_cell(const reduction *r, uint32_t x, uint32_t y, float out[4])
{
    const film *f = r->from;
    uint32_t left = (uint32_t)((uint64_t)x * f->width / r->to->width);
    uint32_t right = (uint32_t)((uint64_t)(x + 1) * f->width / r->to->width);
    uint32_t top = (uint32_t)((uint64_t)y * f->height / r->to->height);
    uint32_t bottom = (uint32_t)((uint64_t)(y + 1) * f->height / r->to->height);
    double sum[4] = {0.0};
    for (uint32_t j = top; j < bottom; j++) {
        const float *pixel = f->layers[0].pixels + 4 * ((size_t)j * f->width + left);
        for (uint32_t i = left; i < right; i++, pixel += 4)
            for (int k = 0; k < 4; k++)
                sum[k] += pixel[k] > 0.0f ? (double)fminf(pixel[k], MOST) : 0.0;
    }
    double count = (double)(right - left) * (bottom - top);
    for (int k = 0; k < 4; k++)
        out[k] = (float)(sum[k] / count);
}

static void reduce_rows(void *context, size_t begin, size_t end)
{
    const reduction *r = context;
    for (size_t y = begin; y < end; y++)
        for (uint32_t x = 0; x < r->to->width; x++)
            reduce_cell(r, x, (uint32_t)y, r->to->layers[0].pixels + 4 * (y * r->to->width + x));
}

/* Scales light so that the log-average of what is lit is METER_KEY. Blacks, as around an object on black, do not count: below
 * 1/256 of the mean. */
static float meter_lit(const film *f)
{
    double floor = film_average(f) / 256.0;
    double sum = 0.0;
    double weight = 0.0;
    const float *p = f->layers[0].pixels;
    for (size_t i = 0; i < (size_t)f->width * f->height; i++, p += 4) {
        if (!(p[3] > 0.0f))
            continue;
        double L = (0.2126 * (double)p[0] + 0.7152 * (double)p[1] + 0.0722 * (double)p[2]) / (double)p[3];
        if (L > floor) {
            sum += (double)p[3] * log(L);
            weight += (double)p[3];
        }
    }
    return weight > 0.0 ? (float)(METER_KEY / exp(sum / weight)) : 1.0f;
}

static void expose(film *f, float scale)
{
    float *p = f->layers[0].pixels;
    for (size_t i = 0; i < (size_t)f->width * f->height; i++, p += 4)
        for (int k = 0; k < 3; k++)
            p[k] *= scale;
}

facet_result facet_image_create_thumbnail(const facet_image *image, const facet_thumbnail_desc *desc,
                                          facet_image **thumbnail, facet_error *error)
{
    const facet_thumbnail_desc defaults = {.tonemap = FACET_TONEMAP_NEUTRAL};
    desc = desc ? desc : &defaults;
    *thumbnail = NULL;
    if (image->texels)
        return fail(error, FACET_ERROR_ARGUMENT, "thumbnail: a compact image is for comparisons only");
    const uint32_t thread_count = desc->thread_count ? desc->thread_count : facet_thread_count();
    const uint32_t size = desc->size ? desc->size : 256;
    const film *from = &image->film;
    const uint32_t longest = from->width > from->height ? from->width : from->height;
    const double scale = longest > size ? (double)size / longest : 1.0;
    const uint32_t width = (uint32_t)fmax(1.0, round(scale * from->width));
    const uint32_t height = (uint32_t)fmax(1.0, round(scale * from->height));
    facet_image *made = mem_zalloc(&desc->allocator, 1, sizeof *made);
    if (!made)
        return fail_memory(error, "thumbnail", sizeof *made);
    facet_result result = film_create(&desc->allocator, width, height, 0, &made->film, error);
    if (result != FACET_OK) {
        mem_free(made);
        return result;
    }
    reduction r = {from, &made->film};
    parallel_for(thread_count, height, 4, reduce_rows, &r);
    made->is_for_display = true;
    if (!image->is_for_display) {
        expose(&made->film, meter_lit(&made->film) * exp2f(desc->exposure_ev));
        film_tone_map(&made->film, desc->tonemap, NULL, thread_count);
    }
    *thumbnail = made;
    return FACET_OK;
}
