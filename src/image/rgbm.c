/* rgbm.c - see rgbm.h. */
#include "image/rgbm.h"

#include <math.h>

#include "base/parallel.h"

typedef struct packing {
    const image *in;
    image *out;
    float range;
} packing;

static void pack_texel(const float *rgb, float range, uint8_t *out)
{
    float x[3];
    float largest = 0.0f;
    for (int i = 0; i < 3; i++) {
        x[i] = rgb[i] > 0.0f ? rgb[i] / range : 0.0f;
        x[i] = x[i] < 1.0f ? x[i] : 1.0f;
        largest = x[i] > largest ? x[i] : largest;
    }
    float m = ceilf(largest * 255.0f);
    m = m < 1.0f ? 1.0f : m;
    for (int i = 0; i < 3; i++) {
        float code = x[i] * 65025.0f / m + 0.5f; /* 255^2 */
        out[i] = (uint8_t)(code < 255.0f ? code : 255.0f);
    }
    out[3] = (uint8_t)m;
}

static void pack_rows(void *context, size_t begin, size_t end)
{
    const packing *p = context;
    const uint32_t channels = p->in->channel_count;
    const size_t width = p->in->width;
    const float *from = (const float *)p->in->pixels + begin * width * channels;
    uint8_t *to = (uint8_t *)p->out->pixels + begin * width * 4;
    for (size_t i = begin * width; i < end * width; i++, from += channels, to += 4)
        pack_texel(from, p->range, to);
}

facet_result rgbm_encode(const image *in, float range, const facet_allocator *allocator,
                         uint32_t thread_count, image *out, facet_error *error)
{
    facet_result result = image_create(allocator, in->width, in->height, 4, IMAGE_U8, out, error);
    if (result != FACET_OK)
        return result;
    packing p = {in, out, range};
    parallel_for(thread_count, in->height, 16, pack_rows, &p);
    return FACET_OK;
}
