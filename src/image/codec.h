/* codec.h - the interface between codec.c and the codecs, each in the file of its name, and their shared
 * helpers. */
#ifndef IMAGE_CODEC_H
#define IMAGE_CODEC_H

#include "image/image.h"

enum { CODEC_MAX_SIZE = 16384 }; /* the default of image_decode_desc.max_size */

/* bytes, of which there are size, begin with the codec's magic number; max_size and thread_count of desc are
 * resolved, largest is that of floats. out and header are {0} on entry and after a failure. */
typedef facet_result codec_probe(const unsigned char *bytes, size_t size, const char *name, image *header,
                                 facet_error *error);
typedef facet_result codec_decode(const unsigned char *bytes, size_t size, const char *name,
                                  const image_decode_desc *desc, image *out, facet_error *error);
/* *bytes is NULL, *size 0 when called. */
typedef facet_result codec_encode(const image *i, const image_encode_desc *desc, unsigned char **bytes,
                                  size_t *size, facet_error *error);

codec_probe png_probe, jpeg_probe, webp_probe, hdr_probe, exr_probe, pfm_probe, ktx2_probe, avif_probe,
    tga_probe, bmp_probe, gif_probe, dds_probe;
codec_decode png_decode, jpeg_decode, webp_decode, hdr_decode, exr_decode, pfm_decode, ktx2_decode_file,
    avif_decode, tga_decode, bmp_decode, gif_decode, dds_decode;
codec_encode png_encode, jpeg_encode, webp_encode, hdr_encode, pfm_encode;

/* image_get_envmap() of an EXR file. */
image_envmap exr_get_envmap(const unsigned char *bytes, size_t size);

/* Whether the bytes begin with the header of a format without a distinctive magic number. */
bool tga_detect(const unsigned char *bytes, size_t size);
bool bmp_detect(const unsigned char *bytes, size_t size);
bool dds_detect(const unsigned char *bytes, size_t size);

/* FACET_ERROR_LIMIT if an edge exceeds max_size, FACET_ERROR_INVALID if one is 0. */
facet_result codec_check_size(const char *name, uint64_t width, uint64_t height, uint32_t max_size,
                              facet_error *error);
/* The same, and FACET_ERROR_INVALID if width x height texels of format need more than size bytes. */
facet_result codec_check_texels(const char *name, const char *format, uint32_t width, uint32_t height,
                                uint32_t max_size, uint64_t needed, size_t size, facet_error *error);
/* FACET_ERROR_ARGUMENT unless i has the type and one of the channel counts (bits 1 << count) of the codec. */
facet_result codec_check_input(const image *i, const char *codec, bool is_type_right, const char *types,
                               uint32_t channel_counts, facet_error *error);

/* The header of a display-referred image; it has no pixels. */
static inline image codec_srgb_header(uint32_t width, uint32_t height, uint32_t channel_count,
                                      image_type type)
{
    return (image){
        .width = width, .height = height, .channel_count = channel_count, .type = type, .is_srgb = true};
}

/* Flips columns and rows of an image in place. */
void codec_flip(image *i, bool has_flipped_columns, bool has_flipped_rows);
/* Converts an 8-bit image to desc->channel_count channels. On failure it becomes {0}. */
facet_result codec_set_channels(image *i, const image_decode_desc *desc, facet_error *error);

/* Parses the decimal number at the start of [text, end) independently of the locale: sign, digits, point,
 * exponent; NaN on failure. Error below 1e-15. *after (may be NULL) receives the position after it. */
double codec_parse_number(const char *text, const char *end, const char **after);

/* Makes radiance finite: NaN and negative infinity become 0, infinity the largest finite value. */
static inline float codec_finite(float x)
{
    return x <= 3.402823466e38f ? (x >= -3.402823466e38f ? x : 0.0f) : (x > 0.0f ? 3.402823466e38f : 0.0f);
}

static inline uint32_t load_u32_be(const unsigned char *p)
{
    return (uint32_t)p[0] << 24 | (uint32_t)p[1] << 16 | (uint32_t)p[2] << 8 | p[3];
}

static inline void store_u32_be(unsigned char *p, uint32_t x)
{
    p[0] = (unsigned char)(x >> 24);
    p[1] = (unsigned char)(x >> 16);
    p[2] = (unsigned char)(x >> 8);
    p[3] = (unsigned char)x;
}

static inline uint32_t load_u32_le(const unsigned char *p)
{
    return (uint32_t)p[3] << 24 | (uint32_t)p[2] << 16 | (uint32_t)p[1] << 8 | p[0];
}

static inline void store_u32_le(unsigned char *p, uint32_t x)
{
    p[0] = (unsigned char)x;
    p[1] = (unsigned char)(x >> 8);
    p[2] = (unsigned char)(x >> 16);
    p[3] = (unsigned char)(x >> 24);
}

#endif
