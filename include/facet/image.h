/* facet/image.h - images: loading, saving, layers, tone mapping curves, contact sheets. */
#ifndef FACET_IMAGE_H
#define FACET_IMAGE_H

#include "base.h"

#ifdef __cplusplus
extern "C" {
#endif

/* ---- pixels ---- */

/* A layer of an image, which lives as long as the image. Layer "" is the image itself: RGBA, linear Rec.709,
 * premultiplied; further layers are the AOVs of a render. */
typedef struct facet_image_view {
    const char *name;
    uint32_t width, height, channel_count;
    const float *pixels; /* channel_count floats per texel, rows from the top */
    size_t row_stride_bytes;
} facet_image_view;

FACET_API uint32_t facet_image_get_layer_count(const facet_image *image);
FACET_API facet_image_view facet_image_get_layer(const facet_image *image, uint32_t layer);
FACET_API void facet_image_destroy(facet_image *image);

/* An image from a copy of pixels: linear Rec.709, RGBA premultiplied, or RGB, or grey. row_stride_bytes 0:
 * rows without padding. The view's name is ignored. allocator NULL: {0}. */
FACET_API facet_result facet_image_create(const facet_image_view *pixels, const facet_allocator *allocator,
                                          facet_image **image, facet_error *error);

/* A layer of IDs ("object", "material" or "instance") of a rendered image in false color: in an 8-bit RGB
 * file the color is 0x3779b1 times the ID, modulo 2^24, as 0xRRGGBB, which differs for every ID.
 * Transparent where nothing is hit. allocator NULL: {0}. FACET_ERROR_ARGUMENT: the image lacks that layer,
 * or "instance", which marks the pixels that are hit. */
FACET_API facet_result facet_image_create_id_colors(const facet_image *image, const char *layer,
                                                    const facet_allocator *allocator, facet_image **colors,
                                                    facet_error *error);

/* One channel of an sRGB color (IEC 61966-2-1, [0, 1]) in linear light. */
FACET_API float facet_linear_from_srgb(float encoded);

/* Curves from scene-referred radiance to display-referred linear color. */
typedef enum facet_tonemap {
    FACET_TONEMAP_NONE,           /* linear; clamped when written to an 8- or 16-bit file */
    FACET_TONEMAP_NEUTRAL,        /* Khronos PBR Neutral */
    FACET_TONEMAP_ACES,           /* Hill's fit of RRT and ODT */
    FACET_TONEMAP_ACES_NARKOWICZ, /* Narkowicz's curve */
    FACET_TONEMAP_AGX,
    FACET_TONEMAP_REINHARD,
    FACET_TONEMAP_REINHARD_EXTENDED, /* white point 4 */
    FACET_TONEMAP_HABLE
} facet_tonemap;

/* ---- loading ---- */

/* {0}: malloc, all threads. */
typedef struct facet_image_load_desc {
    facet_allocator allocator;
    uint32_t thread_count;   /* 0: facet_thread_count() */
    uint64_t max_file_bytes; /* larger files are refused; 0: 4 GiB */
    uint32_t max_size;       /* pixels along an edge; larger images are refused; 0: 16384 */
    /* Layer of an OpenEXR file: "albedo", "normal", "depth" ..; its channels become R, G, B, opacity; a
     * single channel fills all three, the third of two is 0. NULL: the image. */
    const char *layer;
    facet_log log; /* features of the file that are ignored, color conversions */
    /* Keep the file's texels as they are, for facet_compare() alone: 1 or 2 bytes a channel instead of 16
     * a pixel for 8 and 16-bit formats. Layer 0 has no pixels (NULL), and the image cannot be saved. */
    bool is_compact;
} facet_image_load_desc;

/* Reads a PNG, JPEG, WebP, AVIF, KTX2, TGA, BMP, GIF, DDS, Radiance HDR, OpenEXR or PFM file, recognized
 * by content, into layer "". Display-referred formats are decoded from sRGB (profiles are ignored) and
 * multiplied by alpha. Values of HDR, EXR, PFM and float KTX2 files stay, NaN and infinity included; other
 * primaries of EXR and HDR files are converted to Rec.709. A missing alpha channel is 1. desc NULL: {0}. */
FACET_API facet_result facet_image_load(const char *path, const facet_image_load_desc *desc,
                                        facet_image **image, facet_error *error);
/* The same from memory, which may be released afterwards. Messages use name for the file. */
FACET_API facet_result facet_image_load_memory(const void *bytes, size_t size, const char *name,
                                               const facet_image_load_desc *desc, facet_image **image,
                                               facet_error *error);
/* The same decoder (facet_scene_get_decoder()) of an image file; NULL: none. */
FACET_API const char *facet_image_find_decoder(const void *bytes, size_t size);
/* Whether the image was read from a display-referred file (integers, sRGB): its colors lie in [0, 1] and
 * are those of a screen rather than light. */
FACET_API bool facet_image_is_for_display(const facet_image *image);

/* ---- saving ---- */

typedef enum facet_image_format {
    FACET_IMAGE_FORMAT_FROM_NAME, /* by the extension of the path */
    FACET_IMAGE_FORMAT_PNG,       /* 8 bits, sRGB, straight alpha */
    FACET_IMAGE_FORMAT_PNG16,
    FACET_IMAGE_FORMAT_JPEG, /* no alpha: over white */
    FACET_IMAGE_FORMAT_WEBP,
    FACET_IMAGE_FORMAT_EXR, /* half float, all layers, premultiplied alpha */
    FACET_IMAGE_FORMAT_EXR_FLOAT,
    FACET_IMAGE_FORMAT_HDR, /* Radiance RGBE; no alpha: over black */
    FACET_IMAGE_FORMAT_PFM, /* no alpha: over black */
    FACET_IMAGE_FORMAT_RAW  /* RGBA of 8 bits, sRGB, straight alpha, rows from the top, no header */
} facet_image_format;

/* {0}: by name, JPEG quality 92. */
typedef struct facet_image_save_desc {
    facet_allocator allocator;
    uint32_t thread_count; /* 0: facet_thread_count() */
    facet_image_format format;
    uint32_t jpeg_quality;    /* 1 to 100; 0: 92; for WebP too, where 100 is lossless */
    uint32_t png_compression; /* 1 (fast) to 9 (small); 0: 4 */
    /* ASCII, kept under the name facet-tag in PNG files (a tEXt chunk) and OpenEXR files (an attribute); NULL: none */
    const char *tag;
} facet_image_save_desc;

/* Writes the file whole or not at all. desc NULL: {0}. */
FACET_API facet_result facet_image_save(const facet_image *image, const char *path,
                                        const facet_image_save_desc *desc, facet_error *error);
/* The bytes that facet_image_save() would write; desc->format is not FROM_NAME. Release with
 * facet_bytes_destroy(). */
FACET_API facet_result facet_image_encode(const facet_image *image, const facet_image_save_desc *desc,
                                          unsigned char **bytes, size_t *size, facet_error *error);

/* ---- thumbnails ---- */

/* {0}: 256 pixels, no tone mapping. */
typedef struct facet_thumbnail_desc {
    facet_allocator allocator;
    uint32_t thread_count; /* 0: facet_thread_count() */
    uint32_t size;         /* pixels of the longer edge; smaller images are not enlarged; 0: 256 */
    facet_tonemap tonemap; /* of light */
    float exposure_ev;     /* stops above the metered exposure of light */
} facet_thumbnail_desc;

/* A small copy for display: pixels are means over those of the image; light is exposed for its lit parts and tone-mapped,
 * colors of a display stay. desc NULL: 256 pixels, FACET_TONEMAP_NEUTRAL. FACET_ERROR_ARGUMENT: the image is compact;
 * FACET_ERROR_MEMORY. */
FACET_API facet_result facet_image_create_thumbnail(const facet_image *image,
                                                    const facet_thumbnail_desc *desc, facet_image **thumbnail,
                                                    facet_error *error);

/* ---- contact sheets ---- */

/* {0}: as square as possible, without labels. */
typedef struct facet_contact_sheet_desc {
    facet_allocator allocator;
    facet_log log;
    uint32_t column_count; /* 0: as square as possible */
    uint32_t gap;          /* pixels between images; 0: 4 */
    /* UTF-8, one below each image; NULL: none. Need cairo, else log gets a warning */
    const char *const *labels;
} facet_contact_sheet_desc;

/* Tone-mapped images of one size in rows. desc NULL: {0}. FACET_ERROR_ARGUMENT: the sizes differ, or the
 * sheet exceeds 65536 pixels; FACET_ERROR_MEMORY. */
FACET_API facet_result facet_image_create_sheet(const facet_image *const *images, uint32_t count,
                                                const facet_contact_sheet_desc *desc, facet_image **sheet,
                                                facet_error *error);

#ifdef __cplusplus
}
#endif

#endif
