/* image.h - images in memory, and the interface of the codecs. Texel (0, 0) is the top left one, rows go
 * down. */
#ifndef IMAGE_IMAGE_H
#define IMAGE_IMAGE_H

#include "facet/facet.h"

typedef enum image_type { IMAGE_U8, IMAGE_U16, IMAGE_F16, IMAGE_F32 } image_type;

/* Interleaved texels without padding between rows. {0}: no image. Integers represent [0, 1]. */
typedef struct image {
    void *pixels; /* block of mem_alloc() */
    uint32_t width, height;
    uint32_t channel_count; /* 1: grey, 2: grey and alpha, 3: RGB, 4: RGBA; alpha straight, always linear */
    image_type type;
    bool is_srgb; /* the color channels are sRGB-encoded; otherwise linear */
} image;

size_t image_type_size(image_type type);              /* bytes of a channel */
static inline size_t image_texel_size(const image *i) /* bytes of a texel */
{
    return image_type_size(i->type) * i->channel_count;
}
static inline size_t image_row_size(const image *i)
{
    return image_texel_size(i) * i->width;
}

/* Creates an image with undefined texels. FACET_ERROR_MEMORY. */
facet_result image_create(const facet_allocator *allocator, uint32_t width, uint32_t height,
                          uint32_t channel_count, image_type type, image *out, facet_error *error);
void image_destroy(image *i); /* {0} is allowed; leaves {0} */

/* Converts type, channel count (grey to RGB, missing alpha to 1) and transfer function, with rows in
 * parallel. */
facet_result image_convert(const image *in, const facet_allocator *allocator, uint32_t thread_count,
                           uint32_t channel_count, image_type type, bool to_srgb, image *out,
                           facet_error *error);

/* Reads texels of an image of any type as linear RGBA floats, with the values of image_convert(), a few at
 * a time. */
typedef struct image_reader {
    const image *source; /* not owned */
    float *
        light; /* of each code where the channels are sRGB-encoded integers; block of mem_alloc(), else NULL */
} image_reader;

/* FACET_ERROR_MEMORY. */
facet_result image_reader_create(const image *source, const facet_allocator *allocator, image_reader *out,
                                 facet_error *error);
void image_reader_destroy(image_reader *r); /* {0} is allowed; leaves {0} */
/* Loads count texels from index first on, in row-major order. */
void image_reader_load(const image_reader *r, size_t first, size_t count, float *rgba);

/* RGBM, radiance in 8 bits with a multiplier as alpha: U8 RGBA of F32 RGB or RGBA (alpha is ignored), such
 * that
 *   value = RGB / 255 * M / 255 * range
 * with the smallest M of at least 1 that holds the texel's largest channel, M = ceil(255 max / range) (Karis
 * 2009, "RGBM color encoding"; read by three.js' RGBMToLinear(). PlayCanvas squares what it reads, so it
 * needs square roots). Values above range are clamped, negative ones and NaN are 0. The error is at most M
 * range / (2 255^2): 1/510 of the texel's largest channel, or of a step of range / 255 if that is more.
 * range: above 0. FACET_ERROR_MEMORY. */
facet_result rgbm_encode(const image *in, float range, const facet_allocator *allocator,
                         uint32_t thread_count, image *out, facet_error *error);

/* ---- codecs: files in memory to images and back ---- */

typedef enum image_codec {
    IMAGE_CODEC_UNKNOWN,
    IMAGE_CODEC_PNG,
    IMAGE_CODEC_JPEG,
    IMAGE_CODEC_WEBP,
    IMAGE_CODEC_HDR,
    IMAGE_CODEC_EXR,
    IMAGE_CODEC_PFM,
    IMAGE_CODEC_KTX2,
    IMAGE_CODEC_AVIF,
    IMAGE_CODEC_TGA,
    IMAGE_CODEC_BMP,
    IMAGE_CODEC_GIF, /* the first image */
    IMAGE_CODEC_DDS  /* the largest level of the first texture */
} image_codec;

image_codec image_codec_detect(const void *bytes, size_t size); /* detects by the first bytes */
const char *image_codec_name(image_codec codec);                /* "PNG" .. */
bool image_codec_is_built(image_codec codec);                   /* whether this build can decode such files */

/* One sentence about a conversion by a decoder, or a feature of the file that is ignored. text[0] is 0 if
 * there is nothing to report. */
typedef struct image_note {
    facet_log_level level;
    char text[256];
} image_note;

/* Replaces the note. note may be NULL. */
void image_note_set(image_note *note, facet_log_level level, const char *format, ...)
    __attribute__((format(printf, 3, 4)));
/* Sends a note, if set, to log as "NAME: TEXT". */
void image_note_log(const image_note *note, const char *name, const facet_log *log);

/* Receives an image row by row while it is decoded. */
typedef struct image_row_sink {
    void *user;
    /* Called once before the rows; header describes the image, pixels NULL. A failure of either function ends
     * decoding. */
    facet_result (*begin)(void *user, const image *header, facet_error *error);
    /* Rows from the top; texels are valid during the call. */
    facet_result (*add_row)(void *user, const void *texels, facet_error *error);
} image_row_sink;

/* How to decode a file. {0}: unchanged, largest edge 16384. */
typedef struct image_decode_desc {
    facet_allocator allocator;
    uint32_t thread_count; /* for codecs that use threads; 0: 1 */
    /* Texels along an edge, 0: 16384; larger images fail with FACET_ERROR_LIMIT before allocation */
    uint32_t max_size;
    /* The image may be reduced by 2^k, k <= max_reduction, in both directions (rounded up) if the codec does
     * that cheaply (JPEG: k <= 3; KTX2: levels of that size). 0: not reduced */
    uint32_t max_reduction;
    uint32_t channel_count; /* 0: the file's own; 3 or 4: 8-bit formats only */
    /* EXR: a layer by name, see exr_shim_layer(), of 2, 3 or 4 channels (one becomes 3); NULL: the image */
    const char *layer;
    /* EXR, PFM, KTX2: keep NaN and infinity, for images that are not light sources or if the caller counts
     * them */
    bool keeps_nonfinite;
    /* Receives the replacement of infinity: 65504 if the file holds half, else the largest float. NULL: not
     * wanted */
    float *largest;
    /* EXR, HDR: clip negative components of colors outside of Rec.709 after conversion from other primaries;
     * for light sources */
    bool clips_gamut;
    image_note *note; /* set or cleared by image_decode(); NULL: not wanted */
    /* NULL: the whole image is returned. Otherwise codecs that decode from the top (PNG that is not
     * interlaced, in its own channels) may pass rows instead and leave out->pixels NULL; some rows may have
     * been passed before a failure. */
    const image_row_sink *sink;
} image_decode_desc;

/* Reads the header only. width and height are those of the whole image after decoding. */
facet_result image_probe(const void *bytes, size_t size, const char *name, image *header /* pixels NULL */,
                         image_codec *codec, facet_error *error);
/* Decodes a file; name begins messages.
 * - PNG, AVIF: U8 for up to 8 bits per channel, U16 above; JPEG, WebP, TGA, BMP, GIF, DDS: U8. All have
 *   is_srgb = true (gamma chunks and profiles are ignored, glTF 2.0 section 3.8.2). AVIF's crop, rotation and
 *   mirroring are applied.
 * - HDR, EXR, PFM: F32 RGB or RGBA, linear. NaN and negative infinity become 0, infinity the largest finite
 *   value (65504 if the file holds half) unless desc says otherwise; the same for KTX2.
 * - KTX2: the first layer and face (ktx2.h reads all), in the type that holds the format's values, is_srgb as
 *   the file states; channels that the format lacks are 0, as samplers read them. */
facet_result image_decode(const void *bytes, size_t size, const char *name, const image_decode_desc *desc,
                          image *out, facet_error *error);

/* The attribute envmap of an EXR file (ImfEnvmap.h). */
typedef enum image_envmap {
    IMAGE_ENVMAP_NONE,
    IMAGE_ENVMAP_LATLONG,
    IMAGE_ENVMAP_CUBE /* six faces from the top, each as seen from inside */
} image_envmap;

/* Also IMAGE_ENVMAP_NONE if the bytes are not an EXR file or damaged, which decoding reports. */
image_envmap image_get_envmap(const void *bytes, size_t size);

/* One named layer of an EXR file, float. */
typedef struct image_layer {
    const char *const *channel_names; /* channel_count full names, "R", "normal.X" */
    uint32_t channel_count;
    const float *pixels; /* interleaved */
    size_t row_stride_bytes;
    bool needs_float; /* values that halves would round: IDs, counts */
    bool is_integer;  /* pixels are 32-bit unsigned integers, not floats */
} image_layer;

/* A named text in a file: in EXR an attribute of the type "string"; in PNG a tEXt chunk, whose keyword has 1 to 79 bytes and
 * whose text is Latin-1. */
typedef struct image_text {
    const char *name, *value;
} image_text;

typedef struct image_encode_desc {
    facet_allocator allocator;
    uint32_t thread_count;   /* 0: 1; the bytes do not depend on it */
    uint32_t quality;        /* JPEG, WebP: 1 to 100, 0: 92; WebP 100 is lossless */
    uint32_t compression;    /* PNG, EXR: zlib level 1 to 9; 0: 4 */
    bool is_stored;          /* EXR: uncompressed, which is fast */
    const image_text *texts; /* PNG, EXR: beside the image */
    uint32_t text_count;
} image_encode_desc;

/* Encodes an image into a block of mem_alloc(). PNG, JPEG and WebP take U8 (PNG also U16) and write the
 * samples unchanged; HDR and PFM take F32 RGB. */
facet_result image_encode(const image *i, image_codec codec, const image_encode_desc *desc,
                          unsigned char **bytes, size_t *size, facet_error *error);
/* The same for PNG, for programs that need no other encoder. */
facet_result image_encode_png(const image *i, const image_encode_desc *desc, unsigned char **bytes,
                              size_t *size, facet_error *error);
/* Encodes scanline OpenEXR, ZIP or uncompressed, as half (except layers that need floats) or float. Floats
 * are written bit for bit. */
facet_result image_encode_exr(uint32_t width, uint32_t height, const image_layer *layers,
                              uint32_t layer_count, bool as_half, const image_encode_desc *desc,
                              unsigned char **bytes, size_t *size, facet_error *error);

/* ---- EXR files as data, for checkpoints ---- */

/* A channel in memory: the sample at (x, y) is first[y * row_stride_bytes + x * texel_stride_bytes], in
 * bytes. */
typedef struct image_channel {
    const char *name; /* full name in the file */
    float *first;
    bool is_integer; /* 32-bit unsigned integers, not floats */
    size_t texel_stride_bytes, row_stride_bytes;
} image_channel;

/* Reads named channels bit for bit; allocator (NULL: malloc) provides a little scratch memory.
 * FACET_ERROR_INVALID if a channel is missing or of another type, the image does not have this size, or
 * the file is damaged, after which the channels are undefined. */
facet_result image_read_exr_channels(const void *bytes, size_t size, const char *name,
                                     const facet_allocator *allocator, uint32_t width, uint32_t height,
                                     const image_channel *channels, uint32_t channel_count,
                                     facet_error *error);
/* Reads one of image_encode_desc's texts. FACET_ERROR_INVALID if it is missing or does not fit in value. */
facet_result image_read_exr_text(const void *bytes, size_t size, const char *name, const char *text_name,
                                 char *value, size_t value_size, facet_error *error);

#endif
