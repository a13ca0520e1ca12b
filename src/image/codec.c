/* codec.c - selects the decoder of a file by its first bytes and calls it. Encoders are selected in codec_encode.c, so that
 * programs that only read are linked without them. */
#include "image/codec.h"

#include <float.h>
#include <string.h>

#include "base/result.h"

typedef struct codec {
    const char *name;
    codec_probe *probe; /* NULL: not in this build */
    codec_decode *decode;
    const char *library; /* library that is missing if probe is NULL */
} codec;

static const codec codecs[] = {
    [IMAGE_CODEC_UNKNOWN] = {.name = "unknown"},
    [IMAGE_CODEC_PNG] = {"PNG", png_probe, png_decode, NULL},
    [IMAGE_CODEC_JPEG] = {"JPEG", jpeg_probe, jpeg_decode, NULL},
#ifdef HAVE_WEBP
    [IMAGE_CODEC_WEBP] = {"WebP", webp_probe, webp_decode, NULL},
#else
    [IMAGE_CODEC_WEBP] = {.name = "WebP", .library = "libwebp"},
#endif
    [IMAGE_CODEC_HDR] = {"Radiance HDR", hdr_probe, hdr_decode, NULL},
#ifdef HAVE_OPENEXR
    [IMAGE_CODEC_EXR] = {"OpenEXR", exr_probe, exr_decode, NULL},
#else
    [IMAGE_CODEC_EXR] = {.name = "OpenEXR", .library = "the OpenEXR library"},
#endif
    [IMAGE_CODEC_PFM] = {"PFM", pfm_probe, pfm_decode, NULL},
    [IMAGE_CODEC_KTX2] = {"KTX2", ktx2_probe, ktx2_decode_file, NULL},
#ifdef HAVE_AVIF
    [IMAGE_CODEC_AVIF] = {"AVIF", avif_probe, avif_decode, NULL},
#else
    [IMAGE_CODEC_AVIF] = {.name = "AVIF", .library = "libavif"},
#endif
    [IMAGE_CODEC_TGA] = {"TGA", tga_probe, tga_decode, NULL},
    [IMAGE_CODEC_BMP] = {"BMP", bmp_probe, bmp_decode, NULL},
    [IMAGE_CODEC_GIF] = {"GIF", gif_probe, gif_decode, NULL},
    [IMAGE_CODEC_DDS] = {"DDS", dds_probe, dds_decode, NULL},
};

image_codec image_codec_detect(const void *bytes, size_t size)
{
    static const struct magic {
        image_codec codec;
        unsigned char offset, size;
        const char *bytes;
    } magics[] = {
        {IMAGE_CODEC_PNG, 0, 8, "\x89PNG\r\n\x1a\n"},
        {IMAGE_CODEC_JPEG, 0, 2, "\xff\xd8"}, /* stray bytes may precede the next marker */
        {IMAGE_CODEC_WEBP, 8, 4, "WEBP"},
        {IMAGE_CODEC_HDR, 0, 11, "#?RADIANCE\n"},
        {IMAGE_CODEC_HDR, 0, 11, "#?RADIANCE\r"},
        {IMAGE_CODEC_HDR, 0, 7, "#?RGBE\n"},
        {IMAGE_CODEC_HDR, 0, 7, "#?RGBE\r"},
        {IMAGE_CODEC_EXR, 0, 4, "\x76\x2f\x31\x01"},
        {IMAGE_CODEC_PFM, 0, 3, "PF\n"},
        {IMAGE_CODEC_PFM, 0, 3, "Pf\n"},
        {IMAGE_CODEC_PFM, 0, 3, "PF "},
        {IMAGE_CODEC_PFM, 0, 3, "Pf "},
        {IMAGE_CODEC_PFM, 0, 3, "PF\r"},
        {IMAGE_CODEC_PFM, 0, 3, "Pf\r"},
        {IMAGE_CODEC_KTX2, 0, 12, "\xabKTX 20\xbb\r\n\x1a\n"},
        {IMAGE_CODEC_AVIF, 4, 8, "ftypavif"},
        {IMAGE_CODEC_AVIF, 4, 8, "ftypavis"},
        {IMAGE_CODEC_GIF, 0, 6, "GIF87a"},
        {IMAGE_CODEC_GIF, 0, 6, "GIF89a"},
    };
    const unsigned char *b = bytes;
    for (size_t i = 0; i < sizeof magics / sizeof *magics; i++) {
        const struct magic *m = &magics[i];
        if (size >= (size_t)m->offset + m->size && memcmp(b + m->offset, m->bytes, m->size) == 0 &&
            (m->codec != IMAGE_CODEC_WEBP || memcmp(b, "RIFF", 4) == 0))
            return m->codec;
    }
    return dds_detect(b, size)   ? IMAGE_CODEC_DDS
           : bmp_detect(b, size) ? IMAGE_CODEC_BMP
           : tga_detect(b, size) ? IMAGE_CODEC_TGA
                                 : IMAGE_CODEC_UNKNOWN;
}

const char *image_codec_name(image_codec codec_id)
{
    return codecs[codec_id].name;
}

bool image_codec_is_built(image_codec codec_id)
{
    return codecs[codec_id].decode != NULL;
}

/* Finds the codec of a file, or fails with the reason. */
static facet_result find_codec(const void *bytes, size_t size, const char *name, image_codec *id,
                               facet_error *error)
{
    *id = image_codec_detect(bytes, size);
    if (size == 0)
        return fail(error, FACET_ERROR_INVALID, "%s: the file is empty", name);
    if (*id == IMAGE_CODEC_UNKNOWN)
        return fail(error, FACET_ERROR_INVALID,
                    "%s: first bytes: a PNG, JPEG, WebP, AVIF, KTX2, TGA, BMP, GIF, DDS, Radiance HDR, "
                    "OpenEXR or PFM file was "
                    "expected",
                    name);
    if (!codecs[*id].decode)
        return fail(error, FACET_ERROR_UNSUPPORTED,
                    "%s: this build of facet does not read %s files: %s was missing when it was built", name,
                    codecs[*id].name, codecs[*id].library);
    return FACET_OK;
}

facet_result image_probe(const void *bytes, size_t size, const char *name, image *header,
                         image_codec *codec_id, facet_error *error)
{
    *header = (image){0};
    image_codec id;
    facet_result result = find_codec(bytes, size, name, &id, error);
    if (codec_id)
        *codec_id = id;
    return result == FACET_OK ? codecs[id].probe(bytes, size, name, header, error) : result;
}

facet_result image_decode(const void *bytes, size_t size, const char *name, const image_decode_desc *desc,
                          image *out, facet_error *error)
{
    *out = (image){0};
    image_decode_desc d = desc ? *desc : (image_decode_desc){0};
    if (d.channel_count != 0 && d.channel_count != 3 && d.channel_count != 4)
        return fail(error, FACET_ERROR_ARGUMENT, "%s: %u channels were asked for; 0, 3 or 4 was expected",
                    name, d.channel_count);
    if (d.max_size == 0)
        d.max_size = CODEC_MAX_SIZE;
    if (d.thread_count == 0)
        d.thread_count = 1;
    float largest;
    d.largest = d.largest ? d.largest : &largest;
    *d.largest = FLT_MAX;
    if (d.note)
        *d.note = (image_note){0};
    image_codec id;
    TRY(find_codec(bytes, size, name, &id, error));
    if (d.layer && id != IMAGE_CODEC_EXR)
        return fail(error, FACET_ERROR_INVALID, "%s: only OpenEXR files have layers (\"%s\")", name, d.layer);
    return codecs[id].decode(bytes, size, name, &d, out, error);
}

image_envmap image_get_envmap(const void *bytes, size_t size)
{
#ifdef HAVE_OPENEXR
    if (image_codec_detect(bytes, size) == IMAGE_CODEC_EXR)
        return exr_get_envmap(bytes, size);
#else
    (void)bytes, (void)size;
#endif
    return IMAGE_ENVMAP_NONE;
}
