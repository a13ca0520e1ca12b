/* image_kind.h - the image file formats of textures: one table for all model formats. */
#ifndef IO_IMAGE_KIND_H
#define IO_IMAGE_KIND_H

#include "image/image.h"

typedef struct image_kind {
    image_codec codec;
    const char *mime_type, *name;
    const char *file_extension;
    const char *gltf_extension; /* extension that allows it in glTF textures; NULL: the core does */
    bool is_converted;          /* converted to PNG for glTF: no core or ratified extension allows it */
} image_kind;

/* By magic bytes; a KTX2 file of ASTC blocks, which has an extension of its own, by its format. NULL: unknown. */
const image_kind *image_kind_of_bytes(const void *bytes, size_t size);
/* By MIME type; NULL: unknown. */
const image_kind *image_kind_of_mime_type(const char *mime_type);
/* The format of an image file that facet does not read, "TIFF" or "PSD"; NULL: unknown. file_name helps
 * where the bytes are ambiguous. */
const char *image_foreign_kind(const void *bytes, size_t size, const char *file_name);

/* For messages. */
#define IMAGE_KINDS_TEXT "PNG, JPEG, WebP, AVIF, KTX2, TGA, BMP, GIF or DDS"

#endif
