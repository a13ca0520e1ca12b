/* image_kind.c - see image_kind.h. */
#include "io/image_kind.h"

#include <string.h>
#include <strings.h>

#include "base/file.h"
#include "image/ktx2.h"

static const char ASTC_EXTENSION[] = "EXT_texture_astc";

static const image_kind KINDS[] = {
    {IMAGE_CODEC_PNG, "image/png", "PNG", "png", NULL, false},
    {IMAGE_CODEC_JPEG, "image/jpeg", "JPEG", "jpg", NULL, false},
    {IMAGE_CODEC_KTX2, "image/ktx2", "KTX2", "ktx2", "KHR_texture_basisu", false},
    {IMAGE_CODEC_KTX2, "image/ktx2", "KTX2", "ktx2", ASTC_EXTENSION, false}, /* of ASTC blocks */
    {IMAGE_CODEC_WEBP, "image/webp", "WebP", "webp", "EXT_texture_webp", false},
    {IMAGE_CODEC_AVIF, "image/avif", "AVIF", "avif", "EXT_texture_avif", false},
    {IMAGE_CODEC_TGA, "image/x-tga", "TGA", "tga", NULL, true},
    {IMAGE_CODEC_BMP, "image/bmp", "BMP", "bmp", NULL, true},
    {IMAGE_CODEC_GIF, "image/gif", "GIF", "gif", NULL, true},
    {IMAGE_CODEC_DDS, "image/vnd-ms.dds", "DDS", "dds", "MSFT_texture_dds", true},
};
enum { KIND_COUNT = sizeof KINDS / sizeof *KINDS };

static bool is_astc(const void *bytes, size_t size)
{
    ktx2 k;
    return ktx2_open(bytes, size, "", &k, NULL) == FACET_OK && k.format->kind == KTX2_ASTC;
}

const image_kind *image_kind_of_bytes(const void *bytes, size_t size)
{
    image_codec codec = image_codec_detect(bytes, size);
    const bool has_astc = codec == IMAGE_CODEC_KTX2 && is_astc(bytes, size);
    for (size_t i = 0; i < KIND_COUNT; i++)
        if (KINDS[i].codec == codec && has_astc == (KINDS[i].gltf_extension == ASTC_EXTENSION))
            return &KINDS[i];
    return NULL;
}

const image_kind *image_kind_of_mime_type(const char *mime_type)
{
    for (size_t i = 0; i < KIND_COUNT; i++)
        if (strcmp(KINDS[i].mime_type, mime_type) == 0)
            return &KINDS[i];
    return NULL;
}

const char *image_foreign_kind(const void *bytes, size_t size, const char *file_name)
{
    static const struct {
        const char *magic;
        size_t length;
        const char *name;
    } magics[] = {{"8BPS", 4, "PSD"},        {"II*", 3, "TIFF"},        {"MM\0*", 4, "TIFF"},
                  {"#?", 2, "Radiance HDR"}, {"v/1\x01", 4, "OpenEXR"}, {"PF", 2, "PFM"},
                  {"\x01\xda", 2, "SGI"},    {"P6", 2, "PPM"},          {"P5", 2, "PGM"}};
    static const char *const names[][2] = {{"pcx", "PCX"}, {"pct", "PICT"}};
    for (size_t i = 0; i < sizeof magics / sizeof *magics; i++)
        if (size >= magics[i].length && memcmp(bytes, magics[i].magic, magics[i].length) == 0)
            return magics[i].name;
    for (size_t i = 0; i < sizeof names / sizeof *names; i++)
        if (strcasecmp(path_extension(file_name), names[i][0]) == 0)
            return names[i][1];
    return NULL;
}
