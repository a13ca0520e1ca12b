/* image_kind.h - the kinds of image files that textures may be: one table for all model formats. */
#ifndef IO_IMAGE_KIND_H
#define IO_IMAGE_KIND_H

#include "image/image.h"

typedef struct image_kind {
    image_codec codec;
    const char *mime_type, *name;
    const char *file_extension;
    const char *gltf_extension; /* what lets a glTF texture use one; NULL: the core */
    bool is_converted;          /* written to glTF as PNG: no core or ratified extension has it */
} image_kind;

/* By the first bytes; NULL: none of them. */
const image_kind *image_kind_of_bytes(const void *bytes, size_t size);
/* By MIME type; NULL: none of them. */
const image_kind *image_kind_of_mime_type(const char *mime_type);
/* What a file that is none of them is, "TIFF" or "PSD"; NULL: unknown. file_name helps where bytes do not tell. */
const char *image_foreign_kind(const void *bytes, size_t size, const char *file_name);

/* For messages. */
#define IMAGE_KINDS_TEXT "PNG, JPEG, WebP, AVIF, KTX2, TGA, BMP, GIF or DDS"

#endif
