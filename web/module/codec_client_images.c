/* codec_client_images.c - image codecs that are modules: functions of image/codec.h that call those of the same name there; AVIF,
 * which the browser decodes. */
#include <float.h>
#include <stddef.h>
#include <stdio.h>

#include "base/result.h"
#include "codec_client.h"
#include "image/codec.h"

/* What a function of a codec takes and returns, in one block of the module's memory; pointers in it are addresses there. */
typedef struct parameters {
    facet_error error;
    image image; /* pixels: there */
    image_decode_desc desc;
    image_note note;
    float largest;
    char layer[256], name[512];
} parameters;

typedef struct format {
    const char *module, *name;
} format;

static const format webp = {"webp", "WebP"}, exr = {"exr", "OpenEXR"};

static facet_result fail_instance(const format *f, int instance, const char *name, facet_error *error)
{
    char reason[256];
    codec_explain(f->module, instance, reason, sizeof reason);
    return fail(error, instance ? FACET_ERROR_INVALID : FACET_ERROR_UNSUPPORTED, "%s: %s: %s", name, f->name,
                reason);
}

/* ---- one call: bytes and parameters are put into the module, the function is called, parameters are copied back ---- */

static void prepare(parameters *p, codec_address there, const char *name, const image_decode_desc *desc)
{
    *p = (parameters){0};
    snprintf(p->name, sizeof p->name, "%s", name);
    if (!desc)
        return;
    p->desc = *desc;
    p->desc.allocator = (facet_allocator){0};
    p->desc.sink = NULL;
    p->desc.note = (image_note *)(uintptr_t)(there + offsetof(parameters, note));
    p->desc.largest = (float *)(uintptr_t)(there + offsetof(parameters, largest));
    if (desc->layer) {
        snprintf(p->layer, sizeof p->layer, "%s", desc->layer);
        p->desc.layer = (const char *)(uintptr_t)(there + offsetof(parameters, layer));
    }
    p->largest = FLT_MAX;
}

/* desc NULL: a probe. *there: the block of parameters, to be released. */
static facet_result run(const format *f, int instance, const char *function, codec_address bytes, size_t size,
                        const image_decode_desc *desc, parameters *p, codec_address there, facet_error *error)
{
    const codec_address name = there + offsetof(parameters, name), out = there + offsetof(parameters, image),
                        message = there + offsetof(parameters, error);
    const uint32_t decode[] = {bytes, (uint32_t)size, name, there + offsetof(parameters, desc), out, message};
    const uint32_t probe[] = {bytes, (uint32_t)size, name, out, message};
    uint32_t result;
    if (!(desc ? codec_call(instance, function, decode, 6, &result)
               : codec_call(instance, function, probe, 5, &result)))
        return fail_instance(f, instance, p->name, error);
    codec_get(instance, there, p, sizeof *p);
    return result == FACET_OK ? FACET_OK : fail(error, (facet_result)result, "%s", p->error.message);
}

static facet_result copy_texels(int instance, const parameters *p, const image_decode_desc *desc, image *out,
                                facet_error *error)
{
    const image *i = &p->image;
    TRY(image_create(&desc->allocator, i->width, i->height, i->channel_count, i->type, out, error));
    out->is_srgb = i->is_srgb;
    codec_get(instance, (codec_address)(uintptr_t)i->pixels, out->pixels, image_row_size(i) * i->height);
    if (desc->note)
        *desc->note = p->note;
    if (desc->largest)
        *desc->largest = p->largest;
    return FACET_OK;
}

static facet_result call(const format *f, const char *function, const unsigned char *bytes, size_t size,
                         const char *name, const image_decode_desc *desc, image *out, facet_error *error)
{
    const int instance = codec_open(f->module);
    if (!instance)
        return fail_instance(f, 0, name, error);
    static parameters p; /* one call at a time */
    prepare(&p, 0, name, NULL);
    const codec_address input = codec_put(instance, bytes, size),
                        there = input ? codec_put(instance, &p, sizeof p) : 0;
    facet_result result = FACET_ERROR_MEMORY;
    if (!there) {
        fail_memory(error, f->name, size);
    } else {
        const codec_address pixels = there + offsetof(parameters, image);
        uint32_t nothing;
        prepare(&p, there, name, desc);
        codec_set(instance, there, &p, sizeof p);
        result = run(f, instance, function, input, size, desc, &p, there, error);
        if (result == FACET_OK && desc)
            result = copy_texels(instance, &p, desc, out, error);
        else if (result == FACET_OK)
            *out = p.image;
        codec_call(instance, "image_destroy", &pixels, 1, &nothing);
    }
    codec_release(instance, there);
    codec_release(instance, input);
    codec_close(instance);
    return result;
}

/* ---- WebP and OpenEXR ---- */

facet_result webp_probe(const unsigned char *bytes, size_t size, const char *name, image *header,
                        facet_error *error)
{
    return call(&webp, "webp_probe", bytes, size, name, NULL, header, error);
}

facet_result webp_decode(const unsigned char *bytes, size_t size, const char *name,
                         const image_decode_desc *desc, image *out, facet_error *error)
{
    return call(&webp, "webp_decode", bytes, size, name, desc, out, error);
}

facet_result webp_encode(const image *i, const image_encode_desc *desc, unsigned char **bytes, size_t *size,
                         facet_error *error)
{
    (void)i, (void)desc, (void)bytes, (void)size;
    return fail(error, FACET_ERROR_UNSUPPORTED, "WebP files are not written in a browser");
}

facet_result exr_probe(const unsigned char *bytes, size_t size, const char *name, image *header,
                       facet_error *error)
{
    return call(&exr, "exr_probe", bytes, size, name, NULL, header, error);
}

facet_result exr_decode(const unsigned char *bytes, size_t size, const char *name,
                        const image_decode_desc *desc, image *out, facet_error *error)
{
    return call(&exr, "exr_decode", bytes, size, name, desc, out, error);
}

image_envmap exr_get_envmap(const unsigned char *bytes, size_t size)
{
    const int instance = codec_open(exr.module);
    uint32_t envmap = IMAGE_ENVMAP_NONE;
    if (!instance)
        return IMAGE_ENVMAP_NONE; /* decoding says why */
    const codec_address input = codec_put(instance, bytes, size);
    const uint32_t arguments[] = {input, (uint32_t)size};
    if (!input || !codec_call(instance, "exr_get_envmap", arguments, 2, &envmap))
        envmap = IMAGE_ENVMAP_NONE;
    codec_release(instance, input);
    codec_close(instance);
    return (image_envmap)envmap;
}

/* ---- AVIF ---- */

facet_result avif_probe(const unsigned char *bytes, size_t size, const char *name, image *header,
                        facet_error *error)
{
    uint32_t extent[2];
    char reason[256];
    if (!codec_find_picture(bytes, size, extent)) {
        codec_offer_picture(bytes, size);
        codec_explain("avif", 0, reason, sizeof reason);
        return fail(error, FACET_ERROR_UNSUPPORTED, "%s: AVIF: %s", name, reason);
    }
    TRY(codec_check_size(name, extent[0], extent[1], UINT32_MAX, error));
    *header = codec_srgb_header(extent[0], extent[1], 4, IMAGE_U8);
    return FACET_OK;
}

facet_result avif_decode(const unsigned char *bytes, size_t size, const char *name,
                         const image_decode_desc *desc, image *out, facet_error *error)
{
    image header, made = {0};
    TRY(avif_probe(bytes, size, name, &header, error));
    TRY(codec_check_size(name, header.width, header.height, desc->max_size, error));
    TRY(image_create(&desc->allocator, header.width, header.height, 4, IMAGE_U8, &made, error));
    made.is_srgb = true;
    codec_get_picture(bytes, size, made.pixels);
    TRY(codec_set_channels(&made, desc, error));
    *out = made;
    return FACET_OK;
}
