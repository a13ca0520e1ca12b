/* texel_masks.h - texels with channels as bit fields of a little-endian word, as in BMP, TGA and DDS files. */
#ifndef IMAGE_TEXEL_MASKS_H
#define IMAGE_TEXEL_MASKS_H

#include "image/codec.h"

typedef struct texel_masks {
    uint32_t byte_count;  /* of a word, 1 to 4 */
    uint32_t channels[4]; /* bits of R, G, B, A; grey: R. 0: none, the channel is 0, alpha 255 */
} texel_masks;

/* Words of 15, 16, 24 and 32 bits, the last without and with alpha, in the order of Windows and Truevision. */
static const texel_masks texel_masks_555 = {2, {0x7c00, 0x3e0, 0x1f, 0}};
static const texel_masks texel_masks_1555 = {2, {0x7c00, 0x3e0, 0x1f, 0x8000}};
static const texel_masks texel_masks_bgr = {3, {0xff0000, 0xff00, 0xff, 0}};
static const texel_masks texel_masks_bgrx = {4, {0xff0000, 0xff00, 0xff, 0}};
static const texel_masks texel_masks_bgra = {4, {0xff0000, 0xff00, 0xff, 0xff000000}};
static const texel_masks texel_masks_grey = {1, {0xff, 0, 0, 0}};
static const texel_masks texel_masks_grey_alpha = {2, {0xff, 0, 0, 0xff00}};

/* The bits of a mask scaled to [0, 255], rounded. */
static inline unsigned char texel_masks_channel(uint32_t word, uint32_t mask)
{
    const uint32_t lowest = mask & (~mask + 1u);
    const uint64_t value = (word & mask) / lowest, most = mask / lowest;
    return (unsigned char)(most == 255 ? value : (value * 255 + most / 2) / most);
}

/* Unpacks count words to texels of channel_count channels: 1: R, 2: R and A, 3: RGB, 4: RGBA. */
static inline void texel_masks_unpack(const texel_masks *m, const unsigned char *words, size_t count,
                                      uint32_t channel_count, unsigned char *texels)
{
    const uint32_t has_alpha = channel_count % 2 == 0, color_count = channel_count - has_alpha;
    for (size_t i = 0; i < count; i++, words += m->byte_count) {
        uint32_t word = 0;
        for (uint32_t k = m->byte_count; k-- > 0;)
            word = word << 8 | words[k];
        for (uint32_t c = 0; c < color_count; c++)
            *texels++ = m->channels[c] ? texel_masks_channel(word, m->channels[c]) : 0;
        if (has_alpha)
            *texels++ = m->channels[3] ? texel_masks_channel(word, m->channels[3]) : 255;
    }
}

/* Makes an image opaque if its alpha is 0 everywhere, as left by writers that do not use alpha. */
static inline void texel_masks_fill_unused_alpha(image *i)
{
    const size_t count = (size_t)i->width * i->height, step = i->channel_count;
    unsigned char *alpha = (unsigned char *)i->pixels + step - 1;
    for (size_t k = 0; k < count; k++)
        if (step % 2 || alpha[k * step])
            return;
    for (size_t k = 0; k < count; k++)
        alpha[k * step] = 255;
}

#endif
