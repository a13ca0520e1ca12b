/* image.h - images in memory. Texel (0, 0) is the top left one, rows go down: said here, once. */
#ifndef IMAGE_IMAGE_H
#define IMAGE_IMAGE_H

#include "facet/facet.h"

typedef enum image_type { IMAGE_U8, IMAGE_U16, IMAGE_F16, IMAGE_F32 } image_type;

/* Texels, interleaved, without padding between rows. {0} is no image. Integers stand for [0, 1]. */
typedef struct image {
    void *pixels; /* block of mem_alloc() */
    uint32_t width, height;
    uint32_t channel_count; /* 1: grey, 2: grey and alpha, 3: RGB, 4: RGBA; alpha straight, always linear */
    image_type type;
    bool is_srgb; /* the color channels carry the sRGB transfer function; else linear */
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

/* Undefined texels. Fails with FACET_ERROR_MEMORY. */
facet_result image_create(const facet_allocator *allocator, uint32_t width, uint32_t height,
                          uint32_t channel_count, image_type type, image *out, facet_error *error);
void image_destroy(image *i); /* {0} is allowed; leaves {0} */

/* Another type, channel count (grey spreads to RGB, missing alpha is 1, dropped alpha is dropped) and transfer
 * function. Works on rows in parallel. */
facet_result image_convert(const image *in, const facet_allocator *allocator, uint32_t thread_count,
                           uint32_t channel_count, image_type type, bool to_srgb, image *out,
                           facet_error *error);

/* Reads texels of an image of any type as linear RGBA floats, with the values of image_convert(), a few at a time. */
typedef struct image_reader {
    const image *source; /* not owned */
    float *
        light; /* of each code where the channels are sRGB-encoded integers; block of mem_alloc(), else NULL */
} image_reader;

/* FACET_ERROR_MEMORY. */
facet_result image_reader_create(const image *source, const facet_allocator *allocator, image_reader *out,
                                 facet_error *error);
void image_reader_destroy(image_reader *r); /* {0} is allowed; leaves {0} */
/* count texels from texel first on, row by row, into rgba. */
void image_reader_load(const image_reader *r, size_t first, size_t count, float *rgba);

/* Radiance in 8 bits, RGB with a multiplier as alpha: U8 RGBA of F32 RGB or RGBA (alpha is not looked at), such that
 *   value = RGB / 255 * M / 255 * range
 * with the smallest M that holds the texel's largest channel, M = ceil(255 max / range), and at least 1 (Karis 2009, "RGBM
 * color encoding"; three.js' RGBMToLinear() reads it. PlayCanvas squares what it reads: it keeps roots). Values above range
 * become range, below 0 and NaN 0. The error is at most M range / (2 255^2): a part in 510 of the texel's largest channel,
 * or of a step of range / 255 where that is more. range: above 0. FACET_ERROR_MEMORY. */
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

image_codec image_codec_detect(const void *bytes, size_t size); /* by the first bytes */
const char *image_codec_name(image_codec codec);                /* "PNG" .. */
bool image_codec_is_built(image_codec codec);                   /* whether this build can decode such files */

/* One sentence about what a decoder did that the user may want to know, or what the file asks for and does not get.
 * text[0] is 0 where there is nothing to report. */
typedef struct image_note {
    facet_log_level level;
    char text[256];
} image_note;

/* Replaces the note. note may be NULL. */
void image_note_set(image_note *note, facet_log_level level, const char *format, ...)
    __attribute__((format(printf, 3, 4)));
/* Sends a note that is set to log, as "NAME: TEXT". */
void image_note_log(const image_note *note, const char *name, const facet_log *log);

/* Receives an image row by row while it is decoded. */
typedef struct image_row_sink {
    void *user;
    /* Called once, before the rows: header is the image to come, pixels NULL. A failure ends decoding, of add_row() too. */
    facet_result (*begin)(void *user, const image *header, facet_error *error);
    /* From the top; texels are valid during the call. */
    facet_result (*add_row)(void *user, const void *texels, facet_error *error);
} image_row_sink;

/* How a file is decoded. {0}: as it is, largest edge 16384. */
typedef struct image_decode_desc {
    facet_allocator allocator;
    uint32_t thread_count; /* for codecs that can use them; 0: 1 */
    uint32_t max_size; /* texels along an edge, 0: 16384; a larger image fails with FACET_ERROR_LIMIT before
                              memory is taken for it */
    uint32_t max_reduction; /* 0: none. The image may come reduced by 2^k with k <= max_reduction in both
                               directions (rounded up) where the codec does that cheaply (JPEG: k <= 3; KTX2: the
                               levels in the file that are of that size) */
    uint32_t channel_count; /* 0: the file's own; 3 or 4: as asked, 8-bit formats only */
    /* EXR: one of its layers by name, see exr_shim_layer(), of 2, 3 or 4 channels (one becomes 3); NULL: the image
     * */
    const char *layer;
    /* EXR, PFM, KTX2: NaN and infinity stay: for an image to be looked at, not to be lit by, or where the caller
     * counts them */
    bool keeps_nonfinite;
    /* NULL: not wanted. What infinity becomes: 65504 where the file holds half, else the largest float */
    float *largest;
    /* EXR, HDR: colors of other primaries that are outside of Rec.709 lose their negative components: for light */
    bool clips_gamut;
    image_note *note; /* set or cleared by image_decode(); NULL: not wanted */
    /* NULL: the image comes whole. Otherwise codecs that decode from the top (PNG that is not interlaced, in its own channels)
     * may hand over rows and leave out->pixels NULL; on failure some rows may have been handed over. */
    const image_row_sink *sink;
} image_decode_desc;

/* What the header says; nothing else is read. width and height are those of the whole image as it is decoded. */
facet_result image_probe(const void *bytes, size_t size, const char *name, image *header /* pixels NULL */,
                         image_codec *codec, facet_error *error);
/* Decodes. name stands first in messages. PNG, AVIF: 8 bits up to 8 bits a channel, 16 above; JPEG, WebP,
 * TGA, BMP, GIF, DDS: 8 bits;
 * all of them is_srgb = true (gamma chunks and profiles are ignored, glTF 2.0 section 3.8.2); AVIF's crop, rotation and
 * mirroring are applied. HDR, EXR, PFM: F32 RGB
 * or RGBA, linear; NaN and negative infinity become 0, infinity the largest finite value (65504 where a file holds
 * half), unless desc says otherwise; so in KTX2. KTX2: the first layer and face (ktx2.h has them all), of the type that holds
 * the format's values, is_srgb as the file says; channels that its format lacks are 0, as samplers read them. */
facet_result image_decode(const void *bytes, size_t size, const char *name, const image_decode_desc *desc,
                          image *out, facet_error *error);

/* What an EXR file says it shows of all directions: its attribute envmap (ImfEnvmap.h). */
typedef enum image_envmap {
    IMAGE_ENVMAP_NONE,
    IMAGE_ENVMAP_LATLONG,
    IMAGE_ENVMAP_CUBE /* six faces from the top, each as it is seen from inside */
} image_envmap;

/* IMAGE_ENVMAP_NONE too where the bytes are no EXR file or damaged, which decoding them reports. */
image_envmap image_get_envmap(const void *bytes, size_t size);

/* One named layer of an EXR file, float. */
typedef struct image_layer {
    const char *const *channel_names; /* channel_count full names, "R", "normal.X" */
    uint32_t channel_count;
    const float *pixels; /* interleaved */
    size_t row_stride_bytes;
    bool needs_float; /* numbers that halves would round: IDs, counts */
} image_layer;

/* A named text in an EXR file: an attribute of the type "string". */
typedef struct image_text {
    const char *name, *value;
} image_text;

typedef struct image_encode_desc {
    facet_allocator allocator;
    uint32_t thread_count;   /* 0: 1; the bytes do not depend on it */
    uint32_t quality;        /* JPEG, WebP: 1 to 100, 0: 92; WebP 100 is lossless */
    uint32_t compression;    /* PNG, EXR: zlib level 1 to 9; 0: 4 */
    bool is_stored;          /* EXR: not compressed at all, which is quick */
    const image_text *texts; /* EXR: beside the image */
    uint32_t text_count;
} image_encode_desc;

/* Encoded bytes: a block of mem_alloc() and its used size. PNG, JPEG and WebP take U8 (PNG also U16) and write
 * the samples as they are; HDR and PFM take F32 RGB. */
facet_result image_encode(const image *i, image_codec codec, const image_encode_desc *desc,
                          unsigned char **bytes, size_t *size, facet_error *error);
/* Scanline OpenEXR, ZIP or stored, half (but for layers that need floats) or float. Floats are written bit for bit. */
facet_result image_encode_exr(uint32_t width, uint32_t height, const image_layer *layers,
                              uint32_t layer_count, bool as_half, const image_encode_desc *desc,
                              unsigned char **bytes, size_t *size, facet_error *error);

/* ---- numbers in EXR files, for who wrote them ---- */

/* A channel in memory: the sample at (x, y) is first[y * row_stride_bytes + x * texel_stride_bytes], in bytes. */
typedef struct image_channel {
    const char *name; /* in the file, in full */
    float *first;
    size_t texel_stride_bytes, row_stride_bytes;
} image_channel;

/* Reads named float channels bit for bit; allocator (NULL: malloc) is asked for little. FACET_ERROR_INVALID where one is
 * missing or holds no floats, the image is not of this size, or the file is damaged: what is in the channels then is
 * undefined. */
facet_result image_read_exr_channels(const void *bytes, size_t size, const char *name,
                                     const facet_allocator *allocator, uint32_t width, uint32_t height,
                                     const image_channel *channels, uint32_t channel_count,
                                     facet_error *error);
/* Reads one of image_encode_desc's texts. FACET_ERROR_INVALID where it is missing or does not fit in value. */
facet_result image_read_exr_text(const void *bytes, size_t size, const char *name, const char *text_name,
                                 char *value, size_t value_size, facet_error *error);

#endif
